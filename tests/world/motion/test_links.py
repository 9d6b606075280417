"""Links with encoders of their own, against formulas written down here."""

from itertools import pairwise

import numpy as np
import pytest

from armscope.core.location import Location
from armscope.world.motion.catalogue import MotionSpec, catalogue
from armscope.world.motion.folder import make
from armscope.world.motion.kinds import Concealed
from armscope.world.motion.links import LINKED, NOISE_RAD, read_links
from armscope.world.motion.mechanism import MovingArm
from armscope.world.motion.session import GRID_HZ, make_session
from armscope.world.motion.virtual_arm import VirtualArm
from armscope.world.spec import EffectSpec
from tests.world.motion.arms import FOLDER, NAMES, arm

KINDS = {kind.name: kind for kind in LINKED}


@pytest.fixture(scope="module")
def virtual():
    description, _, dynamics = arm("six-axis")
    session = make_session(description, (6.0, 4.0), "free", None, np.random.default_rng(5))
    return VirtualArm(description, dynamics, session, np.ones(6), stated=True)


def beside(virtual, kind, **numbers):
    found = virtual.beside_motors([Concealed(KINDS[kind], "joint 2", numbers)])
    np.testing.assert_array_equal(found[:, [0, 2, 3, 4, 5]], 0)
    return found[:, 1]


def links_torque(virtual):
    _, geometry, dynamics = arm("six-axis")
    session = virtual.session
    links = MovingArm(geometry, dynamics.without_friction())
    return links.torques(session.angle, session.speed, session.acceleration)[:, 1]


def test_a_drive_winds_up_by_the_torque_of_its_link_and_the_motors_feel_it(virtual):
    made = beside(virtual, "joint_elasticity", compliance=1e-8)
    np.testing.assert_allclose(made, -1e-8 * links_torque(virtual), rtol=1e-3, atol=1e-9)
    wound = [Concealed(KINDS["joint_elasticity"], "joint 2", {"compliance": 1e-6})]
    assert np.abs(virtual.torques(wound) - virtual.torques([])).max() > 0.1


def test_a_link_with_play_lies_where_its_torque_pushes_it(virtual):
    made, torque = beside(virtual, "joint_play", half=1e-3), links_torque(virtual)
    for run in virtual.session.runs():
        turns = [0, *(np.flatnonzero(np.diff(np.sign(torque[run]))) + 1), run.stop - run.start]
        for begin, end in pairwise(turns):
            if end - begin > 20:  # 40 ms, eight times what it takes to cross
                at_end = made[run][begin + 20 : end]
                np.testing.assert_allclose(at_end, -1e-3 * np.sign(torque[run][begin]), rtol=1e-3)


def test_laws_of_encoders_and_gears_by_hand(virtual):
    angle = virtual.session.angle[:, 1]
    np.testing.assert_allclose(beside(virtual, "gear_ratio", share=1e-3), 1e-3 * angle)
    wave = beside(virtual, "encoder_wave", sine=2e-4, cosine=-1e-4, per_turn=2.0)
    np.testing.assert_allclose(wave, 2e-4 * np.sin(2 * angle) - 1e-4 * np.cos(2 * angle))
    lag = beside(virtual, "encoder_lag", lag=3 / GRID_HZ)
    for run in virtual.session.runs():
        np.testing.assert_allclose(lag[run][3:], angle[run][:-3] - angle[run][3:], atol=1e-12)


def test_link_encoders_read_the_link_with_their_noise_and_zero(virtual):
    rows = np.arange(0, len(virtual.session), 5)
    made = virtual.beside_motors([Concealed(KINDS["gear_ratio"], "joint 1", {"share": 0.01})])
    read, zeros = read_links(virtual.session, rows, made, np.random.default_rng(1))
    left = read - virtual.session.angle[rows] - made[rows] - zeros
    np.testing.assert_allclose(left.std(axis=0), NOISE_RAD, rtol=0.15)
    assert np.abs(zeros).max() > 1e-4


@pytest.mark.parametrize("kind", KINDS)
def test_a_world_of_links_is_as_strong_as_asked_for_and_can_be_told(kind):
    effect = EffectSpec(kind=kind, strength=5.0)
    spec = MotionSpec(id="motion-x", category="single", arm="two-axis", seed=12, fresh=False, rate=100, noise=0.01,
                      durations=(6.0, 6.0), effects=(effect,), linked=True)  # fmt: skip
    world = make(spec, FOLDER)
    joint, train = world.concealed[0].concealed.joint, ~world.arm.session.test[world.recorded.rows]
    angle = world.arm.session.angle[world.recorded.rows]
    apart = (world.recorded.links - angle - world.zeros)[train]
    assert apart[:, joint].std() == pytest.approx(np.hypot(5.0, 1.0) * NOISE_RAD, rel=0.05)
    assert [each.alternatives for each in world.standings] == [[]]


@pytest.mark.parametrize("name", NAMES)
def test_every_kind_has_units_and_a_place(name):
    description, _, _ = arm(name)
    for kind in LINKED:
        assert set(kind.draw(np.random.default_rng(0), description)) == set(kind.units)
        assert kind.lies is not None
        assert all(str(Location.of(place)) == place for place in kind.places(description))


def test_every_kind_is_in_the_full_proof_and_two_are_in_the_small_one():
    full, small = ([spec for spec in catalogue(1, size) if spec.linked] for size in ("full", "small"))
    assert {effect.kind for spec in full for effect in spec.effects} == set(KINDS)
    assert {spec.category for spec in full} == {spec.category for spec in small} == {"clean", "single"}
    assert {effect.kind for spec in small for effect in spec.effects} == {"joint_elasticity", "joint_play"}
