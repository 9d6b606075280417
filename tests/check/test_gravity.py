"""Gravity stated the wrong way round is seen where joints give way under it, and never where it is stated right."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.check.report import check, what_forbids
from armscope.check.suspicion import GRAVITY
from armscope.core.types import Array
from armscope.recordings import Recordings, read_recordings
from armscope.robot import Arm, chain, load_arm
from tests.calibration.worlds import far_away, measured, poses

EXAMPLES = Path(__file__).parents[2] / "examples"


def told(example: str, turned: bool) -> list[str]:
    arm = load_arm(EXAMPLES / example / "robot.yaml")
    table = read_recordings(EXAMPLES / example / "recordings.csv", arm.n_motors)
    arm = replace(arm, gravity=-arm.gravity) if turned else arm
    found = [each for each in check(table, arm).suspicions if each.kind == GRAVITY]
    assert found == [each for each in what_forbids(table, arm) if each.kind == GRAVITY]
    assert all(each.weight == "hint" for each in found)
    return [each.text() for each in found]


@pytest.mark.parametrize("example", ["one-effect", "five-effects", "seven-axes-modified-dh"])
def test_gravity_that_points_up_is_told_where_joints_give_way(example: str) -> None:
    (text,) = told(example, turned=True)
    assert "turned around" in text
    assert "[0, 0, 9.81] for one that hangs" in text
    assert told(example, turned=False) == []


@pytest.mark.parametrize("turned", [False, True])
def test_a_stiff_arm_tells_no_direction(turned: bool) -> None:
    assert told("clean", turned) == []


@pytest.mark.parametrize("ratio", [5e-4, -5e-4])
def test_a_wrong_ratio_of_a_stiff_arm_is_no_gravity(ratio: float) -> None:
    """Seen in 4 of 9 rigid arms with one drive in error: gravity's load is a wave of the same angle."""
    arm, rng = load_arm(EXAMPLES / "one-effect" / "robot.yaml"), np.random.default_rng(3)
    angles = poses(rng, 120, arm.n_motors)
    turned = angles * np.where(np.arange(arm.n_motors) == 1, 1 + ratio, 1.0)
    rows = measured(arm, turned, far_away(rng), {"": [0.0, 0.0, 0.1]}, 3e-5, rng)
    table = replace(rows, motor_angles=angles)
    assert [each.text() for each in check(table, arm).suspicions if each.kind == GRAVITY] == []


@pytest.mark.parametrize("axis", [0, 1])
def test_an_arm_on_a_wall_described_as_upright_is_told_which_way_things_fall(axis: int) -> None:
    """Its wrist was told to have a worn bearing and a gear of 57 waves. Here the description has it the other way."""
    arm = load_arm(EXAMPLES / "five-effects" / "robot.yaml")
    table = read_recordings(EXAMPLES / "five-effects" / "recordings.csv", arm.n_motors)
    arm = replace(arm, gravity=9.81 * np.eye(3)[axis])
    (text,) = [each.text() for each in check(table, arm).suspicions if each.kind == GRAVITY]
    assert "[0, 0, -9.81], joints that give way explain" in text
    assert "--estimate-gravity" in text


@pytest.mark.parametrize("degrees", [8, 20, 40, 120])
def test_an_arm_on_a_slope_described_as_upright_is_asked_how_it_leans(degrees: float) -> None:
    """Along the base's axes alone, 20 degrees went unasked. Here the description leans, and the arm does not."""
    arm = load_arm(EXAMPLES / "five-effects" / "robot.yaml")
    table = read_recordings(EXAMPLES / "five-effects" / "recordings.csv", arm.n_motors)
    leaning = Rotation.from_rotvec(np.radians(degrees) * np.array([0.6, 0.8, 0.0])).apply(arm.gravity)
    (text,) = [each.text() for each in check(table, replace(arm, gravity=leaning)).suspicions if each.kind == GRAVITY]
    assert f"leans by {degrees} degrees" in text
    told = np.array([float(each) for each in text.partition("[")[2].partition("]")[0].split(",")])
    assert np.degrees(np.arccos(told @ arm.gravity / np.linalg.norm(told) / 9.81)) < 1


@pytest.mark.parametrize("seed", range(3))
def test_a_target_that_falls_about_on_the_tool_is_no_gravity(seed: int) -> None:
    """It moves with its weight as if the wrist gave way, and by chance against it: three of three were told so."""
    arm = load_arm(EXAMPLES / "one-effect" / "robot.yaml")
    angles = poses(np.random.default_rng(seed), 200, arm.n_motors)
    nest = np.array([0.0, 0.0, 3e-4])
    lower, upper = (_with_target(arm, angles, np.array([0.0, 0.0, 0.1]) + side * nest) for side in (1, -1))
    down = chain(arm, angles).tool_rotation[:, 2, 2] < 0
    rows = replace(lower, positions=np.where(down[:, None], lower.positions, upper.positions))
    assert [each.text() for each in check(rows, arm).suspicions if each.kind == GRAVITY] == []


def _with_target(arm: Arm, angles: Array, at: Array) -> Recordings:
    rng = np.random.default_rng(8)
    return measured(arm, angles, far_away(rng), {"": at.tolist()}, 3e-5, rng)
