"""Moving worlds as a whole: sizes, noise, seals, rivals, and paths that don't repeat one another."""

import filecmp

import numpy as np
import pandas as pd
import pytest
import yaml

from armscope.robot.description_file import load_description
from armscope.world.judge import ALTERNATIVE_NATS
from armscope.world.motion import folder
from armscope.world.motion.catalogue import KINDS, MotionSpec, catalogue
from armscope.world.motion.folder import build, make
from armscope.world.motion.recording import independent_share, record
from armscope.world.motion.session import make_session
from armscope.world.motion.virtual_arm import ImpossibleEffect, VirtualArm, place
from armscope.world.spec import EffectSpec
from tests.world.motion.arms import FOLDER, arm

SHORT = {"id": "motion-x", "seed": 11, "fresh": False, "rate": 100, "noise": 0.01, "durations": (6.0, 6.0)}


def spec(*effects, **changes):
    asked_for = tuple(EffectSpec(kind=kind, strength=strength, location=where) for kind, strength, where in effects)
    category = "single" if effects else "clean"
    return MotionSpec(**{**SHORT, "category": category, "arm": "two-axis", "effects": asked_for, **changes})


def names(alternatives):
    return {(each.effect, each.location) for each in alternatives}


@pytest.mark.parametrize(("kind", "where"), [("torque_delay", "joint 1"), ("link_mass", "link 2"),
                                             ("unknown/saturating_sensor", "joint 1")])  # fmt: skip
def test_the_strength_is_the_rms_torque_over_the_noise(kind, where):
    world = make(spec((kind, 3.0, where), stated=True), FOLDER)
    change = world.torque - world.arm.torques([])
    train = ~world.arm.session.test
    rms = np.sqrt(np.mean(change[train] ** 2, axis=0)) / world.arm.sigma
    assert rms.max() == pytest.approx(3.0, rel=0.011)


def test_the_noise_is_as_loud_as_said_and_the_readings_are_in_steps():
    world = make(spec(), FOLDER)
    np.testing.assert_allclose(world.recorded.noise.std(axis=0), world.arm.sigma, rtol=0.15)
    step = np.diff(np.unique(world.recorded.torque[:, 0])).min()
    np.testing.assert_allclose(
        np.round(world.recorded.torque[:, 0] / step) * step, world.recorded.torque[:, 0], atol=1e-6
    )


def test_independent_readings_are_counted_as_their_mean_scatters():
    """The mean of N readings of this noise scatters as that of N x share independent ones does."""
    rng = np.random.default_rng(2)
    from armscope.world.motion.recording import _noise

    means = _noise(400, 3000, 250, rng).mean(axis=0)
    assert 1 / (400 * means.var()) == pytest.approx(independent_share(250), rel=0.12)


def test_training_and_test_paths_differ():
    description = load_description(FOLDER / "six-axis.yaml")
    session = make_session(description, (6.0, 6.0, 6.0), "free", None, np.random.default_rng(1))
    paths = [session.angle[run] for run in session.runs()]
    assert len(paths) == 3
    for one, other in ((0, 1), (0, 2), (1, 2)):
        assert np.abs(paths[one] - paths[other]).max() > 0.3


@pytest.mark.parametrize(("rule", "joint"), [("one_way", 3), ("narrow", 1)])
def test_ruled_joints_move_one_way_or_hardly_at_all_and_stay_within_their_limits(rule, joint):
    description = load_description(FOLDER / "six-axis.yaml")
    session = make_session(description, (8.0, 8.0, 6.0), rule, joint, np.random.default_rng(3))
    train = ~session.test
    limits = np.radians(description.joint_limits_deg)
    assert (session.angle >= limits[:, 0]).all()
    assert (session.angle <= limits[:, 1]).all()
    if rule == "one_way":
        assert (session.speed[train, joint] > 0).all()
        assert (session.speed[~train, joint] < 0).any()
    else:
        assert np.ptp(session.angle[train, joint]) < 0.1 * np.ptp(limits[joint])
    for run in session.runs():
        slope = np.gradient(session.angle[run], 1 / 500, axis=0)
        np.testing.assert_allclose(slope[2:-2], session.speed[run][2:-2], atol=2e-3)


@pytest.mark.long
def test_an_offset_and_dry_friction_of_a_joint_that_moves_one_way_are_rivals():
    ruled = {"arm": "six-axis", "rule": "one_way", "joint": 3, "stated": True}
    one_way = make(spec(("torque_offset", 5.0, "joint 4"), **ruled), FOLDER)
    assert ("coulomb_friction", "joint 4") in names(one_way.standings[0].alternatives)
    free = make(spec(("torque_offset", 5.0, "joint 4"), arm="six-axis", stated=True), FOLDER)
    assert ("coulomb_friction", "joint 4") not in names(free.standings[0].alternatives)


def test_a_rotor_and_the_inertia_of_the_first_link_about_the_same_axis_are_rivals():
    """Joint 1 stands upright: link 1 only turns about its axis, so nothing tells its inertia from the rotor's."""
    world = make(spec(("rotor_inertia", 5.0, "joint 1"), arm="six-axis", stated=True), FOLDER)
    assert ("link_inertia", "link 1") in names(world.standings[0].alternatives)
    assert ("rotor_inertia", "joint 2") not in names(world.standings[0].alternatives)
    assert all(each.gap_nats < ALTERNATIVE_NATS for each in world.standings[0].alternatives)


@pytest.mark.parametrize(
    ("beside", "said"), [(("cable_torque", "joint 2"), True), (("cable_torque", "joint 1"), False), (None, False)]
)
def test_an_offset_is_said_by_the_name_of_a_cable_at_the_same_joint_and_by_none_elsewhere(beside, said):
    """A cable is any curve of its joint's angle; by the cable's own exact curve the offset would still stand out."""
    concealed = [("torque_offset", 5.0, "joint 2"), *([(beside[0], 5.0, beside[1])] if beside else [])]
    offset, *others = make(spec(*concealed, stated=True), FOLDER).standings
    assert offset.is_said_by_others == said
    assert not any(each.is_said_by_others for each in others)


@pytest.mark.long
def test_what_friction_takes_up_has_no_size():
    description, _, dynamics = arm("two-axis")
    session = make_session(description, (6.0, 6.0), "free", None, np.random.default_rng(5))
    virtual = VirtualArm(description, dynamics, session, np.ones(2), stated=False)
    with pytest.raises(ImpossibleEffect, match="viscous_friction"):
        place(virtual, KINDS["viscous_friction"], 3.0, None, np.random.default_rng(0), virtual.torques([]))


@pytest.mark.long
def test_another_arm_conceals_what_this_one_cannot():
    """The stage of two axes has no wrist that could be coupled."""
    world = make(spec(("coupled_friction", 3.0, None)), FOLDER)
    assert world.spec.arm == "six-axis"


def test_an_arm_without_the_ruled_joint_makes_no_such_world():
    with pytest.raises(ImpossibleEffect, match="joint 4"):
        folder._make(spec(rule="one_way", joint=3), FOLDER)


def test_a_world_is_two_folders_and_the_same_every_time(tmp_path):
    made = spec(("asymmetric_friction", 5.0, "joint 2"), current=True)
    one, other = (build(made, tmp_path / name, FOLDER) for name in ("a", "b"))
    files = ["visible/robot.yaml", "visible/motions.csv", "visible/test_motions.csv", "sealed/truth.yaml",
             "sealed/test.csv"]  # fmt: skip
    assert filecmp.cmpfiles(one, other, files, shallow=False)[0] == files
    shown = pd.read_csv(one / "visible" / "motions.csv")
    assert {"run", "time_s", "q1_rad", "q2_rad", "current1_a", "current2_a"} <= set(shown)
    assert set(shown["run"]) == {"run1"}
    asked = pd.read_csv(one / "visible" / "test_motions.csv")
    assert not [name for name in asked if name.startswith(("tau", "current"))]
    robot = (one / "visible" / "robot.yaml").read_text()
    assert "gain_nm_per_a" in robot
    assert "coulomb_nm" not in robot
    truth = yaml.safe_load((one / "sealed" / "truth.yaml").read_text())
    assert [(e["effect"], e["location"]) for e in truth["effects"]] == [("asymmetric_friction", "joint 2")]
    assert truth["left_on_test_nm"][0] >= truth["noise_nm"][0] * 0.8
    there = pd.read_csv(one / "sealed" / "test.csv")
    speed = np.gradient(asked["q1_rad"], asked["time_s"])
    assert not there["moves1"].iloc[[0, -1]].any()  # a path begins and ends at rest
    assert there["moves1"][np.abs(speed) > 0.02].all()
    assert truth["noise_nm"][0] * 0.8 <= truth["left_moving_nm"][0] <= truth["left_on_test_nm"][0]


def test_what_is_recorded_is_the_torque_of_that_moment():
    description, _, dynamics = arm("two-axis")
    session = make_session(description, (6.0, 6.0), "free", None, np.random.default_rng(5))
    torque = VirtualArm(description, dynamics, session, np.ones(2), stated=True).torques([])
    read = record(session, torque, np.full(2, 1e-6), 100, np.random.default_rng(0))
    smooth = np.abs(session.speed[read.rows]).min(axis=1) > 0.3  # away from reversals, where friction jumps
    off = read.torque[smooth] - torque[read.rows[smooth]]
    assert np.sqrt(np.mean(off**2)) < 0.005 * np.sqrt(np.mean(torque**2))


@pytest.mark.parametrize("size", ["small", "full"])
def test_half_of_the_seeds_stay_and_all_kinds_are_tried(size):
    one, other = catalogue(1, size), catalogue(2, size)
    assert all((a.seed == b.seed) == (not a.fresh) for a, b in zip(one, other, strict=True))
    assert 0.3 < np.mean([each.fresh for each in one]) < 0.7
    assert {each.category for each in one} == {"clean", "single", "multiple", "outside", "confounded", "rough"}
    if size == "full":
        assert {asked.kind for each in one for asked in each.effects} >= set(KINDS)


def test_what_no_arm_can_hold_is_tried_with_less_noise_before_it_is_given_up(monkeypatch):
    tried = []

    def hardly(spec, robots, draw):
        tried.append((draw, spec.arm, spec.noise))
        if draw < 2:
            raise ImpossibleEffect("too loud")
        return spec

    monkeypatch.setattr(folder, "_make", hardly)
    asked_for = spec(("torque_delay", 10.0, None))
    found = make(asked_for, FOLDER)
    assert found.noise == pytest.approx(asked_for.noise * folder.QUIETER**2)
    assert [draw for draw, _, _ in tried] == [0, 0, 0, 1, 1, 1, 2]
    assert tried[0] == (0, asked_for.arm, asked_for.noise)
    monkeypatch.setattr(folder, "DRAWS", 2)
    with pytest.raises(ImpossibleEffect, match="too loud"):
        make(asked_for, FOLDER)
