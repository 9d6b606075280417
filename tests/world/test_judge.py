"""Which other answers explain a concealed effect as well, and what an oracle sees of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import orth

from armscope.physics import scene as physics
from armscope.physics.frames import free_frames as contract_frames
from armscope.recordings import Recordings
from armscope.robot import load_arm
from armscope.world.judge import Judge
from armscope.world.kinds import Concealed
from armscope.world.strength import free_frames, sized
from tests.world.by_hand import ARMS, ROBOTS
from tests.world.scenes import drawn, scene_of

SIGMA = 3e-5


def judged(arm, kind, place, rule="free", strength=5.0, values=None, beside=()):
    scene, tool = scene_of(arm, rule, count=120)
    effect = drawn(scene, kind, place)
    if values:
        effect = Concealed(effect.kind, place, {**effect.values, **values})
    found = sized(scene, effect, strength * SIGMA)
    return Judge(scene, tool).visibility(found, [sized(scene, other, 5 * SIGMA) for other in beside], SIGMA)


def names(visibility):
    return {(a.effect, a.location) for a in visibility.alternatives}


def test_a_tilting_base_and_a_tilting_first_bearing_are_one_where_their_origins_coincide():
    assert ("bearing_compliance", "joint 1") in names(judged("six-axis", "base_compliance", "base"))


def test_they_are_two_where_the_first_axis_has_its_origin_above_the_base():
    assert names(judged("seven-axis", "base_compliance", "base")) == set()


def test_without_payload_changes_a_parallelograms_soft_motor_2_looks_like_an_eccentric_gear():
    found = judged("parallelogram-120kg", "joint_compliance", "joint 2", "no_payload")
    assert ("gear_eccentricity", "joint 2") in names(found)


def test_payload_changes_tell_them_apart():
    assert names(judged("parallelogram-120kg", "joint_compliance", "joint 2")) == set()


def test_a_lag_at_speeds_in_step_with_the_angle_looks_like_a_gear_ratio():
    assert ("gear_ratio", "joint 3") in names(judged("seven-axis", "servo_lag", "joint 3", "constant_speed"))
    assert names(judged("seven-axis", "servo_lag", "joint 3")) == set()


def test_the_oracle_sees_strength_squared_per_coordinate_of_an_effect_alone():
    assert judged("six-axis", "gear_mesh", "joint 4", strength=5.0).noncentrality == pytest.approx(25 * 360, rel=0.01)


def test_beside_an_effect_that_shares_its_pattern_less_is_left_to_see():
    scene, _ = scene_of("six-axis", count=120)
    alone = judged("six-axis", "joint_offset", "joint 3")
    crowded = judged("six-axis", "joint_offset", "joint 3", beside=[drawn(scene, "joint_offset", "joint 2")])
    assert crowded.noncentrality < 0.9 * alone.noncentrality


def test_nothing_is_an_alternative_to_what_nobody_can_see():
    assert judged("six-axis", "joint_offset", "joint 3", strength=0.01).alternatives == ()


@pytest.mark.parametrize("arm", ARMS)
def test_the_oracle_in_runs_fits_the_frames_that_the_diagnosis_fits(arm):
    """A base per run and one tool point: the same displacements as the contract's free frames, by another engine."""
    scene, tool = scene_of(arm, count=60)
    session = scene.session
    rows = len(session)
    table = Recordings(
        motor_angles=session.commanded,
        positions=np.full((rows, 3), np.nan),
        run=session.run.astype(str),
        target=np.full(rows, ""),
        id=np.arange(1, rows + 1).astype(str),
    )
    assert len(np.unique(table.run)) > 1
    contract = contract_frames(table, tool_per_run=False)
    posture = physics.Scene(load_arm(ROBOTS / f"{arm}.yaml"), table).posture()
    given = np.column_stack([posture.column(term).ravel() for placed in contract for term in placed.terms])
    oracle = free_frames(tool, scene.tool_turn, session.run)
    assert oracle.shape == given.shape
    np.testing.assert_allclose(projector(oracle), projector(given), atol=1e-6)


def projector(columns):
    basis = orth(columns / np.linalg.norm(columns, axis=0), rcond=1e-8)
    return basis @ basis.T


def test_a_shift_between_runs_is_the_frames_own_where_runs_are_told():
    """A base that jumps when a run begins can be seen in one table without runs, and by nobody in one with them."""
    scene, tool = scene_of("six-axis", count=120)
    run = scene.session.run
    twist = free_frames(tool, scene.tool_turn, run)[:, :6] @ np.full(6, 1e-4)
    found = sized(scene, drawn(scene, "joint_offset", "joint 3"), 5 * SIGMA)
    jump = replace(found, pattern=twist.reshape(-1, 3))
    judge = Judge(scene, tool)
    known = judge.visibility(jump, [], SIGMA)
    told = judge.seen_in_runs(known, jump, [], SIGMA, run)
    assert known.frame_numbers == 9
    assert told.frame_numbers == 6 * len(np.unique(run)) + 3
    assert known.noncentrality > 100
    assert told.noncentrality < 1e-6 * known.noncentrality
    one = judge.seen_in_runs(known, jump, [], SIGMA, np.ones_like(run))
    assert one.noncentrality == pytest.approx(known.noncentrality)
