from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from armscope.poses.obstacles import Surroundings, refusals, segment_distance
from armscope.robot import chain, load_arm
from armscope.robot.centre_line import centre_lines

ROBOTS = Path(__file__).parents[2] / "config" / "robots"


@pytest.fixture(scope="module")
def arm():
    return load_arm(ROBOTS / "six-axis.yaml")


@settings(max_examples=60)
@given(st.integers(0, 10_000), st.sampled_from([0.0, 1.0, 1e-7]))
def test_distances_of_segments_are_those_of_fine_samples(seed, flat):
    """Also for segments in one plane, and nearly parallel ones."""
    rng = np.random.default_rng(seed)
    a, b, c, d = rng.normal(size=(4, 3)) * np.array([1, 1, flat])
    along = np.linspace(0, 1, 201)[:, None]
    one, other = a + along * (b - a), c + along * (d - c)
    sampled = np.linalg.norm(one[:, None] - other[None], axis=2).min()
    exact = segment_distance(a[None], b[None], c[None], d[None])[0]
    assert exact <= sampled + 1e-9
    assert sampled - exact < 0.03


def test_a_parallel_pair_and_a_point():
    start, end = np.array([[0.0, 0, 0]]), np.array([[1.0, 0, 0]])
    assert segment_distance(start, end, start + np.array([0.2, 3, 0]), end + np.array([0.4, 3, 0]))[0] == pytest.approx(
        3
    )
    ahead = start + np.array([2.0, 0, 0])
    assert segment_distance(start, end, ahead, ahead)[0] == pytest.approx(1)


@pytest.mark.parametrize("name", ["six-axis", "seven-axis", "parallelogram-120kg", "sk120"])
def test_the_centre_line_runs_from_base_to_tool_without_gaps(name):
    arm = load_arm(ROBOTS / f"{name}.yaml")
    frames = chain(arm, np.random.default_rng(0).uniform(-1, 1, (3, arm.n_motors)))
    points = np.concatenate([line for _, line in centre_lines(arm, frames)], axis=1)
    assert points[:, 0] == pytest.approx(np.zeros((3, 3)))
    assert points[:, -1] == pytest.approx(frames.tool)
    lines = [line for _, line in centre_lines(arm, frames)]
    for before, after in pairwise(lines):
        assert before[:, -1] == pytest.approx(after[:, 0])


def test_an_upright_arm_is_possible_and_a_folded_one_hits_itself(arm):
    upright, folded = np.zeros(6), np.radians([0, 0, 80, 0, 100, 0])
    stretched = np.radians([0, 60, -60, 0, 0, 0])
    reasons = refusals(arm, np.array([upright, folded, stretched]), Surroundings(radius=0.15))
    assert reasons[0] == ""
    assert reasons[1] == "hits itself"
    assert reasons[2] == ""


def test_the_floor_stops_what_moves_below_it_and_not_the_base(arm):
    low = np.radians([[0, 90, 30, 0, 0, 0], [0, 0, 0, 0, 0, 0]])
    assert chain(arm, low).tool[0, 2] < 0.1
    assert refusals(arm, low, Surroundings(floor=0.0)).tolist() == ["hits the floor", ""]
    assert refusals(arm, low, Surroundings(floor=-5.0)).tolist() == ["", ""]


def test_the_tracker_does_not_see_through_the_arm(arm):
    """The tool is in front of the arm: seen from the front, hidden from behind, both in the arm's plane."""
    pose = np.zeros((1, 6))
    tool = chain(arm, pose).tool[0]
    front, behind = np.array([6.0, 0, tool[2]]), np.array([-6.0, 0, tool[2]])
    assert refusals(arm, pose, Surroundings(tracker=front))[0] == ""
    assert refusals(arm, pose, Surroundings(tracker=behind))[0] == "out of the tracker's sight"
    turned = np.array([[np.pi, 0, 0, 0, 0, 0]])
    assert refusals(arm, turned, Surroundings(tracker=behind))[0] == ""
