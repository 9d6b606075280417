"""Held-out rows are of the recorded session: where nobody knows when, it is as it was on average."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.physics.drift import BASE_SHIFT, shift
from armscope.physics.effect import Part
from armscope.physics.model import Base, FittedModel, predict
from armscope.proof.diagnosing import predicted_during

from ..diagnosis.planted import one_run
from ..physics.scenes import arm_named

JUMP_M = 1e-3


def test_a_base_that_jumped_midway_is_taken_to_be_halfway_where_no_time_tells() -> None:
    arm = arm_named("six-axis")
    timeless = replace(one_run(arm, 40, seed=3), time=None)
    jump = shift(BASE_SHIFT, timeless, 20, multiplicity=1)
    values = np.zeros(len(jump.terms))
    values[0] = JUMP_M
    model = FittedModel(arm, {"1": Base(np.eye(3), np.zeros(3))}, (), (Part(jump, values),))
    poses = replace(one_run(arm, 10, seed=4), time=None, number=np.full(10, np.nan))
    standing = predict(replace(model, parts=()), poses)
    of_now, during = (points - standing for points in (predict(model, poses), predicted_during(model, timeless, poses)))
    np.testing.assert_allclose(of_now, np.tile([JUMP_M, 0, 0], (10, 1)), atol=1e-12)
    np.testing.assert_allclose(during, of_now / 2, atol=1e-12)


def test_on_average_is_that_of_the_run_in_which_poses_were_taken() -> None:
    """Rows 1 to 20 are one run, 21 to 40 another, in whose midst the base jumped."""
    arm = arm_named("six-axis")
    table = replace(one_run(arm, 40, seed=3), time=None, run=np.repeat(["a", "b"], 20))
    jump = shift(BASE_SHIFT, table, 30, multiplicity=1)
    values = np.zeros(len(jump.terms))
    values[0] = JUMP_M
    still = Base(np.eye(3), np.zeros(3))
    model = FittedModel(arm, {"a": still, "b": still}, (), (Part(jump, values),))
    poses = one_run(arm, 10, seed=4)
    poses = replace(poses, time=None, number=np.full(10, np.nan), run=np.repeat(["a", "b"], 5))
    moved = predicted_during(model, table, poses) - predict(replace(model, parts=()), poses)
    np.testing.assert_allclose(moved[:, 0], np.repeat([0.0, JUMP_M / 2], 5), atol=1e-12)


def test_poses_whose_time_is_known_are_predicted_at_it() -> None:
    arm = arm_named("six-axis")
    table = one_run(arm, 40, seed=3)
    poses = one_run(arm, 10, seed=4)
    model = FittedModel(arm, {"1": Base(np.eye(3), np.zeros(3))}, (), ())
    np.testing.assert_array_equal(predicted_during(model, table, poses), predict(model, poses))
