"""The page shows where links lie beside their motors, and why."""

from pathlib import Path

import pytest

from armscope.report.figures.twist import draw_twist
from armscope.report.motion_subject import MotionSubject
from armscope.report.pages.motion import write_motion_report
from armscope.report.sections.motion import links_of_motion
from tests.motion.two_inertias import wound_up


@pytest.mark.long
def test_a_drive_that_winds_up_has_a_card_and_a_figure(tmp_path: Path) -> None:
    found = wound_up()
    page = write_motion_report(found, "motions.csv", tmp_path).read_text(encoding="utf-8")
    (cause,) = (each for each in found.verdict.links[0].causes if not each.minor)
    assert cause.confirm in page
    assert cause.cure.partition(":")[0] in page
    assert 'id="cause-link-3-1"' in page
    order = (tmp_path / "work-order.html").read_text(encoding="utf-8")
    assert cause.confirm in order
    assert cause.cure.partition(":")[0] in order
    assert (tmp_path / "figures" / "twist_3.svg").exists()
    (side,) = links_of_motion(MotionSubject(found, "motions.csv"))["sides"]
    assert side["joint"] == "joint 3"
    assert len(side["cards"]) == 1
    assert "link less motor (mrad)" in draw_twist(found.twists[0], "N m").svg()
