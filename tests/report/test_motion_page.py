"""The page of an arm in motion shows what was found, where, and on which motion it was tested."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.report.figures.motion import draw_friction, draw_trace
from armscope.report.motion_subject import MotionSubject, liveliest_piece
from armscope.report.pages.motion import write_motion_report
from armscope.report.sectioning import write_sections
from armscope.report.sections.motion import MOTION_SECTIONS, arm_of_motion, motion_card, relative_steps, signed
from armscope.report.sections.motion_work import error_in_words
from armscope.verdict.effects import Parameter
from tests.motion.moving import moved, robot


def cabled(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """A cable at joint 1 that no spring is like."""
    extra = np.zeros_like(q)
    extra[:, 0] = 4 * np.sin(3.1 * q[:, 0]) * (q[:, 0] > 0)
    return extra


@pytest.fixture(scope="module")
def found() -> MotionDiagnosis:
    arm = robot()
    return diagnose_motion(arm, moved(arm, 7, cabled), MotionSettings(cutoff=10.0))


@pytest.fixture(scope="module")
def page(found: MotionDiagnosis, tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("page")
    return write_motion_report(found, "motions <b>.csv", folder).read_text(encoding="utf-8")


def test_the_page_needs_no_network_and_obeys_no_name(page: str) -> None:
    assert not re.search(r"(src|href)=\"https?:", page)
    assert "motions &lt;b&gt;.csv" in page
    assert "<script" not in page


def test_every_section_and_every_joint_is_there(page: str, found: MotionDiagnosis) -> None:
    for section in MOTION_SECTIONS:
        assert f'id="{section.name}"' in page
    for joint in (1, 2, 3):
        assert page.count(f">joint {joint}</text>") == 5  # torque, friction, and what is left thrice
    assert found.how.words[:20] in page


def test_each_cause_has_a_card_with_its_confirmation_and_cure(page: str, found: MotionDiagnosis) -> None:
    main = [cause for cause in found.verdict.effects if not cause.minor]
    assert main
    for cause in main:
        assert cause.confirm in page
        assert cause.cure in page
    assert page.count('<article class="effect"') == len(main)


def test_the_work_order_has_a_line_per_cause_with_its_cure_and_the_error_after_it(
    found: MotionDiagnosis, tmp_path: Path
) -> None:
    write_motion_report(found, "motions.csv", tmp_path)
    order = (tmp_path / "work-order.html").read_text(encoding="utf-8").replace("\u00a0", " ")
    main = [cause for cause in found.verdict.effects if not cause.minor]
    assert order.count("Confirm first:") == len(main)
    after = {step.label: step.held_out for step in found.verdict.waterfall}
    for number, cause in enumerate(main, start=2):
        assert cause.cure.replace("`", "") in order
        assert f"{error_in_words(after[cause.title])} of the torque after 1 to {number}" in order
    assert all(f"<td>{each.joint}</td>" in order for each in found.verdict.background)
    assert error_in_words(float("nan")) == "–"


def test_numbers_of_the_strip_and_the_waterfall_are_the_verdicts(found: MotionDiagnosis) -> None:
    steps = relative_steps(MotionSubject(found, "motions.csv"))
    assert steps[0][1] == pytest.approx(100 * found.verdict.held_out.stated)
    assert steps[-1][1] == pytest.approx(100 * found.verdict.waterfall[-1].held_out)


def test_departures_carry_their_sign_and_scanned_numbers_do_not() -> None:
    assert signed(Parameter("coulomb", "N m", 3.0, 0.1), {}).value.startswith("+3.0")
    assert signed(Parameter("coulomb", "N m", -3.0, 0.1), {}).value.startswith(("-3.0", "−3.0"))
    assert signed(Parameter("per_turn", "", 4.0, float("nan")), {}).value[0] == "4"


def test_a_curves_card_holds_its_picture(found: MotionDiagnosis, tmp_path: Path) -> None:
    effects = found.verdict.effects
    number, cable = next((n, c) for n, c in enumerate(effects, start=1) if c.effect == "cable_torque")
    assert motion_card(cable, number).figure == f"curve_{number}"
    sections = write_sections(MOTION_SECTIONS[1:2], MotionSubject(found, "motions.csv"), "motion", tmp_path)
    assert [path.name for path in (tmp_path / "figures").iterdir()] == [f"curve_{number}.svg"]
    assert "what joint 1 does over the joint angle" in sections[0].html


def test_the_atlas_frames_what_was_named(found: MotionDiagnosis) -> None:
    section = next(each for each in MOTION_SECTIONS if each.name == "atlas")
    shown = section.context(MotionSubject(found, "motions.csv"))["map"]
    framed = {
        (place, driver)
        for place, before, _ in shown.rows
        for driver, cell in zip(shown.drivers, before, strict=True)
        if cell.named
    }
    assert ("joint 1", "joint angle") in framed
    assert framed == {(cause.joint, cause.driver) for cause in found.verdict.effects}


def test_figures_hold_what_they_are_given() -> None:
    time = np.linspace(0, 1, 20)
    drawn = draw_trace("joint 9", "N", time, [(np.sin(time), "a", 1.0), (time, "b", 1.0), (time, "c", 1.0)]).svg()
    assert "joint 9" in drawn
    assert "torque (N)" in drawn
    curve = (np.linspace(-1, 1, 9), np.linspace(-2, 2, 9))
    assert "speed (deg/s)" in draw_friction("joint 1", curve, curve, ("speed (deg/s)", "friction (N m)")).svg()


def test_the_shown_piece_has_no_gap(found: MotionDiagnosis) -> None:
    part, piece = liveliest_piece(found.held, 50)
    assert piece.stop - piece.start == 50
    assert len(set(part.rows.stretch[part.which][piece].tolist())) == 1
    assert len(list(arm_of_motion(MotionSubject(found, "")))) == 1
