"""What colours of a motion's report stand for is told in the colours themselves."""

import re
from pathlib import Path

import numpy as np

from armscope.report.figures.motion import FRICTION, LEFT, TRACE, draw_friction, draw_trace
from armscope.report.figures.waterfall import STEPS
from armscope.report.motion_subject import MotionSubject
from armscope.report.sectioning import write_sections
from armscope.report.sections.motion import MOTION_SECTIONS
from tests.report.test_motion_page import of_a_cable


def test_what_colours_stand_for_is_shown_in_the_colours_themselves(tmp_path: Path) -> None:
    """A dark page has others: "dark: measured" was false there."""
    sections = write_sections(MOTION_SECTIONS, MotionSubject(of_a_cable(), "motions.csv"), "motion", tmp_path)
    shown = {each.name: str(each.html) for each in sections}
    for name, keys in (("torque", TRACE), ("friction", FRICTION), ("unexplained", LEFT), ("validation", STEPS)):
        drawn, told = shown[name].rsplit("</svg>", 1)
        for key in keys:
            assert f'<i style="border-color: {key.colour}"></i>{key.words}' in told, name
            assert key.colour in drawn or key.words == "what it added", name
        assert not re.search(r"\b(dark|orange|blue|pale|grey):", told, re.IGNORECASE), name
    assert '<span class="key dots">' in shown["friction"], "rows are dots"
    lines = re.findall(r'<path[^>]*stroke="var\(--(measured|before|after)[^>]*>', shown["torque"])
    dashed = re.findall(r'<path[^>]*stroke="var\(--(\w+)[^>]*stroke-dasharray', shown["torque"])
    assert set(lines) == {"measured", "before", "after"}
    assert set(dashed) == {"before"}, "they differ without their colours, too"


def test_figures_hold_what_they_are_given() -> None:
    time = np.linspace(0, 1, 20)
    drawn = draw_trace("joint 9", "N", time, [(np.sin(time), "a", 1.0), (time, "b", 1.0), (time, "c", 1.0)]).svg()
    assert "joint 9" in drawn
    assert "torque (N)" in drawn
    curve = (np.linspace(-1, 1, 9), np.linspace(-2, 2, 9))
    assert "speed (deg/s)" in draw_friction("joint 1", curve, curve, ("speed (deg/s)", "friction (N m)")).svg()
