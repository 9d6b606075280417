"""Where base and tools stand: a start from anywhere, exact columns, and what poses do not tell stays."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from armscope.fitting.constants import STEPS
from armscope.fitting.placement import FlangePoses, Frames, _Placement, frame_columns, place_frames, rigid_motion


def drawn(rng: np.random.Generator, n_rows: int, noise: float = 0.0) -> tuple[FlangePoses, Frames]:
    """Poses of two bases and two tools, and where these stand."""
    true = Frames(Rotation.random(2, rng).as_matrix(), rng.normal(size=(2, 3)), 0.2 * rng.normal(size=(2, 3)))
    base, tool = np.arange(n_rows) % 2, np.arange(n_rows) // 2 % 2
    origin, turned = rng.normal(size=(n_rows, 3)), Rotation.random(n_rows, rng).as_matrix()
    points = origin + np.einsum("nij,nj->ni", turned, true.tools[tool])
    measured = np.einsum("nij,nj->ni", true.rotations[base], points) + true.translations[base]
    return FlangePoses(origin, turned, measured + noise * rng.normal(size=measured.shape), base, tool), true


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10_000), n_pairs=st.integers(2, 15))
def test_a_rigid_motion_of_points_about_a_centre_is_found_exactly(seed: int, n_pairs: int) -> None:
    rng = np.random.default_rng(seed)
    rotation, translation = Rotation.random(1, rng).as_matrix()[0], rng.normal(size=3)
    half = rng.normal(size=(n_pairs, 3))
    points = np.concatenate([half, 0.4 - half])  # other clouds' medians do not quite turn with them: a start
    turned, shift = rigid_motion(points, points @ rotation.T + translation)
    np.testing.assert_allclose(turned, rotation, atol=1e-7)
    np.testing.assert_allclose(shift, translation, atol=1e-7)


def test_the_rotation_is_that_of_kabsch_about_the_medians() -> None:
    rng = np.random.default_rng(0)
    points, measured = rng.normal(size=(2, 20, 3))
    p, m = points - np.median(points, axis=0), measured - np.median(measured, axis=0)
    left, _, right = np.linalg.svd(m.T @ p)
    kabsch = left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right
    np.testing.assert_allclose(rigid_motion(points, measured)[0], kabsch, atol=1e-12)


@pytest.mark.parametrize("count", [1, 2, 5])
def test_points_that_tell_no_turn_still_start_somewhere(count: int) -> None:
    points = np.outer(np.arange(count), [1.0, 0.0, 0.0])
    rotation, translation = rigid_motion(points, points + 1.0)
    np.testing.assert_allclose(points @ rotation.T + translation, points + 1.0, atol=1e-12)


def test_columns_are_what_a_small_step_does() -> None:
    rng = np.random.default_rng(1)
    poses, true = drawn(rng, 8)
    points = poses.points(true.tools)
    columns = frame_columns(points, poses.turned, poses.base, poses.tool, (2, 2))
    at = Frames(np.tile(np.eye(3), (2, 1, 1)), np.zeros((2, 3)), true.tools)
    for number in range(columns.shape[2]):
        step = np.zeros(columns.shape[2])
        step[number] = 1e-6
        moved = at.moved(step)
        there = np.einsum("nij,nj->ni", moved.rotations[poses.base], poses.points(moved.tools))
        there = there + moved.translations[poses.base]
        np.testing.assert_allclose((there - points) / 1e-6, columns[:, :, number], atol=1e-5)


def test_sums_by_base_and_tool_are_those_of_all_columns() -> None:
    rng = np.random.default_rng(4)
    poses, true = drawn(rng, 9 * STEPS.chunk_rows + 7, noise=0.01)  # each pair of base and tool takes several pieces
    weights = rng.uniform(0.1, 1, len(poses.base))
    problem = _Placement(poses, lambda _: weights)
    left = problem.residual(true)
    columns = frame_columns(poses.points(true.tools), poses.turned, poses.base, poses.tool, (2, 2))
    X, w = columns.reshape(left.size, -1), np.repeat(weights, 3)
    found = problem.quadratic(true, left)
    np.testing.assert_allclose(found.matrix, X.T @ (w[:, None] * X), rtol=1e-10, atol=1e-8)
    np.testing.assert_allclose(found.right, X.T @ (w * left.reshape(-1)), rtol=1e-10, atol=1e-8)


@pytest.mark.parametrize("far", [False, True])
def test_bases_and_tools_that_are_shared_are_found_from_either_start(far: bool) -> None:
    poses, true = drawn(np.random.default_rng(2), 60)
    tools = np.zeros((2, 3))
    start = poses.start_of_far_tools(tools, 2) if far else poses.start(tools, 2)
    assert start is not None
    found = place_frames(poses, start, 40, lambda left: np.ones(len(left)), start.tools)
    assert found.reason == "the step became negligible"
    np.testing.assert_allclose(found.state.tools, true.tools, atol=1e-8)
    np.testing.assert_allclose(found.state.rotations, true.rotations, atol=1e-8)


def test_a_wrist_that_never_turns_leaves_the_tool_where_it_was() -> None:
    poses, _ = drawn(np.random.default_rng(3), 40)
    held = FlangePoses(poses.origin, np.tile(np.eye(3), (40, 1, 1)), poses.origin + 1.0, poses.base * 0, poses.tool * 0)
    tools = np.array([[0.1, 0.2, 0.3]])
    found = place_frames(held, held.start(tools, 1), 40, lambda left: np.ones(len(left)), tools)
    np.testing.assert_allclose(found.state.tools, tools, atol=1e-6)
    assert np.abs(found.residual).max() < 1e-8
