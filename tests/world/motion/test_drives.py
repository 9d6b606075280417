"""A drive that gives way: the link stands where its own torque lets it, and every joint feels it."""

import numpy as np
import pytest

from armscope.world.motion.kinds import LIBRARY, Concealed
from armscope.world.motion.mechanism import MovingArm
from armscope.world.motion.rivals import rivals
from armscope.world.motion.session import make_session
from armscope.world.motion.virtual_arm import VirtualArm
from tests.world.motion.arms import arm

KIND = next(kind for kind in LIBRARY if kind.effect == "joint_compliance")
COMPLIANCE = 4e-5
"""rad/(N m): link 2 of the six-axis arm then swings some two times a second."""


@pytest.fixture(scope="module")
def virtual():
    description, _, dynamics = arm("six-axis")
    session = make_session(description, (14.0,), "free", None, np.random.default_rng(5))
    return VirtualArm(description, dynamics, session, np.ones(6), stated=True)


def concealed(compliance):
    return Concealed(KIND, "joint 2", {"compliance": compliance})


def test_the_link_is_where_its_torque_lets_it_be(virtual):
    """The motor's angle less compliance x torque at the link, by that torque itself: no round of it is left to do."""
    _, geometry, dynamics = arm("six-axis")
    links, session = MovingArm(geometry, dynamics.without_friction()), virtual.session
    change = virtual.torques([concealed(COMPLIANCE)]) - virtual.torques([])
    load = links.torques(session.angle, session.speed, session.acceleration) + change
    shift = np.zeros_like(load)
    shift[:, 1] = -COMPLIANCE * load[:, 1]
    behind = session.moved(shift)
    there = links.torques(behind.angle, behind.speed, behind.acceleration)
    inside = slice(50, -50)
    size = np.linalg.norm(change[inside], axis=0)
    assert (np.linalg.norm((there - load)[inside], axis=0) < 0.02 * size).all()
    assert (size > 0.02 * size[1])[[0, 2]].all()  # not at its own joint alone


def test_a_session_moved_by_a_path_has_that_paths_speed_and_acceleration(virtual):
    time = virtual.session.time
    shift = np.sin(3 * time)[:, None] * np.eye(6)[1]
    moved, session = virtual.session.moved(shift), virtual.session
    np.testing.assert_allclose(moved.angle - session.angle, shift)
    np.testing.assert_allclose((moved.speed - session.speed)[:, 1], 3 * np.cos(3 * time), atol=1e-6)
    np.testing.assert_allclose((moved.acceleration - session.acceleration)[:, 1], -9 * np.sin(3 * time), atol=1e-4)


def test_its_pattern_as_a_rival_is_what_a_little_of_it_changes(virtual):
    rows = np.arange(100, 6900, 400)
    plain = virtual.torques([])
    of_drives = {each.location: each.columns for each in rivals(virtual, plain, rows) if each.effect == KIND.effect}
    assert set(of_drives) == {f"joint {j + 1}" for j in range(6)}
    change = (virtual.torques([concealed(1e-8)]) - plain)[rows] / 1e-8
    expected = change.reshape(-1)
    np.testing.assert_allclose(of_drives["joint 2"][:, 0], expected, atol=2e-3 * np.abs(expected).max())
