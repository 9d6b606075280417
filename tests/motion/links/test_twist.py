"""Links recorded beside their motors: what winds up, plays or is rigid in MuJoCo is told as what it is."""

import numpy as np
import pandas as pd
import pytest

from armscope.motion.pipeline import MotionDiagnosis, diagnose_motion
from armscope.motion.verdict import FoundCause
from armscope.recordings.motions import as_motions
from tests.motion.moving import robot
from tests.motion.two_inertias import RIGID, play, recorded, said_of, spring
from tests.seeds import seeds


def diagnosed(table: pd.DataFrame) -> MotionDiagnosis:
    return diagnose_motion(robot(), as_motions(table, "motions.csv", 3))


def named(found: MotionDiagnosis) -> list[FoundCause]:
    (side,) = found.verdict.links
    return [cause for cause in side.causes if not cause.minor]


SPRINGS = [
    (1, 12000.0, 1),
    *(pytest.param(*each, marks=pytest.mark.long) for each in ((2, 12000.0, 2), (3, 3000.0, 3))),
]


@pytest.mark.long
@pytest.mark.parametrize(("joint", "stiffness", "seed"), SPRINGS)
def test_a_spring_between_two_inertias_is_found_with_its_stiffness(joint: int, stiffness: float, seed: int) -> None:
    found = said_of(spring(stiffness), joint, seed)
    (cause,) = named(found)
    assert (cause.effect, cause.location, cause.doubt) == ("joint_elasticity", f"joint {joint}", "")
    told = cause.parameters[0]
    assert (told.name, told.unit) == ("stiffness", "N m/rad")
    low, high = told.interval
    assert low < stiffness < high < 1.02 * low
    assert cause.consistent
    assert found.verdict.answer in ("explained", "partly explained")
    assert "winds up under its torque" in found.verdict.headline
    side = found.verdict.links[0]
    assert side.left < 0.05 * side.rms  # on motion that took no part
    assert "joint_compliance" not in [each.effect for each in found.verdict.effects]  # told once, where it was read


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(4, 5))
def test_friction_that_sticks_before_a_spring_gets_no_name(seed: int) -> None:
    """A controller's motors rest some samples where they turn back; the link swings on behind them."""
    found = said_of(spring(3000.0), 3, seed)
    assert not [each for each in found.verdict.effects if not each.minor]


@pytest.fixture(scope="module")
def rigid() -> MotionDiagnosis:
    """An arm whose link and motor count from zeros of their own."""
    table = recorded(RIGID, 2)
    table["q2_link_rad"] += 0.3
    return diagnosed(table)


def test_a_rigid_drive_says_nothing(rigid: MotionDiagnosis) -> None:
    assert not rigid.verdict.links[0].causes
    assert rigid.verdict.links[0].left == rigid.verdict.links[0].rms
    assert "winds up" not in rigid.verdict.headline


def test_zeros_that_differ_are_an_offset_and_no_cause(rigid: MotionDiagnosis) -> None:
    side = rigid.verdict.links[0]
    low, high = side.offset.interval
    assert low < 0.3 < high
    assert not side.causes


@pytest.mark.long
def test_a_play_is_no_spring() -> None:
    (cause,) = named(said_of(play(1e-3), 1))
    assert cause.effect == "joint_play"
    low, high = cause.parameters[0].interval
    assert low < 1e-3 < high


@pytest.mark.long
def test_a_link_read_late_and_geared_otherwise_winds_up_nowhere() -> None:
    table = recorded(RIGID, 1)
    for _, run in table.groupby("run"):
        late = np.interp(run.time_s - 0.002, run.time_s, run.q1_link_rad)
        table.loc[run.index, "q1_link_rad"] = 1.004 * late
    causes = {cause.effect: cause.parameters[0].value for cause in named(diagnosed(table))}
    assert causes == {"encoder_lag": pytest.approx(0.002, rel=0.02), "gear_ratio": pytest.approx(0.004, rel=0.02)}
