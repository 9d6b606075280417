"""Intervals own what one model's noise does not know: paths that disagree, and gains that nobody has measured."""

import dataclasses

import numpy as np
import pandas as pd
import pytest

from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.summary.constants import INTERVALS
from armscope.recordings.motions import Motions, as_motions
from armscope.robot.dynamics import MovingArm
from tests.motion.moving import VISCOUS, moved, robot, table

LOAD_KG, STATED, TRUE = 1.5, 10.0, 8.5


def weighed(motions: Motions, **drive: float) -> tuple[float, tuple[float, float], bool]:
    """The load's mass, its interval, whether the gains are told; drives state another gain than they have."""
    arm = robot(drives=[{"gain_nm_per_a": STATED, **drive}] * 3)
    currents = dataclasses.replace(motions, kind="current", effort=motions.effort / TRUE)
    found = diagnose_motion(arm, currents, MotionSettings(cutoff=10.0))
    load = next(each for each in found.verdict.effects if each.effect == "payload_error")
    mass = load.parameters[0]
    return mass.value, mass.interval, any(notice.kind == "gains" for notice in found.verdict.notices)


@pytest.fixture(scope="module")
def loaded() -> Motions:
    return moved(robot(tool_load={"mass_kg": LOAD_KG, "com_mm": [0, 0, 0]}), 3, seconds=10.0)


@pytest.mark.long
def test_a_load_by_currents_of_unknown_gains_is_known_as_well_as_the_gains(loaded: Motions) -> None:
    value, (low, high), told = weighed(loaded)
    assert told
    assert value == pytest.approx(LOAD_KG * STATED / TRUE, rel=0.15), "what the stated gains make of it"
    assert low < LOAD_KG < high
    assert high - low > 0.5 * value


@pytest.mark.long
def test_gains_that_are_stated_to_be_exact_are_believed(loaded: Motions) -> None:
    _, (low, high), told = weighed(loaded, gain_uncertainty=0.0)
    assert not told
    assert high - low < 0.2 * LOAD_KG


def on_two_paths(arm: MovingArm, more: float) -> MotionDiagnosis:
    """Joint 1 has more viscous friction on the second of two paths."""
    rubbing = lambda q, dq, ddq, rigid: np.column_stack([more * dq[:, 0], 0 * dq[:, 1:]])
    one, other = table(arm, 5, seconds=10.0), table(arm, 5, rubbing, seconds=10.0)
    both = pd.concat([one[one["run"] == "path 1"], other[other["run"] == "path 2"]])
    return diagnose_motion(arm, as_motions(both, "motions.csv", arm.n_motors), MotionSettings(cutoff=10.0))


def half_width(found: MotionDiagnosis, joint: int) -> float:
    viscous = next(each for each in found.verdict.background[joint].parameters if each.name == "viscous")
    return viscous.interval[1] - viscous.value


@pytest.mark.long
def test_a_number_that_two_paths_tell_differently_is_known_less_well() -> None:
    arm = robot()
    alike, apart = on_two_paths(arm, 0.0), on_two_paths(arm, 0.5)
    assert half_width(apart, 0) > 2 * half_width(alike, 0)
    assert half_width(apart, 0) > 0.25, "half of the difference"
    assert half_width(apart, 2) < 2 * half_width(alike, 2), "another joint is as well known as before"
    assert VISCOUS[0] == pytest.approx(alike.verdict.background[0].parameters[1].value, abs=3 * half_width(alike, 0))


@pytest.mark.long
def test_what_stands_for_a_cause_acts_on_its_joint(loaded: Motions) -> None:
    """Friction of another joint, which was there too, was told as "31.9 nats better, too close to tell apart"."""
    offset = np.array([0.0, 0.0, 1.5])
    late = dataclasses.replace(loaded, effort=loaded.effort + offset)
    found = diagnose_motion(robot(), late, MotionSettings(cutoff=10.0))
    placed = found.selected.rows.layout.placed
    assert len(found.selected.best.candidates) > 1
    for number, rivals in found.sure.rivals.items():
        assert rivals
        for rival in rivals:
            assert set(placed[rival.chosen[-1].candidate].joints) & set(placed[number].joints)


def test_a_load_is_known_but_for_what_a_drawing_leaves_open_of_its_link() -> None:
    """Seen: 2.501 kg +- 2.5, as if the last link could weigh nothing: no evidence tells it from what it carries."""
    load = {"mass_kg": 2.0, "com_mm": [30, 20, 60], "inertia_kg_m2": [0.02, 0.015, 0.01, 0.002, 0.001, 0.001]}
    found = diagnose_motion(robot(), moved(robot(tool_load=load), 3, seconds=10.0), MotionSettings(cutoff=10.0))
    (carried,) = [each for each in found.verdict.effects if each.effect == "payload_error"]
    numbers = {number.name: number for number in carried.parameters}
    assert len(numbers) > 4, "a load with an inertia of its own"
    mass = numbers["mass"]
    assert mass.interval[0] < 2.0 < mass.interval[1]
    last_link_kg = 4.0
    assert (mass.interval[1] - mass.interval[0]) / 2 < 2 * INTERVALS.link_known * last_link_kg
