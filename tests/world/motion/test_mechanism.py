"""MuJoCo's moving arms against pinocchio's inverse dynamics, a pendulum worked out by hand, and conserved energy."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from armscope.robot import load_arm
from armscope.robot.description import RobotDescription
from armscope.world.layout import Geometry
from armscope.world.motion.mechanism import Coupling, MovingArm, Spring, stated_dynamics
from tests.world.motion.arms import FOLDER, NAMES, arm, motion


@pytest.mark.parametrize("name", NAMES)
def test_the_links_alone_need_what_pinocchio_says(name):
    description, geometry, dynamics = arm(name)
    ours = MovingArm(geometry, dynamics.without_friction())
    other = load_arm(FOLDER / f"{name}.yaml").model
    data = other.createData()
    angle, speed, acceleration = motion(description)
    expected = [pin.rnea(other, data, *row) for row in zip(angle, speed, acceleration, strict=True)]
    np.testing.assert_allclose(ours.torques(angle, speed, acceleration), expected, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_rotors_and_viscous_friction_add_what_the_formula_says(name):
    description, geometry, dynamics = arm(name)
    angle, speed, acceleration = motion(description)
    smooth = replace(dynamics, coulomb=np.zeros(dynamics.n_joints))
    links = MovingArm(geometry, dynamics.without_friction()).torques(angle, speed, acceleration)
    added = MovingArm(geometry, smooth).torques(angle, speed, acceleration) - links
    np.testing.assert_allclose(added, dynamics.rotor * acceleration + dynamics.viscous * speed, atol=1e-8)


@pytest.mark.parametrize("name", NAMES)
def test_dry_friction_is_against_the_motion_and_all_there_when_the_joint_moves(name):
    description, geometry, dynamics = arm(name)
    angle, speed, acceleration = motion(description, count=1000)
    smooth = replace(dynamics, coulomb=np.zeros(dynamics.n_joints))
    dry = MovingArm(geometry, dynamics).torques(angle, speed, acceleration) - MovingArm(geometry, smooth).torques(
        angle, speed, acceleration
    )
    moving = np.abs(speed) > 0.02
    np.testing.assert_allclose(dry[moving], (dynamics.coulomb * np.sign(speed))[moving], rtol=1e-6)
    assert (np.abs(dry) <= dynamics.coulomb * (1 + 1e-9)).all()


def pendulum(**changes):
    link = {"mass_kg": 3.0, "com_mm": [-100, 0, 0], "inertia_kg_m2": [0.01, 0.05, 0.05, 0, 0, 0]}
    drive = {"rotor_inertia_kg_m2": 0.2, "coulomb_nm": 2.0, "viscous_nm_s_rad": 1.5}
    arm = {"name": "pendulum", "links": [link], "drives": [drive], "gravity_m_s2": [9.81, 0, 0]}
    description = RobotDescription.model_validate(arm | {"dh": {"joints": [{"a_mm": 500, "alpha_deg": 0, "d_mm": 0}]}})
    return MovingArm(Geometry(description), replace(stated_dynamics(description), **changes))


def test_a_body_at_the_end_of_a_pendulum_by_hand():
    """0.5 m from the axis, and beyond the tool point along it: its inertia about its own centre adds to mass x r^2."""
    angle, speed, acceleration = np.array([[0.6], [-0.3]]), np.array([[-0.8], [0.4]]), np.array([[2.5], [-1.0]])
    held = {"load": 2.0, "load_centre": np.array([0.0, 0.0, 0.1]), "load_inertia": 0.3}
    with_body, without = (pendulum(**changes).torques(angle, speed, acceleration) for changes in (held, {}))
    turned, pulled = (2.0 * 0.5**2 + 0.3) * acceleration, 2.0 * 9.81 * 0.5 * np.sin(angle)
    np.testing.assert_allclose(with_body - without, turned + pulled, rtol=1e-6)


def test_a_pendulum_by_hand():
    """0.4 m from the axis to the centre of mass; hangs along x."""
    angle, speed, acceleration = np.array([[0.6]]), np.array([[-0.8]]), np.array([[2.5]])
    expected = (0.05 + 3 * 0.4**2 + 0.2) * 2.5 + 3 * 9.81 * 0.4 * np.sin(0.6) - 2.0 - 1.5 * 0.8
    assert pendulum().torques(angle, speed, acceleration)[0, 0] == pytest.approx(expected)


def test_a_spring_pulls_back_to_its_rest_and_a_load_hangs_at_the_tool():
    still = np.zeros((1, 1))
    free = pendulum(coulomb=np.zeros(1)).torques(np.array([[0.6]]), still, still)[0, 0]
    sprung = pendulum(coulomb=np.zeros(1), springs=(Spring(0, 40.0, 0.1),)).torques(np.array([[0.6]]), still, still)
    assert sprung[0, 0] - free == pytest.approx(40 * 0.5)
    loaded = pendulum(coulomb=np.zeros(1), load=2.0).torques(np.array([[0.6]]), still, still)[0, 0]
    assert loaded - free == pytest.approx(2 * 9.81 * 0.5 * np.sin(0.6), rel=1e-6)


def test_work_of_the_motors_is_the_energy_gained():
    """Without friction the power tau dq, summed over a motion, is the change of kinetic and potential energy."""
    description, geometry, dynamics = arm("six-axis")
    free = MovingArm(geometry, replace(dynamics, coulomb=np.zeros(6), viscous=np.zeros(6)))
    angle, speed, acceleration = motion(description, count=4000, period=10.0)
    power = np.sum(free.torques(angle, speed, acceleration) * speed, axis=1)
    step = 10.0 / 4000
    work = np.concatenate([[0], np.cumsum((power[1:] + power[:-1]) / 2 * step)])
    gained = free.energy(angle, speed)
    np.testing.assert_allclose(work, gained - gained[0], atol=2e-3 * np.ptp(gained))


def test_friction_only_takes_energy():
    description, geometry, dynamics = arm("seven-axis")
    angle, speed, acceleration = motion(description, count=400)
    links = MovingArm(geometry, replace(dynamics, coulomb=np.zeros(7), viscous=np.zeros(7)))
    lost = (MovingArm(geometry, dynamics).torques(angle, speed, acceleration)
            - links.torques(angle, speed, acceleration)) * speed  # fmt: skip
    assert (lost[np.abs(speed) > 0.02] > 0).all()


def test_a_coupling_rubs_both_joints_alike():
    description, geometry, dynamics = arm("six-axis")
    angle, speed, acceleration = motion(description, count=300)
    plain = MovingArm(geometry, dynamics).torques(angle, speed, acceleration)
    coupled = replace(dynamics, couplings=(Coupling(5, 4, viscous=3.0, inertia=0.2),))
    added = MovingArm(geometry, coupled).torques(angle, speed, acceleration) - plain
    together = 3.0 * (speed[:, 4] + speed[:, 5]) + 0.2 * (acceleration[:, 4] + acceleration[:, 5])
    np.testing.assert_allclose(added[:, 4], together, atol=1e-7)
    np.testing.assert_allclose(added[:, 5], together, atol=1e-7)
    np.testing.assert_allclose(added[:, :4], 0, atol=1e-7)
