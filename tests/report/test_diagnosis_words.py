import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from armscope.physics.registry import EFFECTS
from armscope.report.figures.arm import location_shares
from armscope.report.html import by_cause, unbroken
from armscope.report.pages.diagnosis import write_report
from armscope.report.sections.effect_cards import card
from armscope.verdict.effects import Curve, Parameter
from armscope.verdict.schema import Unexplained
from armscope.verdict.sentences import exact_phrase
from armscope.verdict.wording import Reading, reach, read_parameter
from tests.report import verdicts
from tests.report.verdicts import compliance, found

LOCATIONS = {
    "link_geometry": "link 2", "link_bending": "link 2", "thermal_expansion": "link 2", "base_drift": "base",
    "base_shift": "base", "base_compliance": "base", "tool_shift": "tool", "instrument_scale": "instrument",
    "payload_error": "payload", "parallelogram_geometry": "parallelogram", "joint_coupling": "joint 6 from joint 5",
    "loose_target": "tool", "holder_sag": "tool", "payload_change": "payload",
    "thermal_bow": "link 2",
}  # fmt: skip
PARAMETERS = {
    "joint_offset": [("offset", "rad", 8.6e-4)],
    "gear_ratio": [("ratio", "rad/rad", -2e-4)],
    "gear_eccentricity": [("amplitude", "rad", 2.4e-4), ("phase", "rad", 1.0), ("per_turn", "1/turn", 2.0)],
    "gear_mesh": [("amplitude", "rad", 2.4e-5), ("phase", "rad", 1.0), ("per_turn", "1/turn", 37.0)],
    "axis_wobble": [("amplitude", "rad", 2.4e-4), ("phase", "rad", 1.0), ("direction", "rad", 1.0)],
    "backlash": [("gap", "rad", 3e-4)],
    "servo_lag": [("delay", "s", 0.004)],
    "joint_coupling": [("coupling", "rad/rad", 2e-4)],
    "joint_compliance": [("compliance", "rad/(N m)", 2.1e-7)],
    "bearing_compliance": [("compliance", "rad/(N m)", 2.1e-7)],
    "base_compliance": [("compliance", "rad/(N m)", 2.1e-7)],
    "link_bending": [("flexibility", "1/(N m^2)", 3e-7)],
    "thermal_expansion": [("coefficient", "1/K", 1.2e-5)],
    "link_geometry": [("a", "mm", 0.76), ("alpha", "rad", 7e-4), ("d", "mm", 0.001)],
    "base_drift": [(axis, "mm/h", 0.1) for axis in "xyz"],
    "base_shift": [("x", "mm", 0.3), ("y", "mm", 0.4), ("z", "mm", 0.0), ("time", "s", 4711.0)],
    "tool_shift": [("x", "mm", 0.3), ("y", "mm", 0.4), ("z", "mm", 0.0), ("row", "", 85.0)],
    "zero_shift": [("jump", "rad", -5e-4), ("time", "s", 4711.0)],
    "instrument_scale": [("scale", "m/m", -1.5e-5)],
    "payload_error": [("mass", "kg", 2.0)],
    "payload_change": [("mass", "kg", -2.0)],
    "thermal_zero": [("drift", "rad/K", -6e-5)],
    "thermal_bow": [("tilt_x", "rad/K", 0.0), ("tilt_y", "rad/K", 6e-5)],
    "loose_target": [("play_across", "mm", 0.3), ("x", "", 0.0), ("y", "", 0.0), ("z", "", 1.0)],
    "holder_sag": [("sag_x", "mm", 0.3), ("sag_y", "mm", 0.0)],
    "parallelogram_geometry": [("rod", "mm", 0.4), ("rocker", "mm", -0.2)],
}  # fmt: skip
SAID = {
    "joint_offset": "the zero of joint 2 is off by +0.86 mrad",
    "gear_ratio": "joint 2 turns 0.020 % too little",
    "gear_eccentricity": "the angle of joint 2 swings by ±240 µrad twice per turn",
    "gear_mesh": "the angle of joint 2 swings by ±24 µrad 37 times per turn",
    "axis_wobble": "the axis of joint 2 tilts by ±240 µrad once per turn",
    "backlash": "joint 2 has 300 µrad of play",
    "servo_lag": "joint 2 runs behind by 4.0 ms",
    "joint_coupling": "joint 6 turns by +200 µrad per rad of joint 5",
    "joint_compliance": "joint 2 gives way by 0.21 µrad per N m under gravity",
    "bearing_compliance": "the bearing of joint 2 tilts by 0.21 µrad per N m under gravity",
    "base_compliance": "the base tilts by 0.21 µrad per N m under the arm's moment",
    "link_bending": "link 2 bends under its load",
    "thermal_expansion": "link 2 grows by 12 millionths per K with temperature",
    "base_drift": "the base drifts by 0.17 mm per hour",
    "base_shift": "the base jumped by 0.50 mm at 4711 s",
    "tool_shift": "the tool jumped by 0.50 mm at row 85",
    "zero_shift": "the zero of joint 2 jumped by −0.50 mrad at 4711 s",
    "payload_change": "the payload is 2.0 kg lighter than stated",
    "thermal_zero": "the zero of joint 2 moves by −60 µrad per K",
    "thermal_bow": "link 2 bows by 60 µrad per K about its y as it gets warmer",
    "loose_target": "the target is loose on the tool: it falls by 0.30 mm across the tool's z, to its lower side",
    "holder_sag": "what holds the target bends under its own weight, by 0.30 mm along the tool's x",
    "instrument_scale": "the instrument measures 15 millionths (ppm) too short",
}


def example(name, **changes):
    parameters = [Parameter(n, unit, value, abs(value) / 50) for n, unit, value in PARAMETERS.get(name, [])]
    return found(name, LOCATIONS.get(name, "joint 2"), *parameters, **changes)


@pytest.mark.parametrize("name", [effect.name for effect in EFFECTS])
def test_every_effect_of_the_library_is_said_in_plain_words(name):
    clause = exact_phrase(example(name))
    assert LOCATIONS.get(name, "joint 2").split(" from ")[0] in clause
    assert "_" not in clause
    assert "{" not in clause
    assert clause == SAID.get(name, clause)


@pytest.mark.parametrize("name", [effect.name for effect in EFFECTS])
def test_an_effect_whose_parameters_are_unknown_still_has_a_sentence_and_a_card(name):
    bare = found(name, LOCATIONS.get(name, "joint 2"))
    assert exact_phrase(bare)
    assert card(bare, 1).readings == ()


def test_a_number_stays_with_its_unit_and_nothing_else_is_glued():
    assert unbroken("falls from 0.2 mm to 3 % of 4") == "falls from 0.2\u00a0mm to 3\u00a0% of 4"
    assert unbroken("by 3 µrad per N m under it") == "by 3\u00a0µrad per N\u00a0m under it"


def test_where_a_curve_is_not_known_its_height_is_not_quoted():
    at = np.linspace(0, 1, 5)
    curve = Curve("time", "h", at, np.array([0, 3.0, 9.0, 1.0, 0]), np.array([0.1, 0.1, 8.0, 0.1, 0.1]), "rad")
    assert reach(curve).value == 3.0


def test_a_tilt_that_may_as_well_be_none_has_no_number_in_a_sentence():
    clear, open_ = (
        Parameter("compliance_y", "rad/(N m)", 1.9e-6, 2e-7),
        Parameter("compliance_x", "rad/(N m)", 9e-7, 8e-7),
    )
    assert exact_phrase(found("base_compliance", "base", open_, clear)) == (
        "the base tilts by 1.9 µrad per N m about its y under the arm's moment"
    )
    neither = replace(clear, name="compliance_y", stderr=1.5e-6)
    assert exact_phrase(found("base_compliance", "base", open_, neither)) == "the base tilts under the arm's moment"


def test_a_base_that_tilts_about_its_foot_is_told_with_where_that_is():
    tilt, shift = Parameter("compliance", "rad/(N m)", 1.5e-7, 7e-9), Parameter("shift", "m/(N m)", 1.2e-7, 2e-9)
    plain = "the base tilts by 0.15 µrad per N m under the arm's moment"
    assert (
        exact_phrase(found("base_compliance", "base", tilt, shift)) == f"{plain}, about a point 0.80 m below its origin"
    )
    above = replace(shift, value=-shift.value)
    assert exact_phrase(found("base_compliance", "base", tilt, above)).endswith("0.80 m above its origin")
    assert exact_phrase(found("base_compliance", "base", tilt, replace(shift, stderr=1e-7))) == plain


def test_what_moves_across_with_a_tilt_has_a_number_with_a_unit():
    shift, out = Parameter("shift", "m/(N m)", 1.17e-7, 2.1e-9), Parameter("run_out", "mm", 0.11, 0.002)
    assert read_parameter(shift, "base_compliance") == Reading(
        "its origin moves across by", "0.1170 µm per N m", "0.1129 … 0.1211 µm per N m"
    )
    told = read_parameter(out, "axis_wobble")
    assert (told.label, told.value) == ("moves across, at its origin, by ±", "0.1100 mm")


def test_no_place_has_more_than_all_of_the_mismatch():
    case = verdicts.case(effects=(compliance(share=53.0), compliance("joint 3", share=48.0)))
    assert location_shares(case.verdict) == {"joint 2": 1.0, "joint 3": 1.0}


def test_a_joint_that_turns_against_its_load_is_not_told_to_give_way():
    along, against = (Parameter("compliance", "rad/(N m)", value, 1e-8) for value in (3.2e-7, -3.2e-7))
    assert exact_phrase(found("joint_compliance", "joint 2", along)).startswith(
        "joint 2 gives way by 0.32 µrad per N m"
    )
    told = exact_phrase(found("joint_compliance", "joint 2", against))
    assert told == "joint 2 turns against gravity's pull, as no spring does, by 0.32 µrad per N m"


def test_scatter_is_no_curve_and_asks_for_what_its_card_asks_for(tmp_path: Path) -> None:
    """Seen: "the curve of joint 5 that follows the nothing in the table", and "No further measurement is needed"."""
    nothing = "nothing in the table"
    scatter = verdicts.unknown_curve(
        "joint 4", curve=None, driver=nothing, title=f"scatter at joint 4 that follows {nothing}",
        parameters=(Parameter("scatter", "rad", 3e-4, 1e-5),),
    )  # fmt: skip
    case = verdicts.case(effects=(scatter,), answer="partly explained")
    left = Unexplained(
        True, "joint 4", "nothing in the table", 0.05, "scatter at joint 4 that follows nothing in the table"
    )
    verdict = replace(case.verdict, unexplained=left, next_poses=None)
    page = re.sub(r"<[^>]*>", "", write_report(verdict, tmp_path).read_text(encoding="utf-8"))
    words = " ".join(page.split())
    assert "is the scatter at joint 4, which follows nothing in the table" in words
    assert "follows the nothing" not in words
    assert "No further measurement is needed" not in words
    assert "what was found at joint 4 has no known cause: record what the card there asks for" in words


def test_a_headline_of_several_causes_has_a_line_each_and_what_is_beside_is_quiet():
    lines = by_cause("joint 2 gives way (also joint 3) – 60 %; a <zero> is off – 20 %.")
    assert lines == [
        unbroken("Joint 2 gives way <i>(also joint 3)</i> – 60 %"),
        unbroken("A &lt;zero&gt; is off – 20 %"),
    ]
    one = "Cannot tell: poses are few; six would settle it."
    assert by_cause(one) == [one]
