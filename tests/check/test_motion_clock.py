"""Torque that another clock recorded is told with its lag; what a drive lags is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pinocchio as pin
import pytest

from armscope.check.motion_constants import MOTION
from armscope.check.motions import check_moving
from armscope.recordings.motions import Motions, as_motions
from tests.motion.moving import COULOMB, ROTOR, VISCOUS, moved, path, robot


def put_off(motions: Motions, late: float, joints: tuple[int, ...]) -> Motions:
    effort = motions.effort.copy()
    for run in motions.runs:
        there = np.flatnonzero(motions.run == run)
        for j in joints:
            effort[there, j] = np.interp(motions.time[there] - late, motions.time[there], effort[there, j])
    return replace(motions, effort=effort)


@pytest.mark.parametrize(
    ("late", "joints", "told"),
    [
        (0.2, (0, 1, 2), "of all joints lies 200 ms after"),
        (-0.2, (0, 1, 2), "of all joints lies 200 ms before"),
        (0.2, (1,), "of joint 2 lies 200 ms after"),
        (-0.1, (1,), "of joint 2 lies 100 ms before"),
        (0.036, (0, 1, 2), ""),
        (0.0, (), ""),
    ],
)
def test_torque_of_another_clock_is_told_with_its_lag(late: float, joints: tuple[int, ...], told: str) -> None:
    """A lag of a drive is the diagnosis's to name; one that is many times as long was "unknown" there."""
    seen = check_moving(put_off(moved(robot(), 3), late, joints), robot()).suspicions
    found = [each for each in seen if "the motion" in each.statement]
    assert len(found) == bool(told)
    assert all(told in each.statement and each.weight == "problem" for each in found)
    assert all(f"{abs(late):g} s {'earlier' if late > 0 else 'later'}" in each.cure for each in found)


def one_joint_at_a_time() -> Motions:
    """Runs as they are made for friction: one joint moves, the others stand, held by anything within their band."""
    arm, rng, pieces = robot(), np.random.default_rng(8), []
    data = arm.model.createData()
    for moving in range(3):
        time, q, dq, ddq = path(rng, 3, 15.0, 200.0)
        alone = np.arange(3) == moving
        q, dq, ddq = np.where(alone, q, q[0]), dq * alone, ddq * alone
        held = np.cumsum(rng.normal(size=q.shape), axis=0)
        friction = np.where(alone, np.sign(dq), held / np.abs(held).max(axis=0))
        rigid = np.array([pin.rnea(arm.model, data, *row).copy() for row in zip(q, dq, ddq, strict=True)])
        torque = rigid + 3 * COULOMB * friction + VISCOUS * dq + ROTOR * ddq
        columns = {"run": f"joint {moving + 1}", "time_s": time}
        columns |= {f"q{j + 1}_rad": q[:, j] + 1e-5 * rng.normal(size=len(q)) for j in range(3)}
        pieces.append(pd.DataFrame(columns | {f"tau{j + 1}_nm": torque[:, j] for j in range(3)}))
    return as_motions(pd.concat(pieces, ignore_index=True), "motions.csv", 3)


@pytest.mark.parametrize(("late", "told"), [(0.1, "100 ms after"), (-0.1, "100 ms before"), (0.0, "")])
def test_joints_that_stand_hide_no_other_clock(late: float, told: str) -> None:
    """What holds a standing joint fits no time: in two rows of three it hid that the third fits another."""
    motions = one_joint_at_a_time()
    speed = np.abs(np.diff(motions.q, axis=0))
    assert np.mean(speed < MOTION.standing * np.quantile(speed, 0.99, axis=0)) > 0.6
    seen = check_moving(put_off(motions, late, (0, 1, 2)), robot()).suspicions
    found = [each.statement for each in seen if "the motion" in each.statement]
    assert bool(found) == bool(told)
    assert all(told in each for each in found)


def moves_with_rests() -> Motions:
    """All joints start and stop at once and rest between; friction keeps its side from the last way on."""
    arm, rng, pieces = robot(), np.random.default_rng(4), []
    data, time = arm.model.createData(), np.arange(0, 30, 0.005)
    for run in range(2):
        stops = rng.uniform(-1.2, 1.2, (16, 3))
        along = np.clip((time % 2.0) / 0.9, 0, 1)
        share = (along - np.sin(2 * np.pi * along) / (2 * np.pi))[:, None]
        leg = (time // 2.0).astype(int)
        q = stops[leg] + share * (stops[leg + 1] - stops[leg])
        dq = np.gradient(q, time, axis=0)
        ddq = np.gradient(dq, time, axis=0)
        rigid = np.array([pin.rnea(arm.model, data, *row).copy() for row in zip(q, dq, ddq, strict=True)])
        friction = np.sign(stops[leg + 1] - stops[leg])  # until the next way begins
        torque = rigid + 8 * COULOMB * friction + VISCOUS * dq + ROTOR * ddq
        columns = {"run": f"moves {run + 1}", "time_s": time}
        columns |= {f"q{j + 1}_rad": q[:, j] + 1e-5 * rng.normal(size=len(q)) for j in range(3)}
        pieces.append(pd.DataFrame(columns | {f"tau{j + 1}_nm": torque[:, j] for j in range(3)}))
    return as_motions(pd.concat(pieces, ignore_index=True), "motions.csv", 3)


@pytest.mark.parametrize(("late", "told"), [(0.2, "200 ms after"), (-0.2, "200 ms before"), (0.0, "")])
def test_friction_that_holds_a_rest_is_no_other_clock(late: float, told: str) -> None:
    """Where a joint rests friction keeps its side: taken for motion, that hid another clock, and looked like one."""
    seen = check_moving(put_off(moves_with_rests(), late, (0, 1, 2)), robot()).suspicions
    found = [each.statement for each in seen if "the motion" in each.statement]
    assert bool(found) == bool(told)
    assert all(told in each for each in found)
