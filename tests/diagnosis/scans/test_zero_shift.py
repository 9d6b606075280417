"""A joint's zero that jumps in the course of a session, in arms whose kinematics are written here, in NumPy alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.diagnosis import Settings, diagnose
from armscope.recordings import Recordings
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription
from armscope.verdict.diagnosis import Diagnosis

QUICK = Settings(resamples=0, cross_validation=False)
ROWS, JUMPS_AT, NOISE_M = 150, 90, 5e-5
UR5E = [(0, 90, 0.1625), (-0.425, 0, 0), (-0.3922, 0, 0), (0, 90, 0.1333), (0, -90, 0.0997), (0, 0, 0.0996)]
IIWA = [(0, -90, 0.34), (0, 90, 0), (0, 90, 0.4), (0, -90, 0), (0, -90, 0.4), (0, 90, 0), (0, 0, 0.126)]
"""a (m), alpha (degrees), d (m) of their data sheets."""
TOOL_M = np.array([0.03, 0.02, 0.08])
TOLERANCE = 1.5e-4
"""Every a, d (m) and alpha (rad) is off by about this."""


def reached(rows: list[tuple[float, float, float]], errors: Array, angles: Array) -> Array:
    """(N, 3) tool points, m, of standard D-H rows with errors (n, 3) of a, alpha, d at angles (N, n)."""
    points = np.tile(TOOL_M, (len(angles), 1))
    for (a, alpha, d), error, theta in zip(rows[::-1], errors[::-1], angles.T[::-1], strict=True):
        x, y, z = points.T
        s, c = np.sin(np.radians(alpha) + error[1]), np.cos(np.radians(alpha) + error[1])
        x, y, z = x + a + error[0], c * y - s * z, s * y + c * z + d + error[2]
        points = np.column_stack([np.cos(theta) * x - np.sin(theta) * y, np.sin(theta) * x + np.cos(theta) * y, z])
    return points


def said(
    rows: list[tuple[float, float, float]], moved: Callable[[Array, Array], None], seed: int, **context: Array
) -> Diagnosis:
    """What is said of an arm of ordinary tolerances whose angles, in the order of rows, were moved in some way."""
    rng = np.random.default_rng(seed)
    angles = rng.uniform(-2, 2, (ROWS, len(rows)))
    true = angles.copy()
    moved(true, np.arange(ROWS))
    errors = TOLERANCE * rng.normal(size=(len(rows), 3))
    table = Recordings(
        angles,
        reached(rows, errors, true) + NOISE_M * rng.normal(size=(ROWS, 3)),
        run=context.pop("run", np.full(ROWS, "1")),
        target=np.full(ROWS, ""),
        id=np.arange(1, ROWS + 1).astype(str),
        **context,
    )
    joints = [{"a_mm": 1e3 * a, "alpha_deg": alpha, "d_mm": 1e3 * d, "theta_offset_deg": 0} for a, alpha, d in rows]
    dh = {"convention": "standard", "joints": joints}
    return diagnose(build_arm(RobotDescription.model_validate({"name": "arm", "dh": dh})), table, QUICK)


def jumped(joint: int, radians: float) -> Callable[[Array, Array], None]:
    def moved(angles: Array, row: Array) -> None:
        angles[row >= JUMPS_AT, joint - 1] += radians

    return moved


def drifts(verdict: Diagnosis) -> list[tuple[str, str]]:
    """What is said to have moved in the session."""
    return [(e.effect, e.location) for e in verdict.effects if e.family == "drift" or e.driver == "time"]


@pytest.mark.parametrize(
    ("rows", "joint", "radians"), [(UR5E, 2, 2e-4), (UR5E, 4, 1e-3), (UR5E, 3, -5e-4), (IIWA, 4, 5e-4)]
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


def test_its_moment_is_a_row_where_no_time_was_recorded() -> None:
    verdict = said(UR5E, jumped(3, 1e-3), seed=11)
    (found,) = (e for e in verdict.effects if e.effect == "zero_shift")
    assert (found.location, found.parameters[-1].name) == ("joint 3", "row")
    assert abs(found.parameters[-1].value - (JUMPS_AT + 1)) <= 1


def test_a_zero_set_anew_between_two_runs_is_named_with_the_runs() -> None:
    run = np.where(np.arange(ROWS) < JUMPS_AT, "monday", "tuesday")
    verdict = said(UR5E, jumped(3, 1e-3), seed=12, run=run)
    assert [(e.effect, e.location, e.driver) for e in verdict.effects if e.family == "drift"] == [
        ("zero_shift", "joint 3", "between runs monday and tuesday")
    ]


def test_a_zero_that_creeps_is_no_jump() -> None:
    def creeps(angles: Array, row: Array) -> None:
        angles[:, 2] += 1e-3 * row / ROWS

    verdict = said(UR5E, creeps, seed=13, time=15.0 * np.arange(ROWS))
    assert drifts(verdict) == [("unknown", "joint 3")]


def test_an_arm_that_stands_still_in_the_session_has_no_jump() -> None:
    assert not drifts(said(UR5E, lambda angles, row: None, seed=14, time=15.0 * np.arange(ROWS)))
