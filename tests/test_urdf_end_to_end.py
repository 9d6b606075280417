"""An arm that nobody here described, from its URDF to commands: recorded by pinocchio alone, no armscope in it."""

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from armscope.cli import app
from armscope.diagnosis import Settings, diagnose
from armscope.recordings import read_recordings
from armscope.robot import load_arm

TORSO_ARM = Path(__file__).parent / "robot" / "torso_arm.urdf"
JOINTS = ("pan", "lift", "elbow", "roll", "bend", "turn")
TOOL = np.array([0.02, 0.0, 0.08])
AXES_MM = ["x_mm", "y_mm", "z_mm"]
NOISE_MM = 0.02
FAST = Settings(resamples=0, cross_validation=False)
ROLL = '<origin xyz="0.35 0 0.03" rpy="0.1 0 0"/>'
ROLL_AS_BUILT = '<origin xyz="0.35 0.0005 0.0303" rpy="0.1 0 0"/>'


class Real:
    """The arm as it is: its URDF, and what its joints do beside what they are told (joint: size)."""

    def __init__(self, text, offset=None, backlash=None, compliance=None):
        self.full = pin.buildModelFromXML(text)
        self.data = self.full.createData()
        self.offset, self.backlash, self.compliance = offset or {}, backlash or {}, compliance or {}

    def stored(self, angles):
        stored = pin.neutral(self.full)
        stored[self.full.joints[self.full.getJointId("torso_lift")].idx_q] = 0.2
        for name, angle in zip(JOINTS, angles, strict=True):
            joint = self.full.joints[self.full.getJointId(name)]
            both = [math.cos(angle), math.sin(angle)]
            stored[joint.idx_q : joint.idx_q + joint.nq] = angle if joint.nq == 1 else both
        return stored

    def tool(self, commanded, approach):
        driven = np.array(commanded, dtype=float)
        for name, size in self.offset.items():
            driven[JOINTS.index(name)] += size
        for name, gap in self.backlash.items():
            driven[JOINTS.index(name)] -= approach[JOINTS.index(name)] * gap / 2
        angles, still = driven.copy(), np.zeros(self.full.nv)
        for _ in range(6 if self.compliance else 0):
            holding = pin.rnea(self.full, self.data, self.stored(angles), still, still)
            for name, size in self.compliance.items():
                torque = holding[self.full.joints[self.full.getJointId(name)].idx_v]
                angles[JOINTS.index(name)] = driven[JOINTS.index(name)] - size * torque
        pin.framesForwardKinematics(self.full, self.data, self.stored(angles))
        return self.data.oMf[self.full.getFrameId("flange")].act(TOOL)

    def record(self, path, count=120, seed=0):
        """What a tracker far away writes down."""
        rng = np.random.default_rng(seed)
        angles = rng.uniform([-3, -1.8, -2.1, -3, -1.7, -2.9], [3, 1.8, 0.3, 3, 1.7, 2.9], (count, 6))
        approach = rng.choice([-1, 1], (count, 6))
        points = np.array([self.tool(*row) for row in zip(angles, approach, strict=True)])
        points = Rotation.from_rotvec([0.3, -0.5, 2.1]).apply(points) + np.array([3.1, -2.0, 0.7])
        table = pd.DataFrame(angles, columns=[f"q{j}_rad" for j in range(1, 7)])
        table[[f"approach{j}" for j in range(1, 7)]] = approach
        table[AXES_MM] = 1e3 * points + rng.normal(0, NOISE_MM, points.shape)
        table.to_csv(path, index=False)
        return table


@pytest.fixture
def robot(tmp_path):
    (tmp_path / "arm.urdf").write_text(TORSO_ARM.read_text())
    (tmp_path / "robot.yaml").write_text(
        "name: torso arm\nurdf: arm.urdf\ntip: flange\nhold_joints: {torso_lift: 0.2}\ntool_mm: [20, 0, 80]\n"
    )
    return tmp_path / "robot.yaml"


def run(*arguments):
    done = CliRunner().invoke(app, [str(argument) for argument in arguments])
    assert done.exit_code == 0, done.output
    return done.output


def diagnosed(robot, **effects):
    arm = load_arm(robot)
    Real(TORSO_ARM.read_text(), **effects).record(robot.with_name("recordings.csv"))
    return diagnose(arm, read_recordings(robot.with_name("recordings.csv"), arm.n_motors), FAST)


def test_a_clean_arm_has_nothing_missing(robot):
    verdict = diagnosed(robot)
    assert (verdict.mismatch, verdict.effects) == (False, ())


def test_three_concealed_effects_are_found_at_their_places_with_their_sizes(robot):
    verdict = diagnosed(robot, offset={"roll": 1.5e-3}, compliance={"lift": 4e-5}, backlash={"elbow": 1e-3})
    truth = {
        ("joint_offset", "joint 4"): 1.5e-3,
        ("joint_compliance", "joint 2"): 4e-5,
        ("backlash", "joint 3"): 1e-3,
    }
    found = {(effect.effect, effect.location): effect.parameters[0] for effect in verdict.effects}
    assert set(found) == set(truth)
    for place, number in found.items():
        assert number.value == pytest.approx(truth[place], abs=4 * number.stderr)


def rms_of_rigid_motion(points, measured):
    """Per axis, mm, after the least-squares rotation and translation."""
    _, distance = Rotation.align_vectors(measured - measured.mean(axis=0), points - points.mean(axis=0))
    return distance / np.sqrt(points.size)


def test_a_calibrated_urdf_stands_where_the_real_arm_does(robot):
    """And `armscope predict` says so, from the exported files alone."""
    folder = robot.parent
    built = Real(TORSO_ARM.read_text().replace(ROLL, ROLL_AS_BUILT))
    built.record(folder / "recordings.csv")
    said = run("calibrate", folder / "recordings.csv", "-r", robot, "-o", folder / "calibrated")
    assert "q1 pan, q2 lift, q3 elbow, q4 roll, q5 bend, q6 turn" in said
    fresh = built.record(folder / "fresh.csv", 300, seed=1)
    left = {}
    for name in (robot, folder / "calibrated" / "robot.yaml"):
        run("predict", name, folder / "fresh.csv", "-o", folder / "predicted.csv")
        predicted = pd.read_csv(folder / "predicted.csv")[AXES_MM].to_numpy()
        left[name.parent.name] = rms_of_rigid_motion(predicted, fresh[AXES_MM].to_numpy())
    assert left["calibrated"] == pytest.approx(NOISE_MM * np.sqrt(1 + 27 / 360), rel=0.07)  # 27 of 360 numbers spent
    assert left[folder.name] > 5 * NOISE_MM


@pytest.mark.long
def test_commands_of_a_diagnosed_urdf_bring_the_real_arm_to_its_points(robot, monkeypatch):
    folder, real = robot.parent, Real(TORSO_ARM.read_text(), offset={"roll": 3e-3}, compliance={"lift": 4e-5})
    wanted = real.record(folder / "recordings.csv").head(20)
    monkeypatch.chdir(folder)  # paths relative to it: the model must be found from elsewhere, too
    run("diagnose", "recordings.csv", "-r", "robot.yaml", "-o", "out", "--no-report", "--no-cross-validation")
    wanted.drop(columns=AXES_MM).to_csv(folder / "path.csv", index=False)
    monkeypatch.chdir("/")
    run("compensate", folder / "out" / "model.yaml", folder / "path.csv", "-o", folder / "c.csv", "--separate-points")
    commands = pd.read_csv(folder / "c.csv")
    q = [f"q{j}_rad" for j in range(1, 7)]
    goal = commands[["wanted_x_mm", "wanted_y_mm", "wanted_z_mm"]].to_numpy()
    missed = {}
    for name, angles in (("before", wanted[q]), ("after", commands[q])):
        points = np.array([real.tool(row, np.ones(6)) for row in angles.to_numpy()])
        missed[name] = np.sqrt(np.mean((1e3 * points - goal) ** 2))
    assert missed["after"] < NOISE_MM < 0.1 * missed["before"]


@pytest.mark.long
@pytest.mark.parametrize(
    "stated",
    # gravity that is asked for: in the quick run of arms of tables (tests/diagnosis/test_gravity_direction.py)
    [True, pytest.param(False, marks=pytest.mark.long)],
)
def test_an_arm_on_a_wedge_is_understood_whether_its_lean_is_stated_or_asked_for(robot, stated):
    lean = Rotation.from_rotvec(np.radians(20) * np.array([0.6, 0.8, 0.0])).apply([0, 0, -9.81])
    real = Real(TORSO_ARM.read_text(), compliance={"lift": 8e-5, "elbow": 1e-4})
    real.full.gravity.linear = lean
    real.record(robot.with_name("recordings.csv"))
    if stated:
        robot.write_text(robot.read_text() + f"gravity_m_s2: {lean.tolist()}\n")
    arm = load_arm(robot)
    recordings = read_recordings(robot.with_name("recordings.csv"), arm.n_motors)
    verdict = diagnose(arm, recordings, Settings(resamples=0, cross_validation=False, estimate_gravity=not stated))
    found = {(effect.effect, effect.location): effect.parameters[0].value for effect in verdict.effects}
    truth = {("joint_compliance", "joint 2"): 8e-5, ("joint_compliance", "joint 3"): 1e-4}
    assert found == {place: pytest.approx(value, rel=0.05) for place, value in truth.items()}
    used = verdict.model.arm.gravity / 9.81
    assert np.degrees(np.arccos(used @ lean / 9.81)) < 2.5
