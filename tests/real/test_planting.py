"""What is planted in recordings is exactly the stated effect at the recorded angles, in the measurement frame."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.core.averages import rms
from armscope.core.inputs import InputError
from armscope.real.planting import CannotPlantError, NotPlanted, Planted, plant, truth_of
from armscope.real.prepared_recordings import prepared_recordings
from armscope.real.simulated_effects import SimulatedEffects
from armscope.recordings.columns import AXES_MM
from armscope.robot import chain, forward_kinematics
from armscope.robot.arm import build_arm
from armscope.robot.denavit_hartenberg import as_dh
from armscope.robot.description import RobotDescription
from tests.real.recorded import BASE, arm, table

LEVEL = 1e-4


def torque(angles):
    return np.column_stack(
        [np.zeros(len(angles)), 50 * np.sin(angles[:, 1]), 20 * np.cos(angles[:, 2])] + [angles[:, 0]] * 3
    )


@pytest.fixture(scope="module")
def simulated():
    return SimulatedEffects(prepared_recordings(arm(), table(torque=torque), 1000))


def planted(simulated, name, sizes=(1.0,), seed=3):
    return list(plant(simulated, simulated.judge(), name, sizes, LEVEL, np.random.default_rng(seed)))


def turned(simulated, joint, amount):
    """Displacement in the measurement frame, m, of a motor's turn: forward kinematics of another engine."""
    angles = simulated.prepared.recordings.motor_angles
    moved = angles.copy()
    moved[:, joint] += amount
    return BASE.apply(forward_kinematics(arm(), moved) - forward_kinematics(arm(), angles))


@pytest.mark.long
def test_nothing_is_concealed_in_an_arm_without_rows():
    urdf = str(Path(__file__).parents[1] / "robot" / "torso_arm.urdf")
    description = RobotDescription(name="t", urdf=urdf, tip="flange", hold_joints={"torso_lift": 0.1})
    with pytest.raises(InputError, match=r"a URDF.*arms of D-H rows.*as_dh"):
        prepared_recordings(build_arm(description), table(), 1000)
    assert prepared_recordings(build_arm(as_dh(build_arm(description))[0]), table(), 1000).arm.n_motors == 6


def test_a_coupled_joint_turns_with_the_other_motor(simulated):
    (found,) = planted(simulated, "joint_coupling")
    joint, other = (int(found.effect.location.split()[k]) - 1 for k in (1, -1))
    amount = found.effect.values["coupling"] * simulated.prepared.recordings.motor_angles[:, other]
    assert np.abs(found.moved - turned(simulated, joint, amount)).max() < 1e-8


def test_backlash_follows_the_order_of_recording(simulated):
    (found,) = planted(simulated, "backlash")
    joint = int(found.effect.location.split()[1]) - 1
    angles = simulated.prepared.recordings.motor_angles[:, joint]
    side = np.sign(np.diff(angles, prepend=np.nan))
    side[0] = 1
    expected = turned(simulated, joint, -side * found.effect.values["gap"] / 2)
    assert np.abs(found.moved - expected).max() < 1e-8


def test_a_compliant_joint_gives_way_under_the_torque_that_was_recorded(simulated):
    (found,) = planted(simulated, "joint_compliance")
    joint = int(found.effect.location.split()[1]) - 1
    amount = found.effect.values["compliance"] * simulated.prepared.recordings.torque[:, joint]
    assert np.abs(found.moved - turned(simulated, joint, amount)).max() < 1e-8


def test_without_recorded_torques_gravity_of_the_mass_table_turns_it(simulated):
    by_mass = SimulatedEffects(prepared_recordings(arm(), table(), 1000))
    (found,) = planted(by_mass, "joint_compliance")
    joint = int(found.effect.location.split()[1]) - 1
    load = by_mass.scenes[0].torque[:, joint]
    expected = turned(by_mass, joint, found.effect.values["compliance"] * load)
    # equilibrium: the load is that of the turned arm
    assert np.abs(found.moved - expected).max() < 0.01 * np.abs(expected).max()


def test_the_tool_turns_with_the_arm_that_the_effect_moves(simulated):
    (found,) = planted(simulated, "joint_coupling")
    joint, other = (int(found.effect.location.split()[k]) - 1 for k in (1, -1))
    angles = simulated.prepared.recordings.motor_angles
    moved = angles.copy()
    moved[:, joint] += found.effect.values["coupling"] * angles[:, other]
    before, after = (Rotation.from_matrix(chain(arm(), q).tool_rotation) for q in (angles, moved))
    expected = BASE * after * before.inv() * BASE.inv()
    assert (Rotation.from_matrix(found.turned) * expected.inv()).magnitude().max() < 1e-8
    assert expected.magnitude().max() > 1e-5


def test_what_links_a_little_longer_make_as_well_is_not_concealed(simulated):
    with pytest.raises(CannotPlantError, match="links off by a millimetre"):
        planted(simulated, "instrument_scale")


def test_no_link_grows_as_no_material_does(simulated):
    hot = list(plant(simulated, simulated.judge(), "thermal_expansion", (1.0, 30.0), LEVEL, np.random.default_rng(3)))
    small, large = hot
    assert isinstance(small, Planted)
    assert abs(small.effect.values["coefficient"]) < 1e-4
    assert large == NotPlanted(30.0, "its coefficient would be above 0.0001 1/K, which no real arm's is")
    with pytest.raises(CannotPlantError, match="no real arm"):
        planted(simulated, "thermal_expansion", (30.0,))


def test_a_shift_moves_nothing_before_and_everything_rigidly_after(simulated):
    (found,) = planted(simulated, "base_shift")
    low, high = truth_of(simulated, found)["jump_between_ids"]
    number = simulated.prepared.recordings.id.astype(float)
    assert np.abs(found.moved[number <= low]).max() == 0
    after = number >= high
    points = forward_kinematics(arm(), simulated.prepared.recordings.motor_angles)[after]
    moved = points + found.moved[after] @ BASE.as_matrix()
    distances = [np.linalg.norm(each[:, None] - each, axis=2) for each in (points, moved)]
    assert np.abs(distances[0] - distances[1]).max() < 1e-6


@pytest.mark.parametrize("name", ["gear_mesh", "thermal_expansion", "base_shift"])
def test_sizes_are_what_the_frames_leave_in_multiples_of_the_level(simulated, name):
    rows = simulated.prepared.train
    for each in planted(simulated, name, (0.5, 0.8, 1.5)):
        assert each.rms == pytest.approx(each.size * LEVEL, rel=0.01)
        assert rms(each.left[rows]) == pytest.approx(each.rms)
    locations = {each.effect.location for each in planted(simulated, name, (0.5, 0.8, 1.5))}
    assert len(locations) == 1


def test_without_masses_and_torques_nothing_gives_way():
    bare = build_arm(arm().description.model_copy(update={"links": None, "tool_load": None}))
    simulated = SimulatedEffects(prepared_recordings(bare, table(), 1000))
    with pytest.raises(CannotPlantError, match="nothing to give way under"):
        planted(simulated, "joint_compliance")


@pytest.mark.long
def test_a_joint_that_stands_still_conceals_nothing_that_follows_its_angle():
    rows = table()
    rows["q4_rad"] = 0.3
    simulated = SimulatedEffects(prepared_recordings(arm(), rows, 1000))
    for seed in range(6):
        for each in planted(simulated, "gear_mesh", seed=seed):
            assert each.effect.location != "joint 4"


def test_a_thinned_stage_keeps_order_and_the_side_of_approach_of_the_whole():
    rows = table(200)
    small = prepared_recordings(arm(), rows, 50)
    assert len(small.table) == 50
    kept = small.table["id"].astype(int).to_numpy()
    assert (np.diff(kept) > 0).all()
    steps = np.sign(np.diff(rows["q2_rad"], prepend=rows["q2_rad"].iloc[0]))[kept - 1]
    steps[kept == 1] = 1
    assert (small.table["approach2"] == steps).all()
    assert np.isfinite(small.table[AXES_MM].to_numpy()).all()
