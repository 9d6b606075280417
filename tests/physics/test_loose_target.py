"""A target that moves on the tool under its own weight, against plain geometry; told where it is, and only there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.physics.effect import Part
from armscope.physics.loose_target import EFFECTS, HOLDER_SAG, Way, nest, nests_about, nests_anyhow, tool_turns_over
from armscope.physics.model import Base, FittedModel
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
LATER: list[tuple[int, Way]] = [(2, "across"), (3, "along"), (4, "across")]


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
    scene = Scene(arm, table)
    for sag, values in zip(
        HOLDER_SAG.place(arm, table), ([3e-4, -1e-4], [3e-4, -1e-4, 2e-4, 5e-5, -2e-4]), strict=True
    ):
        x, y, xy, xz, yz = [*values, 0.0, 0.0, 0.0][:5]
        shift = weight_in_tool(arm, table) @ np.array([[x, xy, xz], [xy, y, yz], [xz, yz, 0.0]])
        by_hand = np.einsum("nij,nj->ni", scene.nominal.tool_rotation, shift)
        moved = scene.posture([Part(sag, np.array(values))]).tool - scene.nominal.tool
        np.testing.assert_allclose(moved, by_hand, atol=1e-9)


LEANING = [0.48, -0.6, 0.64]


@pytest.mark.parametrize("direction", [[1.0, 0, 0], [0, 0, 1.0], LEANING])
@pytest.mark.parametrize("way", ["along", "across"])
def test_a_loose_target_lies_on_the_lower_side_by_its_play(way: Way, direction: list[float]) -> None:
    """However the tool is turned: down the direction or the plane, as far as it has play, where that leans enough."""
    arm = arm_named("six-axis")
    table = full_table(arm, 60, seed=4)
    scene = Scene(arm, table)
    part = Part(nest(way, np.array(direction)), np.array([1e-4]))
    moved = scene.posture([part]).tool - scene.nominal.tool
    shift = np.einsum("nji,nj->ni", scene.nominal.tool_rotation, moved)
    onto = np.outer(direction, direction)
    free = onto if way == "along" else np.eye(3) - onto
    assert np.abs(shift - shift @ free).max() < 1e-9
    weight = weight_in_tool(arm, table) @ free
    steep = np.linalg.norm(weight, axis=1)
    down = np.sum(shift * weight, axis=1) / steep
    np.testing.assert_allclose(down[steep > 0.1], 1e-4, rtol=1e-3)
    np.testing.assert_allclose(down[steep <= 0.1], 0.0, atol=1e-9)


def test_nests_about_another_one_are_tilted_against_it_or_have_another_slope() -> None:
    coarse = nests_anyhow()["along"][17]
    itself, *about = nests_about(coarse, 5.0)
    middle = np.array([value for _, _, value in coarse.scanned])
    numbers = np.array([[value for _, _, value in each.scanned] for each in about])
    away = np.degrees(np.arccos(np.minimum(numbers[:, :3] @ middle[:3], 1.0)))
    as_steep = numbers[:, 3] == middle[3]
    assert itself is coarse
    np.testing.assert_allclose(away[as_steep], 5.0, atol=0.1)
    assert (away[~as_steep] < 1).all()
    assert {each.terms[0].name for each in about} == {"play_along"}


def test_neither_is_looked_for_where_the_tool_stands_alike_to_gravity_or_nothing_has_weight() -> None:
    arm = arm_named("parallelogram-120kg")
    upright = full_table(arm, 30, seed=5)
    level = replace(upright, motor_angles=upright.motor_angles * np.array([1.0, 0, 0, 0, 0, 0]))
    assert tool_turns_over(arm, upright)
    assert not tool_turns_over(arm, level)
    weightless = build_arm(arm.description.model_copy(update={"gravity_m_s2": (0.0, 0.0, 0.0)}))
    assert not [placed for effect in EFFECTS for placed in effect.place(weightless, upright)]


def test_no_command_of_the_arm_is_wrong_by_a_loose_target() -> None:
    arm = arm_named("six-axis")
    part = Part(nest("along", np.array(LEANING)), np.array([3e-4]))
    model = FittedModel(arm, {"1": Base(np.eye(3), np.zeros(3))}, (), (part,))
    assert model.in_its_own_base().parts == ()


@pytest.mark.parametrize(
    ("seed", "way"), [(1, "along"), *(pytest.param(n, w, marks=pytest.mark.long) for n, w in LATER)]
)
def test_a_target_that_falls_over_is_told_as_one_and_the_arm_is_not_blamed(seed: int, way: Way) -> None:
    """By a hard step, which is no column of the library, in a nest that leans; the arm has no error of its own."""
    arm, rng = arm_named("six-axis"), np.random.default_rng(seed)
    table = one_run(arm, 80, seed=seed)
    direction = rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    onto = np.outer(direction, direction)
    weight = weight_in_tool(arm, table) @ (onto if way == "along" else np.eye(3) - onto)
    steep = np.linalg.norm(weight, axis=1, keepdims=True)
    side = np.where(steep > 0.12, weight / steep, 0.0)
    verdict = diagnose(arm, measured(arm, table, 3e-4 * side, seed), QUICK)
    assert told(verdict) == [("loose_target", "tool")]
    numbers = {p.name: p.value for p in verdict.effects[0].parameters}
    assert abs(numbers[f"play_{way}"] - 0.3) < 0.03
    assert abs(direction @ [numbers[axis] for axis in "xyz"]) > np.cos(np.radians(5))


@pytest.mark.parametrize("seed", seeds(11, 12, 13))
def test_a_holder_that_bends_is_told_with_its_sag(seed: int) -> None:
    """A stem that points anywhere; what it does alike along all axes is the base's."""
    arm, rng = arm_named("six-axis"), np.random.default_rng(seed)
    table = one_run(arm, 80, seed=seed)
    stem = rng.normal(size=3)
    sag = 2e-4 * (np.eye(3) - np.outer(stem, stem) / (stem @ stem))
    verdict = diagnose(arm, measured(arm, table, weight_in_tool(arm, table) @ sag, seed), QUICK)
    assert told(verdict) == [("holder_sag", "tool")]
    numbers = {p.name: p for p in verdict.effects[0].parameters}
    against_z = 1e3 * (sag - sag[2, 2] * np.eye(3))
    for name, at in {"x": (0, 0), "y": (1, 1), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}.items():
        found = numbers[f"sag_{name}"]
        assert abs(found.value - against_z[at]) < 4 * found.stderr + 0.005
