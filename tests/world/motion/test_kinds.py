"""Every kind's torque against a formula written down here, and its bounds against nonsense."""

from itertools import pairwise

import numpy as np
import pytest

from armscope.core.location import Location
from armscope.world.motion.catalogue import OUTSIDE
from armscope.world.motion.kinds import LIBRARY, Concealed
from armscope.world.motion.session import GRID_HZ, make_session
from armscope.world.motion.stage import Stage, sign
from armscope.world.motion.virtual_arm import VirtualArm
from tests.world.motion.arms import NAMES, arm

KINDS = {kind.name: kind for kind in LIBRARY + OUTSIDE}


@pytest.fixture(scope="module")
def virtual():
    description, _, dynamics = arm("six-axis")
    session = make_session(description, (6.0, 4.0), "free", None, np.random.default_rng(5))
    return VirtualArm(description, dynamics, session, np.ones(6), stated=True)


@pytest.fixture(scope="module")
def plain(virtual):
    return virtual.torques([])


def change(virtual, plain, kind, location, **numbers):
    return virtual.torques([Concealed(KINDS[kind], location, numbers)]) - plain


def test_friction_resists_the_motion(virtual, plain):
    """What friction adds to the motor's torque has the sign of the speed, whatever its law."""
    speed = virtual.session.speed[:, 1]
    moving = np.abs(speed) > 0.05
    for kind, numbers in {
        "coulomb_friction": {"coulomb": 3.0}, "viscous_friction": {"viscous": 2.0},
        "load_friction": {"per_load": 0.05}, "stribeck_friction": {"stribeck": 2.0, "speed": 0.3},
    }.items():  # fmt: skip
        added = change(virtual, plain, kind, "joint 2", **numbers)
        assert (added[moving, 1] * speed[moving] >= 0).all(), kind
        np.testing.assert_allclose(added[:, [0, 2, 3, 4, 5]], 0, atol=1e-9)


def test_friction_of_slow_motion_is_never_larger_than_stated_and_falls_with_the_speed(virtual, plain):
    speed = np.abs(virtual.session.speed[:, 1])
    added = np.abs(change(virtual, plain, "stribeck_friction", "joint 2", stribeck=2.0, speed=0.3)[:, 1])
    assert added.max() <= 2.0
    moving = speed > 0.02
    np.testing.assert_allclose(added[moving], 2.0 * np.exp(-((speed[moving] / 0.3) ** 2)), rtol=1e-6, atol=1e-9)


def test_laws_by_hand(virtual, plain):
    session = virtual.session
    speed, angle, acceleration = (getattr(session, name)[:, 2] for name in ("speed", "angle", "acceleration"))
    by_hand = {
        "asymmetric_friction": ({"viscous_difference": -4.0}, -4.0 * np.abs(speed)),
        "thermal_friction": ({"per_kelvin": -0.3}, -0.3 * (session.temperature - 20) * speed),
        "rotor_inertia": ({"inertia": 0.7}, 0.7 * acceleration),
        "torque_offset": ({"offset": 5.0}, np.full(len(session), 5.0)),
        "motor_constant": ({"gain": 0.1}, 0.1 * plain[:, 2]),
        "gravity_balance": ({"stiffness": 30.0, "rest": 0.4}, 30.0 * (angle - 0.4)),
        "cable_torque": ({"torque": 2.0, "middle": 0.1}, 2.0 * (0.4 * (angle - 0.1) + (angle - 0.1) ** 3)),
        "torque_ripple": ({"amplitude": 3.0, "per_turn": 7.0, "phase": 0.5}, 3.0 * np.cos(7 * angle - 0.5)),
    }
    moving = np.abs(speed) > 0.02  # at a standstill, dry friction's onset depends on inertia, too
    for kind, (numbers, expected) in by_hand.items():
        added = change(virtual, plain, kind, "joint 3", **numbers)[:, 2]
        np.testing.assert_allclose(added[moving], expected[moving], atol=1e-6, err_msg=kind)


def test_load_friction_grows_with_the_torque_of_the_links(virtual, plain):
    added = change(virtual, plain, "load_friction", "joint 2", per_load=0.04)[:, 1]
    _, geometry, dynamics = arm("six-axis")
    from armscope.world.motion.mechanism import MovingArm

    session = virtual.session
    links = MovingArm(geometry, dynamics.without_friction())
    load = np.abs(links.torques(session.angle, session.speed, session.acceleration)[:, 1])
    moving = np.abs(session.speed[:, 1]) > 0.05
    np.testing.assert_allclose(np.abs(added[moving]), 0.04 * load[moving], rtol=1e-6)


def test_a_late_torque_is_the_torque_of_before(virtual, plain):
    late = plain + change(virtual, plain, "torque_delay", "joint 4", delay=5 / GRID_HZ)
    for run in virtual.session.runs():
        np.testing.assert_allclose(late[run][5:, 3], plain[run][:-5, 3], atol=1e-9)


def test_a_tilted_base_feels_gravity_from_aside(virtual):
    """A base turned by +x about its x axis: what hung straight down now pulls towards -y of the base."""
    dynamics = KINDS["gravity_direction"].changes(virtual.dynamics, Location.of("base"), {"x": 0.02, "y": 0.0})
    np.testing.assert_allclose(dynamics.gravity, [0, -9.81 * 0.02, -9.81], rtol=1e-6)


def test_a_heavier_link_and_one_off_its_centre_by_statics(virtual, plain):
    """Joint 1 of the six-axis arm stands upright: masses don't load it; joint 2 feels link 2's at its lever."""
    still = virtual.session.taken(slice(0, 1))
    at_rest = virtual.torques([], still)
    for kind, numbers in (("link_mass", {"mass": 5.0}), ("link_first_moment", {"mx": -2.0, "my": 0.0, "mz": 0.0})):
        added = virtual.torques([Concealed(KINDS[kind], "link 2", numbers)], still) - at_rest
        # link 2's frame lies 0.78 m along its x from joint 2, its centre -0.43 m from there
        lever = (0.78 - 0.43) * 5.0 if kind == "link_mass" else -2.0
        np.testing.assert_allclose(np.abs(added[0, 1]), abs(lever) * 9.81 * _level(still), rtol=1e-3)
        assert abs(added[0, 0]) < 1e-3 * abs(added[0, 1]) + 1e-9


def _level(still):
    """Cosine of the slope of the upper arm; the path begins at rest, so that nothing but gravity acts."""
    return abs(np.cos(still.angle[0, 1] - np.pi / 2))


def test_hysteresis_comes_back_over_a_way(virtual):
    """From reversal to reversal Dahl's force nears +-1 by exp(-way / way_0), at whatever speed."""
    kind = KINDS["unknown/hysteresis"]
    stage = Stage(virtual.session, lambda _: np.zeros((1, 6)))
    force = kind.pulls(stage, 1, {"torque": 1.0, "way": 0.05})
    assert np.abs(force).max() <= 1
    run = virtual.session.runs()[0]
    angle, speed = virtual.session.angle[run, 1], virtual.session.speed[run, 1]
    turns = np.flatnonzero(speed[1:] * speed[:-1] < 0) + 1
    for begin, end in pairwise(turns):
        way, side = np.abs(angle[begin:end] - angle[begin]), np.sign(speed[begin])
        expected = side + (force[run][begin] - side) * np.exp(-way / 0.05)
        np.testing.assert_allclose(force[run][begin:end], expected, atol=1e-2)
    assert len(turns) > 3


def test_play_follows_within_half_its_width(virtual, plain):
    added = change(virtual, plain, "unknown/torque_play", "joint 2", width=8.0)[:, 1]
    assert np.abs(added).max() <= 4.0 + 1e-9
    assert (np.abs(np.abs(added) - 4.0) < 1e-6).mean() > 0.5


def test_a_gear_off_its_centre_rubs_most_on_one_side_of_its_turn(virtual, plain):
    added = change(virtual, plain, "unknown/eccentric_friction", "joint 2", torque=3.0, phase=0.4)
    speed, angle = virtual.session.speed[:, 1], virtual.session.angle[:, 1]
    moving = np.abs(speed) > 0.02
    expected = 3.0 * np.cos(angle - 0.4) * np.sign(speed)
    np.testing.assert_allclose(added[moving, 1], expected[moving], atol=1e-6)
    np.testing.assert_allclose(added[:, [0, 2, 3, 4, 5]], 0, atol=1e-9)


def test_a_saturating_sensor_takes_from_large_torques(virtual, plain):
    read = plain + change(virtual, plain, "unknown/saturating_sensor", "joint 2", per_square=1e-7)
    loss = np.abs(plain[:, 1]) - np.abs(read[:, 1])
    assert (loss >= -1e-9).all()
    np.testing.assert_allclose(loss, np.abs(plain[:, 1]) ** 3 * 1e-7 / 3, rtol=0.2, atol=0.1)


@pytest.mark.parametrize("name", NAMES)
def test_every_kind_has_units_and_an_effect_of_the_vocabulary(name):
    description, _, _ = arm(name)
    rng = np.random.default_rng(0)
    for kind in KINDS.values():
        numbers = kind.draw(rng, description)
        assert set(numbers) == set(kind.units)
        assert set(kind.scaled) <= set(numbers)
        assert sum(each is not None for each in (kind.changes, kind.pulls, kind.records)) == 1
        for place in kind.places(description):
            assert str(Location.of(place)) == place


def test_the_sign_of_a_speed_is_whole_when_the_joint_moves(virtual):
    speed = virtual.session.speed[:, 0]
    moving = np.abs(speed) > 0.02
    np.testing.assert_allclose(sign(virtual.session, 0)[moving], np.sign(speed[moving]), atol=1e-6)
