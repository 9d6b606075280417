"""Scatter that follows the side from which a joint came is told as play, where the order of rows shows it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.summary.scatter import sides_by_order
from armscope.recordings import Recordings, read_recordings
from armscope.robot import Arm
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.sentences import headline
from tests.diagnosis.planted import one_run, recorded
from tests.physics.scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)
GAP = 6e-4
IN_ORDER = "in the order in which they were measured"


@pytest.fixture(scope="module")
def arm() -> Arm:
    return arm_named("six-axis")


def with_play(arm: Arm, gap: float, seed: int) -> Recordings:
    """Poses one after the other; joint 2 stays behind on each way, and nobody wrote down the side."""
    table = one_run(arm, 120, seed)
    motion = np.diff(table.motor_angles[:, 1], prepend=table.motor_angles[0, 1] - 1)
    stands = table.motor_angles.copy()
    stands[:, 1] -= np.sign(motion) * gap / 2
    measured = recorded(arm, replace(table, motor_angles=stands, approach=None), {}, 0.02, seed)
    return replace(measured, motor_angles=table.motor_angles, time=None)


def told(verdict: Diagnosis) -> dict[str, tuple[float, float]]:
    (effect,) = [each for each in verdict.effects if each.effect == "unknown" and each.location == "joint 2"]
    return {each.name: (each.value, each.stderr) for each in effect.parameters}


@pytest.fixture(scope="module")
def without_sides(arm: Arm) -> Diagnosis:
    """What is said of play of which nobody wrote down the side."""
    return diagnose(arm, with_play(arm, GAP, 30), QUICK)


@pytest.fixture(scope="module")
def ahead_of_readings(arm: Arm) -> Diagnosis:
    """What is said of a joint that stands ahead of its reading on each way."""
    return diagnose(arm, with_play(arm, -GAP, 30), QUICK)


@pytest.mark.long
def test_play_is_sized_by_the_order_of_rows(without_sides: Diagnosis) -> None:
    value, stderr = told(without_sides)["play"]
    assert abs(value - GAP) < 3 * stderr
    assert IN_ORDER in without_sides.headline


@pytest.mark.long
def test_whoever_writes_the_sides_down_as_told_gets_the_play_named(
    arm: Arm, without_sides: Diagnosis, tmp_path: Path
) -> None:
    """The cure's own words, followed to the letter: all columns, through a file."""
    table = with_play(arm, GAP, 30)
    (scatter,) = [each for each in without_sides.effects if each.effect == "unknown"]
    names = [f"approach{motor}" for motor in range(1, arm.n_motors + 1)]
    assert f"{names[0]} ... {names[-1]}" in scatter.cure
    columns = {f"q{n}_rad": q for n, q in enumerate(table.motor_angles.T, 1)}
    columns |= dict(zip(("x_mm", "y_mm", "z_mm"), 1e3 * table.positions.T, strict=True))
    sides = {name: sides_by_order(table, n).astype(int) for n, name in enumerate(names, 1)}
    if table.payload is not None:
        columns["payload_kg"] = table.payload
    pd.DataFrame({**columns, **sides}).to_csv(tmp_path / "recordings.csv", index=False)
    verdict = diagnose(arm, read_recordings(tmp_path / "recordings.csv"), QUICK)
    found = {(each.effect, each.location): each for each in verdict.effects}
    (gap,) = found["backlash", "joint 2"].parameters
    assert gap.value == pytest.approx(GAP, rel=0.1)


@pytest.mark.long
def test_play_is_not_told_where_the_order_of_rows_shows_none(arm: Arm, ahead_of_readings: Diagnosis) -> None:
    """Rows that somebody sorted say nothing; a joint that stands ahead of its reading has no play."""
    table = with_play(arm, GAP, 30)
    table = table.rows(np.random.default_rng(1).permutation(len(table)))
    shuffled = diagnose(arm, replace(table, number=np.arange(1.0, len(table) + 1)), QUICK)
    for verdict in (shuffled, ahead_of_readings):
        assert "play" not in told(verdict)
        assert IN_ORDER not in headline(verdict)


def test_a_joint_that_goes_on_after_it_was_read_is_told_as_that(ahead_of_readings: Diagnosis) -> None:
    verdict = ahead_of_readings
    value, stderr = told(verdict)["overrun"]
    assert abs(value - GAP) < 3 * stderr
    (scatter,) = [each for each in verdict.effects if each.effect == "unknown"]
    assert "come to rest before its angles are read" in scatter.cure
    assert "ahead of its readings" in verdict.headline


def test_sides_follow_the_clock_of_each_run_and_not_where_a_row_stands(arm: Arm) -> None:
    table = one_run(arm, 6, 1)
    angles = np.zeros((6, table.motor_angles.shape[1]))
    angles[:, 1] = [0.3, 0.1, 0.2, 5.0, 5.0, 4.0]
    table = replace(
        table, motor_angles=angles, run=np.array(["1"] * 3 + ["2"] * 3), time=np.array([3.0, 1, 2, 4, 5, 6])
    )
    assert sides_by_order(table, 2).tolist() == [1, 0, 1, 0, 0, -1]
    back = np.arange(6)[::-1]
    assert sides_by_order(table.rows(back), 2).tolist() == [-1, 0, 0, 1, 0, 1]
