"""A drive's gain far from what is stated has its name, whatever else is off beside it."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.summary.told_gains import factors_in_words, rests_on_gains
from armscope.motion.verdict import MotionVerdict, Step
from armscope.recordings.motions import Motions
from armscope.report.pages.motion import write_motion_report
from armscope.verdict.effects import Parameter
from tests.motion.moving import ROBOT, moved, robot
from tests.seeds import seeds

STATED, GAIN = 10.0, 0.93
"""N m/A of all drives; times which joint 2's torque is recorded."""


def by_currents(seed: int, gain: float) -> Motions:
    """Motions of an arm whose masses are all off a little, which hides a gain."""
    links: list[dict[str, Any]] = ROBOT["links"]  # type: ignore[assignment]
    shares = (1.1, 0.93, 1.08)
    true = [
        {**link, "mass_kg": share * link["mass_kg"], "com_mm": [1.05 * share * each for each in link["com_mm"]]}
        for link, share in zip(links, shares, strict=True)
    ]
    motions = moved(robot(links=true), seed, noise=0.01)
    return dataclasses.replace(motions, kind="current", effort=motions.effort * [1.0, gain, 1.0] / STATED)


def told_gain(motions: Motions, uncertainty: float) -> Parameter | None:
    arm = robot(drives=[{"gain_nm_per_a": STATED, "gain_uncertainty": uncertainty}] * 3)
    verdict = diagnose_motion(arm, motions, MotionSettings(cutoff=10.0)).verdict
    named = [each for each in verdict.effects if each.effect == "motor_constant"]
    assert all(each.location == "joint 2" for each in named)
    return named[0].parameters[0] if named else None


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_a_gain_beyond_what_is_stated_is_told(seed: int) -> None:
    found = told_gain(by_currents(seed, GAIN), 0.015)
    assert found is not None
    low, high = found.interval
    assert low < GAIN - 1 < high


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(1, 2, 3))
@pytest.mark.parametrize(("gain", "unsure"), [pytest.param(1.0, 0.015, marks=pytest.mark.long), (0.98, 0.03)])
def test_gains_within_what_is_stated_have_no_name(seed: int, gain: float, unsure: float) -> None:
    assert told_gain(by_currents(seed, gain), unsure) is None


def of_unstated(gains: tuple[float, ...]) -> MotionDiagnosis:
    """What is found of an arm as stated, whose drives' constants are stated without their uncertainty."""
    motions = moved(robot(), 1, noise=0.005, seconds=10.0)
    currents = dataclasses.replace(motions, kind="current", effort=motions.effort * gains / STATED)
    return diagnose_motion(robot(drives=[{"gain_nm_per_a": STATED}] * 3), currents, MotionSettings(cutoff=10.0))


@pytest.mark.long
def test_a_gain_that_nobody_was_sure_of_is_told_where_the_motion_is() -> None:
    found = of_unstated((1.0, 1.18, 1.0))
    (told,) = (each for each in found.verdict.effects if not each.minor)
    assert (told.effect, told.location) == ("motor_constant", "joint 2")
    low, high = told.parameters[0].interval
    assert low < 0.18 < high
    factor = float(re.findall(r"by ([\d.]+\d)", told.cure)[0])
    assert factor == pytest.approx(1 / 1.18, rel=0.01)
    assert found.model.gains[1] == 0.0, "what has a name is no share of all gains"
    assert "Nothing is missing" not in found.verdict.headline


@pytest.mark.long
def test_who_does_the_work_order_of_unstated_gains_reaches_what_it_promises(tmp_path: Path) -> None:
    """Nothing that changes the error is fitted along without a line that says what to enter."""
    found = of_unstated((1.15, 1.18, 1.12))
    write_motion_report(found, "motions.csv", tmp_path)
    page = re.sub(r"<[^>]+>", "", (tmp_path / "work-order.html").read_text(encoding="utf-8")).replace("\u00a0", " ")
    named = {each.location for each in found.verdict.effects if each.effect == "motor_constant"}
    assert {"joint 2", "joint 3"} <= named
    gains = np.array([gain for gain in found.model.gains if abs(gain) > 0.03])
    assert not len(gains) or "Multiply torque constants" in page


def test_gains_as_stated_that_nobody_was_sure_of_have_no_name() -> None:
    found = of_unstated((1.0, 1.0, 1.0))
    assert not [each for each in found.verdict.effects if each.effect == "motor_constant"]
    assert not [each for each in found.verdict.notices if each.kind == "fitted gains"]


def test_a_gain_without_a_name_is_told_by_its_factor() -> None:
    assert factors_in_words(np.array([0.25, 0.0, -0.2])).endswith("by 0.800 (joint 1), 1.250 (joint 3).")
    assert factors_in_words(np.zeros(3)) == factors_in_words(np.zeros(0)) == ""


def test_a_gain_within_what_is_stated_that_matters_is_told_by_a_notice() -> None:
    """Stated to 5 %, it is 6 % off: no name, but the model holds only with it, and so do the steps of the cure."""
    motions = moved(robot(), 1, noise=0.005, seconds=10.0)
    currents = dataclasses.replace(motions, kind="current", effort=motions.effort * [1.04, 1.06, 0.95] / STATED)
    arm = robot(drives=[{"gain_nm_per_a": STATED, "gain_uncertainty": 0.05}] * 3)
    verdict = diagnose_motion(arm, currents, MotionSettings(cutoff=10.0)).verdict
    assert not [each for each in verdict.effects if each.effect == "motor_constant"]
    (told,) = (each.text for each in verdict.notices if each.kind == "fitted gains")
    factor = float(re.findall(r"([\d.]+) \(joint 2\)", told)[0])
    assert factor == pytest.approx(1 / 1.06, rel=0.01)
    assert told in verdict.headline
    assert verdict.waterfall[1].label == "torque constants near the stated"


def test_gains_that_mend_most_are_told_behind_a_cause_that_has_a_name() -> None:
    """Friction of one joint was the whole headline; a constant 2.47 times its uncertainty off stood in a note."""
    base, along = Step("friction and rotors", 0.062, 0.082), Step("torque constants near the stated", 0.022, 0.052)
    verdict = cast(MotionVerdict, SimpleNamespace(waterfall=(base, along)))
    assert rests_on_gains(verdict)
    with_masses = dataclasses.replace(along, label="masses and torque constants near the stated")
    for others in ((base,), (base, dataclasses.replace(along, held_out=0.08)), (base, with_masses)):
        assert not rests_on_gains(cast(MotionVerdict, SimpleNamespace(waterfall=others)))


@pytest.mark.parametrize("gain", [0.82, 1.2])
def test_a_gain_far_off_among_others_that_are_off_a_little_is_worth_what_its_cure_brings(gain: float) -> None:
    """What is fitted along took it up wherever it was cured, and it stood last, as minor, or as no known law."""
    motions = moved(robot(), 1, noise=0.005, seconds=10.0)
    currents = dataclasses.replace(motions, kind="current", effort=motions.effort * [1.02, gain, 0.98] / STATED)
    arm = robot(drives=[{"gain_nm_per_a": STATED, "gain_uncertainty": 0.03}] * 3)
    verdict = diagnose_motion(arm, currents, MotionSettings(cutoff=10.0)).verdict
    (told,) = (each for each in verdict.effects if each.location == "joint 2")
    assert (told.effect, told.minor) == ("motor_constant", False)
    assert told.share > 0.8
    low, high = told.parameters[0].interval
    assert low < gain - 1 < high
    assert "recorded torque of joint 2 is" in verdict.headline
