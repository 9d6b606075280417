"""Exciting motions: columns against the engine that is not theirs, hidden parameters by hand, limits, and rivals."""

import json

import numpy as np
import pandas as pd
import pinocchio as pin
import pytest
from scipy.interpolate import make_interp_spline
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.inputs import InputError
from armscope.design.fourier import random_path
from armscope.poses.exciting.columns import (
    Motion,
    all_columns,
    cause_columns,
    link_columns,
    names,
    stated_friction,
)
from armscope.poses.exciting.criterion import motion_score, separation, shown_at_all
from armscope.poses.exciting.limits import limits_of
from armscope.poses.exciting.output import pairs_of, trajectory_table
from armscope.poses.exciting.search import MotionRequest, excite
from armscope.poses.obstacles import Surroundings, refusals
from armscope.robot import load_arm
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import inertial_parameters
from armscope.world.layout import Geometry
from armscope.world.motion.mechanism import MovingArm, stated_dynamics
from tests.world.motion.arms import FOLDER, NAMES

NOWHERE = Surroundings(radius=0.01)


@pytest.fixture(scope="module")
def six():
    return load_arm(FOLDER / "six-axis.yaml")


@pytest.fixture(scope="module")
def found(six):
    return excite(six, MotionRequest(period=10.0, rounds=60, seed=4), NOWHERE)


def motion(arm, seed=0, count=50):
    limits = limits_of(arm).path
    rng = np.random.default_rng(seed)
    low, high = limits.angle.T
    shape = (count, arm.n_motors)
    return Motion(
        rng.uniform(low, high, shape), *(rng.uniform(-m, m, shape) for m in (limits.speed, limits.acceleration)), 0.01
    )


@pytest.mark.parametrize("name", NAMES)
def test_columns_times_parameters_are_inverse_dynamics_and_friction(name):
    arm = load_arm(FOLDER / f"{name}.yaml")
    states = motion(arm)
    data = arm.model.createData()
    rigid = [
        pin.rnea(arm.model, data, *row) for row in zip(states.angle, states.speed, states.acceleration, strict=True)
    ]
    drives = arm.description.drives
    coulomb, viscous, rotor = (
        np.array([getattr(drive, key) for drive in drives])
        for key in ("coulomb_nm", "viscous_nm_s_rad", "rotor_inertia_kg_m2")
    )
    expected = rigid + coulomb * np.tanh(states.speed / 0.01) + viscous * states.speed + rotor * states.acceleration
    numbers = np.concatenate([inertial_parameters(arm.model), stated_friction(arm)])
    np.testing.assert_allclose(all_columns(arm, states) @ numbers, expected, atol=1e-8)


def test_what_a_planar_arm_can_show_by_hand():
    """Two axes in a vertical plane show 13 numbers.

    Offset, Coulomb and viscous friction of each (6); rotor 2 and link 2's inertia (2); one sum of rotor 1, link 1's
    inertia and link 2's mass (1); two first moments of each link, link 1's with link 2's mass in one of them (4).
    """
    arm = load_arm(FOLDER / "two-axis.yaml")
    shown = shown_at_all(arm, limits_of(arm).path, np.random.default_rng(0))
    assert len(shown.base) == 13
    assert {"mass of link 1", "m z of link 1", "I xx of link 1", "I yy of link 2"} <= set(shown.nothing)
    assert not [name for name in shown.nothing if "joint" in name]


def test_a_column_more_or_less_of_what_does_not_show_changes_no_torque(six):
    """The parameters that are said to show nothing indeed move no motor, in pinocchio's own words."""
    shown = shown_at_all(six, limits_of(six).path, np.random.default_rng(0))
    columns = all_columns(six, motion(six, seed=9))
    for name in shown.nothing:
        assert np.abs(columns[:, :, names(six).index(name)]).max() < 1e-9


def test_the_motion_keeps_all_limits_and_is_better_than_random(six, found):
    limits = limits_of(six)
    table = trajectory_table(found, 200)
    for motor in range(6):
        angle, speed, acceleration, torque = (
            table[each.format(motor + 1)] for each in ("q{}_rad", "dq{}_rad_s", "ddq{}_rad_s2", "tau{}_nm")
        )
        assert limits.path.angle[motor, 0] <= angle.min() <= angle.max() <= limits.path.angle[motor, 1]
        assert speed.abs().max() <= limits.path.speed[motor]
        assert acceleration.abs().max() <= limits.path.acceleration[motor]
        assert torque.abs().max() <= limits.torque[motor]
        np.testing.assert_allclose(np.gradient(angle, 1 / 200)[2:-2], speed[2:-2], atol=5e-3)
        assert speed.abs().iloc[[0, -1]].max() < 1e-9
    assert found.after.value > found.before.value + 10
    assert found.after.condition < found.before.condition


@pytest.mark.long
@pytest.mark.parametrize("harmonics", [pytest.param(5, marks=pytest.mark.long), 20])
def test_torque_stays_within_its_limit_between_the_samples_too(six, harmonics):
    """By MuJoCo, every 2 ms: motors that can give hardly more than a motion asks for; waves of half a second."""
    plain = excite(six, MotionRequest(period=10.0, harmonics=harmonics, rounds=0, seed=1), NOWHERE)
    drives = zip(six.description.drives, plain.torque, strict=True)
    weak = [drive.model_copy(update={"torque_nm": float(most)}) for drive, most in drives]
    description = six.description.model_copy(update={"drives": tuple(weak)})
    found = excite(build_arm(description), MotionRequest(period=10.0, harmonics=harmonics, rounds=40, seed=1), NOWHERE)
    time = np.arange(0, 10, 0.002)
    torque = MovingArm(Geometry(description), stated_dynamics(description)).torques(*found.path.at(time))
    most = np.abs(torque).max(axis=0)
    assert (most <= found.limits.torque).all()
    np.testing.assert_allclose(found.torque, most, rtol=0.03)
    assert found.refused > 0  # limits that nothing comes near would show nothing


def test_the_same_seed_gives_the_same_motion(six, found):
    again = excite(six, MotionRequest(period=10.0, rounds=60, seed=4), NOWHERE)
    np.testing.assert_array_equal(again.path.sine, found.path.sine)


def test_a_floor_is_kept_clear_of(six):
    around = Surroundings(radius=0.05, floor=0.1)
    clear = excite(six, MotionRequest(period=10.0, rounds=20, seed=1), around)
    angle, _, _ = clear.path.at(np.linspace(0, 10, 300))
    assert (refusals(six, angle, around) == "").mean() > 0.99
    assert clear.refused > 0


@pytest.mark.long
def test_a_motion_of_little_torque_is_asked_for_where_motors_are_weak(six):
    drives = [drive.model_copy(update={"torque_nm": drive.torque_nm * 0.7}) for drive in six.description.drives]
    weak = build_arm(six.description.model_copy(update={"drives": tuple(drives)}))
    torque = excite(weak, MotionRequest(period=10.0, rounds=10, seed=2), NOWHERE).torque
    assert (torque <= [drive.torque_nm for drive in drives]).all()
    hopeless = [drive.model_copy(update={"torque_nm": 1.0}) for drive in drives]
    none = build_arm(six.description.model_copy(update={"drives": tuple(hopeless)}))
    with pytest.raises(InputError, match=r"motions refused.*the torque of joint \d\. Less load, a longer --period-s"):
        excite(none, MotionRequest(rounds=1), NOWHERE)


def folding():
    """Seven joints that fold the arm onto itself in most random motions: the Panda's lengths and ranges."""
    rows = [(0, 0, 333), (0, -90, 0), (0, 90, 316), (82.5, 90, 0), (-82.5, -90, 384), (0, 90, 0), (88, 90, 107)]
    ends = [(-160, 160), (-95, 95), (-160, 160), (-170, -5), (-160, 160), (0, 210), (-160, 160)]
    joints = [dict(zip(("a_mm", "alpha_deg", "d_mm"), row, strict=True)) for row in rows]
    link = {"mass_kg": 2, "com_mm": [10, 20, -30], "inertia_kg_m2": [0.02, 0.02, 0.02, 0, 0, 0]}
    stated = {
        "name": "folding",
        "dh": {"convention": "modified", "joints": joints},
        "links": [link] * 7,
        "joint_limits_deg": ends,
        "drives": [{"speed_deg_s": 110, "acceleration_deg_s2": 350}] * 7,
    }
    return build_arm(RobotDescription.model_validate(stated))


@pytest.mark.long
def test_where_every_large_motion_hits_something_a_small_one_grows_about_a_clear_pose():
    arm, around = folding(), Surroundings()
    small = excite(arm, MotionRequest(rounds=0), around)
    assert small.refused >= 24 * 4  # all random motions, at every share of the limits
    grown = excite(arm, MotionRequest(rounds=15), around)
    assert grown.after.value > small.after.value
    angle, speed, _ = grown.path.at(np.linspace(0, 20, 300))
    assert (refusals(arm, angle, around) == "").mean() > 0.99
    limits = limits_of(arm).path
    assert (angle >= limits.angle[:, 0] - 1e-9).all()
    assert (angle <= limits.angle[:, 1] + 1e-9).all()
    assert (np.abs(speed) <= limits.speed).all()
    with pytest.raises(InputError, match=r"motions refused.*hits the floor\. Is --floor-mm"):
        excite(arm, MotionRequest(rounds=0), Surroundings(floor=3.0))


def test_friction_and_offset_part_only_when_the_joint_turns_both_ways(six):
    shown = shown_at_all(six, limits_of(six).path, np.random.default_rng(0))
    both = motion(six, seed=3, count=200)
    one_way = Motion(both.angle, np.abs(both.speed) + 0.2, both.acceleration, both.step)
    pair = (("coulomb_friction", "joint 3"), ("torque_offset", "joint 3"))
    assert separation(six, shown, one_way, pair) < 1e-3
    assert separation(six, shown, both, pair) > 0.3


def test_pairs_are_separated_better_and_the_inseparable_are_told(six):
    """Joint 1 stands upright, so its rotor and link 1's inertia are one number, whatever the motion."""
    pairs = (
        (("rotor_inertia", "joint 1"), ("link_inertia", "link 1")),
        (("payload_error", "payload"), ("motor_constant", "joint 2")),
    )
    told = excite(six, MotionRequest(period=10.0, rounds=30, seed=5, pairs=pairs), NOWHERE)
    assert told.inseparable == pairs[:1]
    assert told.pairs == pairs[1:]
    assert told.after.separations[0] > told.before.separations[0]


def test_scores_of_a_motion_that_shows_nothing_are_the_worst(six):
    shown = shown_at_all(six, limits_of(six).path, np.random.default_rng(0))
    still = np.zeros((50, 6))
    at_rest = Motion(still, still, still, 0.1)
    assert motion_score(six, shown, at_rest).value < motion_score(six, shown, motion(six)).value - 100
    assert motion_score(six, shown, at_rest).condition > 1e6


def test_assumed_limits_are_told_and_arms_without_masses_refused(six):
    bare = build_arm(six.description.model_copy(update={"drives": None, "joint_limits_deg": None}))
    assert len(limits_of(bare).assumed) == 4
    with pytest.raises(InputError, match="no masses"):
        limits_of(build_arm(six.description.model_copy(update={"links": None})))


def test_verdicts_without_alternatives_have_nothing_to_separate(tmp_path):
    verdict = tmp_path / "verdict.json"
    verdict.write_text(json.dumps({"effects": [{"effect": "a", "location": "joint 1", "alternatives": []}]}))
    with pytest.raises(InputError, match="no alternatives"):
        pairs_of(verdict)


def test_the_command_writes_table_json_and_figure(tmp_path):
    verdict, output = tmp_path / "verdict.json", tmp_path / "move.csv"
    other = {"effect": "coulomb_friction", "location": "joint 1"}
    effect = {"effect": "torque_offset", "location": "joint 1", "alternatives": [other]}
    verdict.write_text(json.dumps({"effects": [effect]}))
    words = ["excite", FOLDER / "two-axis.yaml", "-o", output, "--separate", verdict, "--rounds", 10, "--period-s", 5]
    ended = CliRunner().invoke(app, list(map(str, words)))
    assert ended.exit_code == 0, ended.output
    assert "torque_offset at joint 1 and coulomb_friction at joint 1" in ended.output
    assert len(pd.read_csv(output)) == 501
    told = json.loads(output.with_suffix(".json").read_text())
    assert told["separates"] == ["torque_offset joint 1 | coulomb_friction joint 1"]
    assert told["this_motion"]["share_not_imitated"][0] >= told["random_motion"]["share_not_imitated"][0]
    assert output.with_suffix(".png").is_file()


def test_a_drive_that_gives_way_has_the_torque_of_a_link_that_lags(six):
    """By hand: links on a path that repeats, the motor ahead by compliance x torque; torques by pinocchio."""
    joint, compliance, period = 1, 1e-7, 10.0
    time = np.arange(400) * period / 400
    path = random_path(limits_of(six).path, 4, period, np.random.default_rng(2))
    links = path.at(time)
    data = six.model.createData()

    def torques(*moved):
        return np.array([pin.rnea(six.model, data, *row).copy() for row in zip(*moved, strict=True)])

    torque = torques(*links)
    three = np.tile(torque[:, joint], 3)
    lag = make_interp_spline(np.arange(len(three)) * period / 400, three, k=5)
    motor = [np.array(each) for each in links]
    for order, values in enumerate(motor):
        values[:, joint] += compliance * lag(time + period, order)
    expected = (torque - torques(*motor)) / compliance
    states = Motion(*motor, step=period / 400)
    found = cause_columns(six, states, link_columns(six, states), "joint_compliance", f"joint {joint + 1}")
    assert found.shape == (400, 6, 1)
    np.testing.assert_allclose(found[:, :, 0], expected, atol=2e-3 * np.abs(expected).max())


def test_a_motion_is_planned_that_tells_a_belt_from_a_mass(six):
    pair = (("joint_compliance", "joint 2"), ("link_mass", "link 3"))
    planned = excite(six, MotionRequest(period=10.0, rounds=40, seed=3, pairs=(pair,)), NOWHERE)
    assert planned.pairs == (pair,)
    assert planned.lawless == ()
    assert planned.after.separations[0] > planned.before.separations[0]
    behind_no_motor = (("joint_compliance", "joint 9"), pair[1])
    assert excite(six, MotionRequest(rounds=0, pairs=(behind_no_motor,)), NOWHERE).lawless == (behind_no_motor,)
