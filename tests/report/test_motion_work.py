"""The work order of a motion asks for what is to be entered, and for nothing else."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.summary.entering import Entered
from armscope.motion.summary.headline import MASSES_OFF
from armscope.motion.summary.lasting import LASTS
from armscope.motion.verdict import UnexplainedTorque
from armscope.report.pages.motion import write_motion_report
from armscope.report.sections.motion_work import error_in_words, paid_later, pays, where_it_shows
from tests.motion.moving import COULOMB, ROBOT, ROTOR, VISCOUS, moved, robot


def test_who_has_stated_all_drives_is_not_sent_to_a_table_of_dashes(tmp_path: Path) -> None:
    names, sizes = ("coulomb_nm", "viscous_nm_s_rad", "rotor_inertia_kg_m2"), (COULOMB, VISCOUS, ROTOR)
    drives = [dict(zip(names, map(float, of), strict=True)) for of in zip(*sizes, strict=True)]
    stronger = lambda q, dq, ddq, rigid: np.sign(dq) * [0.0, 1.5, 0.0]
    found = diagnose_motion(
        robot(drives=drives), moved(robot(), 1, stronger, seconds=10.0), MotionSettings(cutoff=10.0)
    )
    write_motion_report(found, "motions.csv", tmp_path)
    order = (tmp_path / "work-order.html").read_text(encoding="utf-8").replace("\u00a0", " ")
    assert "of the table below" not in order
    assert "<h2>Friction and rotors</h2>" not in order
    assert f"{error_in_words(found.entered[2].whole)} after this. Measured" in order


def test_a_step_that_puts_a_wrist_right_says_so_though_the_whole_arm_hardly_shows_it() -> None:
    """Of 26 % of all torque, 25 % were told to be left by the cause with the largest share."""
    before, after = Entered(0.26, (0.27, 0.22)), Entered(0.25, (0.265, 0.016))
    assert where_it_shows(before, after) == " (joint 2 alone: 22 % before, 1.6 % then)"
    assert where_it_shows(before, Entered(0.02, (0.01, 0.02))) == ""
    assert where_it_shows(before, before) == ""


def test_what_was_fitted_along_is_no_step_of_its_own_where_it_pays_nothing() -> None:
    """ "80 % after this" was promised of 80 %: what counted was a turned sign, which came after."""
    assert pays(0.797, 0.7)
    assert not pays(0.797, 0.796)
    assert not pays(0.797, 0.868)


def test_a_turned_current_is_told_as_that_on_page_and_order(tmp_path: Path) -> None:
    """It was "199.979 ± 0.075 % too small" with "Correct the joint's torque constant" as its cure."""
    gains = [20.0, 22.0, 15.0]
    drives = [{"gain_nm_per_a": gain, "gain_uncertainty": 0.03} for gain in gains]
    recorded = moved(robot(), 1, seconds=10.0)
    turned = replace(recorded, kind="current", effort=recorded.effort / gains * [1.0, 1.0, -1.0])
    found = diagnose_motion(robot(drives=drives), turned, MotionSettings(cutoff=10.0))
    write_motion_report(found, "motions.csv", tmp_path)
    first = found.verdict.effects[0]
    assert (first.effect, first.location) == ("motor_constant", "joint 3")
    assert found.verdict.headline.startswith("The sign of the recorded torque of joint 3 is turned")
    assert first.cure.startswith("Turn the sign of current3_a, or of the joint's gain_nm_per_a in robot.yaml")
    for page in ("report.html", "work-order.html"):
        text = (tmp_path / page).read_text(encoding="utf-8").replace("\u00a0", " ")
        assert "The sign of the recorded torque of joint 3 is turned" in text
        assert "Turn the sign of current3_a" in text
        assert "too small" not in text


def order_of(found: MotionDiagnosis, folder: Path) -> str:
    write_motion_report(found, "motions.csv", folder)
    return (folder / "work-order.html").read_text(encoding="utf-8").replace("\u00a0", " ")


def test_masses_are_a_step_only_where_the_headline_says_that_they_are_off(tmp_path: Path) -> None:
    """ "No cause of the library explains it" was the headline, "masses are not as stated" a step of the order."""
    links: list[dict[str, Any]] = ROBOT["links"]  # type: ignore[assignment]
    off = [(0.96, (6, -8, 5)), (1.05, (12, 15, -9)), (0.97, (-14, 6, 11))]
    true = [
        {**link, "mass_kg": share * link["mass_kg"], "com_mm": [a + b for a, b in zip(link["com_mm"], by, strict=True)]}
        for link, (share, by) in zip(links, off, strict=True)
    ]
    found = diagnose_motion(robot(), moved(robot(links=true), 1, noise=0.005, seconds=10.0))
    assert found.verdict.headline.startswith(MASSES_OFF)
    step = f"<b>{MASSES_OFF} are not as stated.</b>"
    assert step in order_of(found, tmp_path)
    other = replace(found.verdict, headline="Something lasts that has no law here. No cause explains it.")
    assert step not in order_of(replace(found, verdict=other), tmp_path)


def test_what_lasts_comes_before_all_steps(tmp_path: Path) -> None:
    """The order did not have it."""
    found = diagnose_motion(robot(), moved(robot(), 1, seconds=10.0), MotionSettings(cutoff=10.0))
    assert "First look there" not in order_of(found, tmp_path)
    lasts = UnexplainedTorque(True, "joint 3", "angle", f"{LASTS}: 12 % of the torque of joint 3, following the angle")
    order = order_of(replace(found, verdict=replace(found.verdict, unexplained=lasts)), tmp_path)
    assert f"First look there: {lasts.description}." in order
    assert order.index("First look there") < order.index("Friction and rotors of every joint")


def test_a_step_that_leaves_no_less_says_with_which_it_pays() -> None:
    """Seen: "12 % after this", then "17 % after 1 to 2, 17 % after 1 to 3, 6.8 % after 1 to 4"."""
    assert paid_later(0.12, [0.17, 0.17, 0.068, 0.04], first=2) == [
        "; it pays with step 4: 6.8 %",
        "; it pays with step 4: 6.8 %",
        "",
        "",
    ]
    assert paid_later(0.12, [0.1, 0.1, 0.11], first=1) == ["", "", ""], "what never pays promises nothing"
