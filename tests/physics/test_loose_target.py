"""A target that moves on the tool under its own weight, against plain geometry; told where it is, and only there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.physics.effect import Part
from armscope.physics.loose_target import EFFECTS, HOLDER_SAG, LOOSE_TARGET, NESTS, tool_turns_over
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm, chain
from armscope.robot.arm import build_arm
from armscope.verdict.schema import Verdict
from tests.seeds import seeds

from ..diagnosis.planted import one_run
from .scenes import arm_named, full_table

QUICK = Settings(resamples=0, cross_validation=False)
DOWN = np.array([0.0, 0.0, -1.0])
NOISE_M = 2e-5


def weight_in_tool(arm: Arm, table: Recordings) -> np.ndarray:
    """(N, 3) share of a weight along the tool's axes."""
    return np.einsum("nij,i->nj", chain(arm, table.motor_angles).tool_rotation, DOWN)


def measured(arm: Arm, table: Recordings, in_tool: np.ndarray, seed: int) -> Recordings:
    """The table with points measured of a target that is so much off in the tool (N, 3), m."""
    frames = chain(arm, table.motor_angles)
    noise = np.random.default_rng(seed).normal(0, NOISE_M, in_tool.shape)
    return replace(table, positions=frames.tool + np.einsum("nij,nj->ni", frames.tool_rotation, in_tool) + noise)


def told(verdict: Verdict) -> list[tuple[str, str]]:
    return [(effect.effect, effect.location) for effect in verdict.effects]


def test_a_holder_moves_along_an_axis_by_sag_times_the_weights_share_there() -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, 30, seed=3)
    (sag,) = HOLDER_SAG.place(arm, table)
    scene, values = Scene(arm, table), np.array([3e-4, -1e-4])
    by_hand = np.einsum(
        "nij,nj->ni", scene.nominal.tool_rotation, weight_in_tool(arm, table) * np.array([*values, 0.0])
    )
    np.testing.assert_allclose(scene.posture([Part(sag, values)]).tool - scene.nominal.tool, by_hand, atol=1e-9)


@pytest.mark.parametrize("axes", NESTS)
def test_a_loose_target_lies_on_the_lower_side_by_its_play(axes: str) -> None:
    """Whatever way the tool is turned: down the axis or the plane, as far as it has play, where that leans enough."""
    arm = arm_named("six-axis")
    table = full_table(arm, 60, seed=4)
    (nest,) = [placed for placed in LOOSE_TARGET.place(arm, table) if placed.variant == axes]
    scene = Scene(arm, table)
    shift = np.einsum(
        "nji,nj->ni",
        scene.nominal.tool_rotation,
        scene.posture([Part(nest, np.array([1e-4]))]).tool - scene.nominal.tool,
    )
    free = ["xyz".index(axis) for axis in axes]
    weight = weight_in_tool(arm, table)[:, free]
    steep = np.linalg.norm(weight, axis=1)
    assert np.abs(np.delete(shift, free, axis=1)).max() < 1e-9
    down = np.sum(shift[:, free] * weight, axis=1) / steep
    assert (down[steep > 0.5] > 0.97e-4).all()
    assert (down[steep > 0.5] < 1.0001e-4).all()


def test_neither_is_looked_for_where_the_tool_stands_alike_to_gravity_or_nothing_has_weight() -> None:
    arm = arm_named("parallelogram-120kg")
    upright = full_table(arm, 30, seed=5)
    level = replace(upright, motor_angles=upright.motor_angles * np.array([1.0, 0, 0, 0, 0, 0]))
    assert tool_turns_over(arm, upright)
    assert not tool_turns_over(arm, level)
    weightless = build_arm(arm.description.model_copy(update={"gravity_m_s2": (0.0, 0.0, 0.0)}))
    assert not [placed for effect in EFFECTS for placed in effect.place(weightless, upright)]


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_a_target_that_falls_over_is_told_as_one_and_the_arm_is_not_blamed(seed: int) -> None:
    """By a hard step, which is no column of the library; a stiff arm without an error of its own."""
    arm = arm_named("six-axis")
    table = one_run(arm, 80, seed=seed)
    weight = weight_in_tool(arm, table)[:, 0]
    side = np.where(np.abs(weight) > 0.12, np.sign(weight), 0.0)
    verdict = diagnose(arm, measured(arm, table, np.outer(3e-4 * side, [1, 0, 0]), seed), QUICK)
    assert told(verdict) == [("loose_target", "tool")]
    (play,) = [p for p in verdict.effects[0].parameters if p.name == "play_x"]
    assert abs(play.value - 0.3) < 0.03


@pytest.mark.parametrize("seed", seeds(11, 12, 13))
def test_a_holder_that_bends_is_told_with_its_sag(seed: int) -> None:
    arm = arm_named("six-axis")
    table = one_run(arm, 80, seed=seed)
    sag = weight_in_tool(arm, table) * np.array([2e-4, 2e-4, 0.0])
    verdict = diagnose(arm, measured(arm, table, sag, seed), QUICK)
    assert told(verdict) == [("holder_sag", "tool")]
    for parameter in verdict.effects[0].parameters:
        assert abs(parameter.value - 0.2) < 4 * parameter.stderr + 0.005
