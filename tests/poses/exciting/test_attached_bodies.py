"""Bodies of a URDF that are not on the arm, and other causes of masses: planned for as the diagnosis has them."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.types import Array
from armscope.poses.exciting.columns import Motion, cause_columns, link_columns
from armscope.poses.exciting.criterion import separation, shown_at_all, told_apart
from armscope.poses.exciting.limits import limits_of
from armscope.poses.exciting.output import pairs_of
from armscope.robot import Arm, load_arm
from armscope.robot.dynamics import attached_bodies, inertial_parameters, torque_regressor

HAND = ("attached_body", "hand")


def inertial(mass: float, z: float) -> str:
    return (
        f'<inertial><mass value="{mass}"/><origin xyz="0.05 0 {z}"/>'
        '<inertia ixx="0.02" iyy="0.03" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial>'
    )


def joint(number: int, parent: str, axis: str) -> str:
    return (
        f'<joint name="j{number}" type="revolute"><parent link="{parent}"/><child link="l{number}"/>'
        f'<origin xyz="0 0 0.4"/><axis xyz="{axis}"/><limit lower="-2" upper="2" effort="200" velocity="2"/></joint>'
    )


ARM = (
    '<robot name="with a hand"><link name="base"/>'
    + "".join(f'<link name="l{number}">{inertial(4 - number, 0.2)}</link>' for number in (1, 2, 3))
    + joint(1, "base", "0 0 1") + joint(2, "l1", "0 1 0") + joint(3, "l2", "1 0 0")
    + f'<link name="hand">{inertial(0.8, 0.1)}</link>'
    '<joint name="mount" type="fixed"><parent link="l3"/><child link="hand"/><origin xyz="0 0 0.3"/></joint></robot>'
)  # fmt: skip


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    (tmp_path / "arm.urdf").write_text(ARM)
    (tmp_path / "robot.yaml").write_text("name: with a hand\nurdf: arm.urdf\ntip: hand\n")
    return tmp_path / "robot.yaml"


def states(arm: Arm, count: int = 60) -> Motion:
    rng, limits = np.random.default_rng(1), limits_of(arm).path
    low, high = limits.angle.T
    shape = (count, arm.n_motors)
    return Motion(
        rng.uniform(low, high, shape), *(rng.uniform(-m, m, shape) for m in (limits.speed, limits.acceleration)), 0.01
    )


def of(arm: Arm, effect: str, location: str) -> Array:
    motion = states(arm)
    found = cause_columns(arm, motion, link_columns(arm, motion), effect, location)
    assert found is not None
    return found


def test_a_body_is_what_the_arm_is_heavier_by_with_it(robot: Path) -> None:
    (robot.parent / "bare.urdf").write_text(ARM.replace(inertial(0.8, 0.1), ""))
    bare = robot.with_name("bare.yaml")
    bare.write_text("name: without\nurdf: bare.urdf\ntip: hand\n")
    arm, without = load_arm(robot), load_arm(bare)
    assert [name for name, _ in attached_bodies(arm.model)] == ["hand"]
    assert attached_bodies(without.model) == ()
    motion = states(arm)
    rows = list(zip(motion.angle, motion.speed, motion.acceleration, strict=True))
    with_it, less = (
        np.array([pin.rnea(each.model, each.model.createData(), *row) for row in rows]) for each in (arm, without)
    )
    np.testing.assert_allclose(of(arm, *HAND)[:, :, 0], with_it - less, atol=1e-9)


def test_a_heavier_link_keeps_its_centre_and_a_leaning_base_turns_gravity(robot: Path) -> None:
    arm = load_arm(robot)
    stated = inertial_parameters(arm.model)
    stated[:20] = 0
    third = link_columns(arm, states(arm)) @ stated / stated[20]
    np.testing.assert_allclose(of(arm, "link_mass", "link 3")[:, :, 0], third, atol=1e-9)
    motion, small = states(arm), 1e-6
    model = arm.model.copy()
    model.gravity.linear = pin.exp3(np.array([small, 0, 0])).T @ arm.model.gravity.linear
    path = (motion.angle, motion.speed, motion.acceleration)
    moved, kept = (
        torque_regressor(each, arm.actuation, path) @ inertial_parameters(each) for each in (model, arm.model)
    )
    changed = np.abs((moved - kept) / small)
    np.testing.assert_allclose(np.abs(of(arm, "gravity_direction", "base")[:, :, 0]), changed, atol=1e-4)
    every = of(arm, "motor_constant", "every joint")[:, :, 0]
    np.testing.assert_allclose(every, link_columns(arm, motion) @ inertial_parameters(arm.model), atol=1e-9)


def test_pairs_are_sorted_by_what_a_motion_can_do_for_them(robot: Path) -> None:
    arm, rng = load_arm(robot), np.random.default_rng(0)
    limits = limits_of(arm).path
    shown = shown_at_all(arm, limits, rng)
    hand = (HAND, ("link_mass", "link 3"))
    alike = (("rotor_inertia", "joint 1"), ("link_inertia", "link 1"))
    curve = (("torque_offset", "joint 2"), ("unknown", "joint 2"))
    nobody = (("attached_body", "gripper"), ("link_mass", "link 3"))
    found = told_apart(arm, shown, limits, (hand, alike, curve, nobody), rng)
    assert found.apart == (hand,)
    assert found.alike == (alike,)
    assert found.lawless == (curve, nobody)


def test_a_special_case_is_told_by_what_the_wider_cause_has_beyond_it(robot: Path) -> None:
    arm = load_arm(robot)
    shown = shown_at_all(arm, limits_of(arm).path, np.random.default_rng(0))
    pair = (("torque_offset", "joint 2"), ("gravity_balance", "joint 2"))
    wide = states(arm, 300)
    narrow = Motion(0.01 * wide.angle, wide.speed, wide.acceleration, wide.step)
    assert separation(arm, shown, wide, pair) > 0.3 > 0.02 > separation(arm, shown, narrow, pair)
    assert separation(arm, shown, wide, pair) == pytest.approx(separation(arm, shown, wide, pair[::-1]))


def test_what_the_verdict_told_apart_is_planned_for_only_if_it_told_all(tmp_path: Path) -> None:
    others = [{"effect": name, "location": "joint 1", "discriminability_nats": nats} for name, nats in
              (("torque_offset", 1.0), ("coulomb_friction", 15.0))]  # fmt: skip
    effect = {"effect": "gravity_balance", "location": "joint 1"}
    verdict = tmp_path / "verdict.json"
    verdict.write_text(json.dumps({"effects": [effect | {"alternatives": others}]}))
    assert [other for _, other in pairs_of(verdict)] == [("torque_offset", "joint 1")]
    verdict.write_text(json.dumps({"effects": [effect | {"alternatives": others[1:]}]}))
    assert [other for _, other in pairs_of(verdict)] == [("coulomb_friction", "joint 1")]


def test_the_command_says_what_it_did_not_plan_for(robot: Path) -> None:
    verdict, output = robot.with_name("verdict.json"), robot.with_name("move.csv")
    other = {"effect": "unknown", "location": "joint 2"}
    effect = {"effect": "torque_offset", "location": "joint 2", "alternatives": [other]}
    verdict.write_text(json.dumps({"effects": [effect]}))
    words = f"excite {shlex.quote(str(robot))} --separate {verdict} -o {output} --rounds 5 --period-s 5"
    ended = CliRunner().invoke(app, shlex.split(words))
    assert ended.exit_code == 0, ended.output
    assert "not planned for: torque_offset at joint 2 and unknown at joint 2" in ended.output
    assert "as without --separate" in ended.output
    told = json.loads(output.with_suffix(".json").read_text())
    assert told["not_planned_for"] == ["torque_offset joint 2 | unknown joint 2"]
