"""A joint's zero that jumps in the course of a session, in arms whose kinematics are written in NumPy alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.physics.form_constants import FORM
from armscope.physics.zero_shift import ZERO_SHIFT, zero_shift
from armscope.verdict.diagnosis import Diagnosis

from ..numpy_arms import IIWA, NOISE_M, ROWS, UR5E, said, still
from ..planted import planted

JUMPS_AT = 90
WITHOUT_WRIST = UR5E[:4]


def jumped(joint: int, radians: float) -> Callable[[Array, Array], None]:
    def moved(angles: Array, row: Array) -> None:
        angles[row >= JUMPS_AT, joint - 1] += radians

    return moved


def drifts(verdict: Diagnosis) -> list[tuple[str, str]]:
    """What is said to have moved in the session."""
    return [(e.effect, e.location) for e in verdict.effects if e.family == "drift" or e.driver == "time"]


@pytest.mark.parametrize(
    ("rows", "joint", "radians"),
    [
        pytest.param(UR5E, 2, 2e-4, marks=pytest.mark.long),
        pytest.param(UR5E, 4, 1e-3, marks=pytest.mark.long),
        pytest.param(UR5E, 3, -5e-4, marks=pytest.mark.long),
        (IIWA[:5], 4, 5e-4),
    ],
)
def test_a_zero_that_jumps_is_named_with_its_size_and_moment(
    rows: list[tuple[float, float, float]], joint: int, radians: float
) -> None:
    time = 15.0 * np.arange(ROWS)
    verdict = said(rows, jumped(joint, radians), seed=joint, time=time)
    assert drifts(verdict) == [("zero_shift", f"joint {joint}")]
    (found,) = (e for e in verdict.effects if e.effect == "zero_shift")
    numbers = {p.name: p for p in found.parameters}
    assert abs(numbers["jump"].value - radians) < 3 * numbers["jump"].stderr < abs(radians)
    assert abs(numbers["time"].value - time[JUMPS_AT]) <= 3 * numbers["time"].stderr
    assert verdict.noise_mm < 1.1 * 1e3 * NOISE_M, "nothing of the step is left"


@pytest.mark.long
def test_its_moment_is_a_row_where_no_time_was_recorded() -> None:
    verdict = said(WITHOUT_WRIST, jumped(3, 1e-3), seed=11)
    (found,) = (e for e in verdict.effects if e.effect == "zero_shift")
    assert (found.location, found.parameters[-1].name) == ("joint 3", "row")
    assert abs(found.parameters[-1].value - (JUMPS_AT + 1)) <= 1


@pytest.mark.long
def test_a_zero_set_anew_between_two_runs_is_named_with_the_runs() -> None:
    run = np.where(np.arange(ROWS) < JUMPS_AT, "monday", "tuesday")
    verdict = said(WITHOUT_WRIST, jumped(3, 1e-3), seed=12, run=run)
    assert [(e.effect, e.location, e.driver) for e in verdict.effects if e.family == "drift"] == [
        ("zero_shift", "joint 3", "between runs monday and tuesday")
    ]


@pytest.mark.long
def test_a_zero_that_creeps_is_no_jump() -> None:
    def creeps(angles: Array, row: Array) -> None:
        angles[:, 2] += 1e-3 * row / ROWS

    verdict = said(WITHOUT_WRIST, creeps, seed=13, time=15.0 * np.arange(ROWS))
    assert drifts(verdict) == [("unknown", "joint 3")]


@pytest.mark.long
def test_an_arm_that_stands_still_in_the_session_has_no_jump() -> None:
    assert not drifts(said(WITHOUT_WRIST, still, seed=14, time=15.0 * np.arange(ROWS)))


def test_a_jump_while_the_arm_is_measured_is_rarer_than_one_between_sessions() -> None:
    """Ordered poses make what every arm has look like a jump: the prior settles what the rows leave open."""
    arm, table = planted("six-axis", {}, 40, 0.03, seed=2)
    within = zero_shift(table, 20, 7, 3)
    assert within.multiplicity == 7 * FORM.sessions_per_slip
    days = replace(table, run=np.repeat(["1", "2"], 20))
    assert {placed.multiplicity for placed in ZERO_SHIFT.place(arm, days)} == {1}


@pytest.mark.parametrize("rows_before", [4, 7])
def test_a_jump_some_rows_after_a_run_begins_is_told_where_it_was(rows_before: int) -> None:
    """Moments nearer than eight rows to a run's end were never tried: it came with the run, or rows late."""
    run = np.where(np.arange(ROWS) < JUMPS_AT - rows_before, "1", "2")
    verdict = said(WITHOUT_WRIST, jumped(3, 4e-4), seed=12, run=run)
    assert drifts(verdict) == [("zero_shift", "joint 3")]
    (found,) = (e for e in verdict.effects if e.effect == "zero_shift")
    assert {p.name: p.value for p in found.parameters}["row"] == JUMPS_AT + 1
    assert verdict.noise_mm < 1.02 * 1e3 * NOISE_M
