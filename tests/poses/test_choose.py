from pathlib import Path

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.poses.candidates import candidates, ranges
from armscope.poses.choose import choose, grid_choice, short_way
from armscope.poses.compare import compare_sets, predicted_errors, share_won
from armscope.poses.obstacles import Surroundings, refusals
from armscope.poses.target_parameters import target_parameters
from armscope.robot import load_arm
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription

ROBOTS = Path(__file__).parents[2] / "config" / "robots"
AROUND = Surroundings(floor=0.0, tracker=np.array([4.0, 0.0, 1.5]))
NOISE = 5e-5
"""Of a reading, m."""


@pytest.fixture(scope="module")
def arm():
    return load_arm(ROBOTS / "six-axis.yaml")


@pytest.fixture(scope="module")
def choice(arm):
    return choose(arm, 40, AROUND, n_candidates=400, starts=1)


def test_candidates_are_possible_within_limits_and_the_same_for_a_seed(arm):
    pool = candidates(arm, 200, AROUND, 3)
    angles = pool.table.motor_angles
    low, high = ranges(arm)
    assert np.all((angles >= low) & (angles <= high))
    assert set(refusals(arm, angles, AROUND)) == {""}
    assert sum(pool.refused.values()) > 0
    assert np.array_equal(angles, candidates(arm, 200, AROUND, 3).table.motor_angles)


@pytest.mark.parametrize("effects", [("geometry",), ("joint_compliance", "backlash"), ("geometry", "link_bending")])
def test_the_jacobian_is_the_slope_of_the_exact_model(arm, effects):
    pool = candidates(arm, 30, Surroundings(), 0, payload_kg=10)
    seen = target_parameters(arm, pool.table, effects)
    jacobian = seen.jacobian(pool.table)
    for k in range(len(seen.terms)):
        values = np.eye(len(seen.terms))[k] * 1e-3
        slope = (seen.tool(pool.table, values) - seen.tool(pool.table, -values)) / 2e-3
        assert jacobian[:, :, k] == pytest.approx(slope, abs=1e-9)


def test_of_a_urdf_the_zeros_of_motors_are_shown_before_turns_of_links_that_imitate_them():
    urdf = str(Path(__file__).parents[1] / "robot" / "torso_arm.urdf")
    arm = build_arm(RobotDescription(name="t", urdf=urdf, tip="flange", hold_joints={"torso_lift": 0.1}))
    seen = target_parameters(arm, candidates(arm, 200, Surroundings(), 0).table)
    offsets = {name for name in seen.hidden if name.endswith("offset")}
    assert offsets <= {"joint 1 offset", "joint 6 offset"}  # those of base and tool


def test_every_kept_parameter_is_told_apart_and_moves_the_tool_by_a_millimetre(choice):
    seen = choice.targets
    stacked = choice.jacobian.reshape(-1, len(seen.terms))
    assert np.linalg.cond(stacked) < 1e4
    assert np.sqrt(3 * np.mean(stacked**2, axis=0)) == pytest.approx(1e-3)
    assert "joint 1 offset" in seen.hidden  # the base's turn about z is the same
    assert not set(seen.hidden) & set(seen.names)


@pytest.fixture(scope="module")
def compared(choice):
    """Fifteen arms measured at each set of poses."""
    return compare_sets(choice, NOISE, 15)


@pytest.mark.long
def test_chosen_poses_beat_random_ones_and_a_grid(compared):
    table = compared
    for other in ("random", "grid"):
        assert share_won(table, "parameter_rms_mm", other) > 0.6
    medians = table.groupby("set")[["O1", "parameter_rms_mm"]].median()
    assert medians["O1"].idxmax() == "chosen"
    assert medians["parameter_rms_mm"].idxmin() == "chosen"


def test_without_noise_every_set_finds_the_parameters(choice):
    assert compare_sets(choice, 0.0, 2)["parameter_worst_mm"].max() < 1e-5


def test_linear_theory_predicts_the_simulated_scatter(choice, compared):
    theory = predicted_errors(choice, NOISE, {"chosen": choice.table})
    scatter = compared.query("set == 'chosen'")["parameter_rms_mm"]
    p = choice.targets
    sizes = np.array([size / term.si for size, (_, term) in zip(p.sizes, p.terms, strict=True)])[~p.is_frame]
    expected = np.sqrt(np.mean((theory["sd_chosen"] / sizes) ** 2))
    assert np.sqrt(np.mean(scatter**2)) == pytest.approx(expected, rel=0.15)


def test_the_grid_has_the_asked_number_of_different_poses(choice):
    table = grid_choice(choice, np.random.default_rng(0))
    assert len(np.unique(table.motor_angles, axis=0)) == 40


def test_the_order_shortens_the_way():
    angles = np.random.default_rng(0).uniform(-1, 1, (60, 3))
    rows = np.arange(60)

    def length(order):
        return np.abs(np.diff(angles[order], axis=0)).max(axis=1).sum()

    order = short_way(angles, rows)
    assert sorted(order.tolist()) == rows.tolist()
    assert length(order) < 0.5 * length(rows)


def test_what_poses_cannot_show_is_refused_with_the_reason(arm):
    table = candidates(arm, 20, Surroundings(), 0).table
    with pytest.raises(InputError, match="temperature_c"):
        target_parameters(arm, table, ("thermal_expansion",))
    with pytest.raises(InputError, match="Did you mean 'backlash'"):
        target_parameters(arm, table, ("backlsh",))
    with pytest.raises(InputError, match=r"0 possible poses of 2000 drawn.*most: hits the floor"):
        candidates(arm, 50, Surroundings(floor=10.0), 0)
    with pytest.raises(InputError, match="9 at least"):
        choose(arm, 5, n_candidates=50)


def test_an_arm_whose_effects_no_pose_shows_is_refused():
    rows = {"convention": "standard", "joints": [{"a_mm": 300, "alpha_deg": -90, "d_mm": 800, "theta_offset_deg": 0}]}
    one = build_arm(RobotDescription.model_validate({"name": "one joint", "dh": rows}))
    with pytest.raises(InputError, match="nothing of them beside base and tool"):
        choose(one, 12, n_candidates=40)


def test_of_poses_that_nothing_allows_the_option_to_blame_is_named(arm):
    """Most of them hit themselves, too: that is no reason to name what nobody stated."""
    with pytest.raises(InputError, match=r"--floor-mm: found '9000'; 0 possible .*hits the floor; without this option"):
        candidates(arm, 50, Surroundings(floor=9.0), 0)
    with pytest.raises(InputError, match=r"^--tracker: found '0,0,50'.*out of the tracker's sight"):
        candidates(arm, 50, Surroundings(tracker=np.array([0.0, 0.0, 0.05])), 0)
