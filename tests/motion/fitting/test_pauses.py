"""What holds a joint in a pause is no property of the arm and names nothing; one that turns back does not pause."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pinocchio as pin
import pytest

from armscope.core.types import Array
from armscope.motion.fitting.model_estimate import stated_model
from armscope.motion.fitting.pauses import Pauses, pauses_of
from armscope.motion.fitting.rows import MotionRows, build_rows
from armscope.motion.fitting.weights import fitted_together
from armscope.motion.library.layout import OWN, TorqueLayout
from armscope.motion.pipeline import diagnose_motion
from armscope.motion.samples.preparation import Signals, preparation
from armscope.motion.samples.timing import stretches
from armscope.recordings.motions import as_motions
from tests.motion.moving import COULOMB, ROTOR, VISCOUS, robot
from tests.seeds import seeds

RATE, PAUSES_S = 200.0, (0.08, 0.12, 0.16)


def from_point_to_point(seed: int, held: float) -> pd.DataFrame:
    """motions.csv: pauses shorter than a quarter of a second, in which friction stays at a share of what it was."""
    arm, rng, pieces = robot(), np.random.default_rng(seed), []
    for run in range(2):
        here, made, rests = np.zeros(3), [], []
        for _ in range(12):
            there, seconds = rng.uniform(-0.8, 0.8, 3), rng.uniform(0.8, 1.6)
            s = np.arange(0, 1, 1 / (seconds * RATE))[:, None]
            shapes = 10 * s**3 - 15 * s**4 + 6 * s**5, 30 * (s - s**2) ** 2, 60 * s - 180 * s**2 + 120 * s**3
            way, pause = there - here, int(rng.choice(PAUSES_S) * RATE)
            made.append([here + way * shapes[0], way * shapes[1] / seconds, way * shapes[2] / seconds**2])
            made.append([np.tile(there, (pause, 1)), np.zeros((pause, 3)), np.zeros((pause, 3))])
            rests.append(np.r_[np.zeros(len(s)), np.ones(pause)])
            here = there
        q, dq, ddq = (np.concatenate(each) for each in zip(*made, strict=True))
        pieces.append(_recorded(f"path {run + 1}", q, dq, ddq, (np.concatenate(rests) > 0, held), rng))
    assert arm.n_motors == 3
    return pd.concat(pieces, ignore_index=True)


def _recorded(
    run: str, q: Array, dq: Array, ddq: Array, at_rest: tuple[Array, float], rng: np.random.Generator
) -> pd.DataFrame:
    arm, (rests, held) = robot(), at_rest
    data = arm.model.createData()
    rigid = np.array([pin.rnea(arm.model, data, *row).copy() for row in zip(q, dq, ddq, strict=True)])
    moving = np.maximum.accumulate(np.where(rests, 0, np.arange(len(q))))
    side = np.where(rests[:, None], held * np.sign(dq[np.maximum(moving - 1, 0)]), np.tanh(dq / 1e-3))
    torque = rigid + COULOMB * side + VISCOUS * dq + ROTOR * ddq
    torque += 0.01 * torque.std(axis=0) * rng.normal(size=torque.shape)
    columns = {"run": run, "time_s": np.arange(len(q)) / RATE}
    columns |= {f"q{j + 1}_rad": q[:, j] + 1e-5 * rng.normal(size=len(q)) for j in range(3)}
    return pd.DataFrame(columns | {f"tau{j + 1}_nm": torque[:, j] for j in range(3)})


def rows_of(table: pd.DataFrame, cutoff: float = 15.0) -> MotionRows:
    layout = TorqueLayout(robot(), (), False)
    laid = list(stretches(as_motions(table, "motions.csv", 3)))
    return build_rows(layout, laid, preparation(RATE, cutoff, "test"), stated_model(robot()))


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_what_friction_does_in_pauses_names_nothing(seed: int) -> None:
    verdict = diagnose_motion(robot(), as_motions(from_point_to_point(seed, 0.6), "motions.csv", 3)).verdict
    assert not [each.title for each in verdict.effects if not each.minor]
    assert not verdict.unexplained.present


def test_friction_and_rotors_are_those_of_the_joints_in_motion() -> None:
    one, other = (rows_of(from_point_to_point(5, held)) for held in (0.9, -0.9))
    first, second = (
        fitted_together(rows, np.arange(rows.layout.width))[: 3 * OWN].reshape(3, OWN) for rows in (one, other)
    )
    assert first[:, 1] == pytest.approx(COULOMB, rel=0.03)
    assert second[:, 1] == pytest.approx(COULOMB, rel=0.03)


def test_the_force_of_a_pause_leaves_nothing_in_the_rows() -> None:
    """Whatever it is: by the same noise, recordings differ in what held the joints alone, and rows do not."""
    one, other = (rows_of(from_point_to_point(5, held)) for held in (0.9, -0.9))
    apart = np.where(one.still, 0.0, one.torque - other.torque)
    assert np.max(np.abs(apart), axis=0) == pytest.approx(1.8 * COULOMB, rel=0.5)
    left = np.where(one.still, 0.0, one.without_pauses(apart))
    assert np.linalg.norm(left, axis=0) == pytest.approx(0, abs=0.1 * np.linalg.norm(apart, axis=0).min())


def turning_back(acceleration: float) -> tuple[Signals, Pauses]:
    time = np.arange(2000) / 1000.0
    q = acceleration * np.c_[(time - 1) ** 2 / 2, time * 0, time * 0]
    still, kept = np.zeros((200, 3), dtype=bool), np.arange(0, 2000, 10)
    signals = Signals("run", 0, time, q, np.gradient(q, 1e-3, axis=0), q * 0, q[kept], None, None, kept)
    return signals, pauses_of(robot(), signals, preparation(1000.0, 33.0, "test"), still)[0]


def test_a_joint_that_turns_back_does_not_pause() -> None:
    assert not turning_back(0.5)[1].held


def test_one_that_turns_back_next_to_never_does() -> None:
    _, pauses = turning_back(0.005)
    assert pauses.held
    middle = np.concatenate([which for which, _ in pauses.held])
    assert np.all(np.abs(middle * 0.01 - 1) < 0.5)


def test_columns_of_overlapping_pauses_are_orthonormal() -> None:
    for pauses in rows_of(from_point_to_point(7, 0.6), cutoff=4.0).pauses:
        assert pauses.held
        for _, span in pauses.held:
            assert span.T @ span == pytest.approx(np.eye(span.shape[1]), abs=1e-9)
