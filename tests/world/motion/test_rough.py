"""What is rough in an arm in motion: each thing does what it says, and the truth says what is there."""

import numpy as np
import pytest
import yaml

from armscope.world.motion.constants import ROUGH_MOTION
from armscope.world.motion.folder import build, make
from armscope.world.motion.recording import record
from armscope.world.motion.rough import BLEMISHES, also_allowed, blemishes, changes_alone, draw_broken, paces_of
from armscope.world.motion.virtual_arm import VirtualArm
from tests.world.motion.arms import FOLDER
from tests.world.motion.test_world import spec

ALL = tuple(BLEMISHES)


def rough(broken, *effects, **changes):
    return make(spec(*effects, category="rough", rough=broken, **changes), FOLDER)


@pytest.fixture(scope="module")
def world():
    return rough(ALL, ("torque_offset", 3.0, "joint 2"), arm="two-axis")


def test_each_assumption_is_broken_about_as_often_as_said():
    rng = np.random.default_rng(3)
    drawn = [draw_broken(rng) for _ in range(2000)]
    for name, (share, _) in BLEMISHES.items():
        assert np.mean([name in each for each in drawn]) == pytest.approx(share, abs=0.04)


def test_what_is_concealed_stands_out_of_noise_and_all_that_is_rough_together(world):
    arm = world.arm
    everywhere = [each.concealed for each, _ in world.rough]
    small = arm.beyond_background(arm.torques(everywhere) - arm.torques([]))
    beside = np.sqrt(arm.sigma**2 + np.mean(small**2, axis=0))
    story = arm.beyond_background(world.concealed[0].change)
    assert (np.sqrt(np.mean(story**2, axis=0)) / beside).max() == pytest.approx(3.0, rel=0.02)
    rms = np.sqrt(np.mean(story**2, axis=0))
    assert world.concealed[0].strength == pytest.approx((rms / arm.sigma).max())


def test_every_joint_and_link_has_its_share_with_a_name_that_is_true(world):
    names = {(each.concealed.kind.effect, each.concealed.location) for each, _ in world.rough}
    for j in (1, 2):
        assert {("link_mass", f"link {j}"), ("stribeck_friction", f"joint {j}"), ("unknown", f"joint {j}")} <= names
    assert also_allowed(("masses", "lines"), 2) == [("payload_error", "payload")]
    assert also_allowed(("rest",), 2) == [("coulomb_friction", "joint 1"), ("coulomb_friction", "joint 2")]
    assert also_allowed(("late",), 2) == [("torque_delay", "all joints")]


@pytest.mark.parametrize("name", [name for name in ALL if name not in ("noise", "pace")])
def test_each_changes_the_torque_alone_as_much_as_in_the_whole(name):
    arm = make(spec(category="rough"), FOLDER).arm
    drawn = blemishes(arm, (name,), np.random.default_rng(1))
    plain = arm.torques([])
    alone = np.sum(changes_alone(arm, drawn, plain), axis=0)
    together = arm.torques(drawn) - plain
    assert np.abs(alone).max() > 0
    np.testing.assert_allclose(alone, together, atol=0.12 * np.abs(together).max())


def test_a_bent_curve_of_friction_meets_the_straight_one_at_the_usual_speed():
    arm = make(spec(category="rough"), FOLDER).arm
    bent = blemishes(arm, ("bend",), np.random.default_rng(1))[0]
    change = changes_alone(arm, [bent], arm.torques([]))[0][:, 0]
    speed = arm.session.speed[:, 0] / bent.numbers["usual"]
    assert np.all(change * speed * (1 - np.abs(speed)) >= -1e-12)
    near = np.abs(np.abs(speed) - 1) < 0.01
    assert near.any()
    assert np.abs(change[near]).max() < 0.02 * np.abs(change).max() + 0.01 * bent.numbers["viscous"]


def test_noise_has_tails_and_grows_with_the_speed_but_is_as_strong():
    arm: VirtualArm = make(spec(category="rough"), FOLDER).arm
    plain = arm.torques([])
    noise = record(arm.session, plain, arm.sigma, 250, np.random.default_rng(4), rough=True).noise / arm.sigma
    gaussian = record(arm.session, plain, arm.sigma, 250, np.random.default_rng(4)).noise / arm.sigma
    np.testing.assert_allclose(noise.std(axis=0), 1.0, rtol=0.1)
    assert np.mean(noise**4) > 2 * np.mean(gaussian**4)
    speed = np.abs(arm.session.speed[::2])
    fast = speed > np.median(speed, axis=0)
    assert noise[fast].std() > 1.3 * noise[~fast].std()


def test_slow_runs_are_slow_and_the_test_is_not():
    paces = [paces_of(("pace",), 3, np.random.default_rng(seed)) for seed in range(40)]
    for first, second, test in paces:
        assert max(first, second) == test == 1.0
        assert ROUGH_MOTION.pace[0] <= min(first, second) < 1.0
    assert paces_of((), 3, np.random.default_rng(0)) == (1.0, 1.0, 1.0)
    session, as_fast = (rough(broken, durations=(12.0, 12.0, 6.0)).arm.session for broken in (("pace",), ()))
    usual = [np.array([np.abs(s.speed[run]).mean() for run in s.runs()]) for s in (session, as_fast)]
    slower = usual[0] / usual[1]
    assert sorted(slower.round(9) == 1) == [False, True, True]
    assert slower[2] == pytest.approx(1)
    assert slower.min() < 0.95
    for run in session.runs():
        slope = np.gradient(session.angle[run], session.time[run], axis=0)
        np.testing.assert_allclose(slope[5:-5], session.speed[run][5:-5], atol=2e-3 * np.abs(slope).max())


@pytest.mark.long
def test_truth_tells_what_is_rough_apart_from_what_is_asked_for(tmp_path):
    home = build(spec(("torque_offset", 3.0, "joint 2"), category="rough", rough=ALL, current=True), tmp_path, FOLDER)
    truth = yaml.safe_load((home / "sealed" / "truth.yaml").read_text(encoding="utf-8"))
    assert [each["effect"] for each in truth["effects"]] == ["torque_offset"]
    assert {each["effect"] for each in truth["rough"]} >= {"link_mass", "motor_constant", "viscous_curve"}
    assert truth["scoring"]["rough"] == list(ALL)
    assert not truth["scoring"]["outside_library"]
    drives = yaml.safe_load((home / "visible" / "robot.yaml").read_text(encoding="utf-8"))["drives"]
    assert all(drive["gain_uncertainty"] > 0 for drive in drives)
