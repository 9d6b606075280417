"""Arms that nobody here described: URDFs of the package example-robot-data load, are simulated, and are diagnosed."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from armscope.calibration.calibrate import calibrate
from armscope.core.inputs import InputError
from armscope.diagnosis import Settings, diagnose
from armscope.recordings import as_recordings
from armscope.robot.arm import build_arm
from armscope.robot.denavit_hartenberg import as_dh
from armscope.robot.description import RobotDescription
from armscope.world.kinds import Concealed
from armscope.world.session import random_session
from armscope.world.spec import KINDS
from armscope.world.strength import equilibrium, make_scene, sized

ARMS = {
    "UR5": ("ur_description/urdf/ur5_robot.urdf", "tool0", {}),
    "Panda": ("panda_description/urdf/panda.urdf", "panda_hand", {}),
    "TIAGo": ("tiago_description/robots/tiago.urdf", "wrist_ft_tool_link", {"torso_lift_joint": 0.1}),
}
NOISE_M = 2e-5
WIDEST_DEG = 170.0


def robots() -> Path:
    """Where the package's URDFs are: ARMSCOPE_EXAMPLE_ROBOT_DATA, or beside this Python's packages (414 MB)."""
    here = [Path(path) / "cmeel.prefix" / "share" / "example-robot-data" for path in sys.path]
    stated = os.environ.get("ARMSCOPE_EXAMPLE_ROBOT_DATA")
    found = [path / "robots" for path in ([Path(stated)] if stated else here) if (path / "robots").is_dir()]
    if not found:
        pytest.skip("the package example-robot-data is not installed: pip install --no-deps example-robot-data")
    return found[0]


def described(name, **more):
    file, tip, held = ARMS[name]
    return RobotDescription(
        name=name, urdf=str(robots() / file), tip=tip, hold_joints=held, tool_mm=(20, 0, 80), **more
    )


@pytest.fixture(scope="module", params=ARMS)
def simulated(request):
    """An arm, its scene in the virtual worlds' engine (from D-H rows of the same chain), and where its base is."""
    arm = build_arm(described(request.param))
    description, base = as_dh(arm)
    limits = np.clip(np.array(description.joint_limits_deg), -WIDEST_DEG, WIDEST_DEG)
    description = description.model_copy(update={"joint_limits_deg": tuple(map(tuple, limits.tolist()))})
    session = random_session(description, np.random.default_rng(3), 160, "free", 2.0, 2.0)
    return arm, make_scene(description, session)[0], base


def recorded(arm, scene, base, effects, noise=NOISE_M):
    points = equilibrium(scene, effects).tool @ base[:3, :3].T + base[:3, 3]
    points = points + np.random.default_rng(5).normal(0, noise, points.shape)
    content = {f"q{j + 1}_rad": scene.session.commanded[:, j] for j in range(arm.n_motors)}
    content |= {f"{axis}_m": points[:, k] for k, axis in enumerate("xyz")} | {"payload_kg": scene.session.payload}
    return as_recordings(pd.DataFrame(content), arm.name, arm.n_motors)


@pytest.mark.parametrize(
    ("kind", "place"), [("joint_compliance", "joint 2"), ("joint_offset", "joint 4"), ("gear_eccentricity", "joint 3")]
)
def test_a_concealed_effect_is_found_at_its_place_with_its_size(simulated, kind, place):
    arm, scene, base = simulated
    drawn = KINDS[kind].draw(np.random.default_rng(1), scene, place)
    planted = sized(scene, Concealed(KINDS[kind], place, drawn), 0.3e-3)
    table = recorded(arm, scene, base, [planted.effect])
    verdict = diagnose(arm, table, Settings(resamples=0, cross_validation=False))
    assert [(effect.effect, effect.location) for effect in verdict.effects] == [(kind, place)]
    number = verdict.effects[0].parameters[0]
    assert number.value == pytest.approx(planted.effect.values[number.name], abs=4 * number.stderr)
    assert verdict.residual_after_mm == pytest.approx(1e3 * NOISE_M, rel=0.1)


def test_a_clean_arm_has_nothing_missing(simulated):
    arm, scene, base = simulated
    verdict = diagnose(arm, recorded(arm, scene, base, []), Settings(resamples=0, cross_validation=False))
    assert (verdict.mismatch, verdict.effects) == (False, ())


def test_what_poses_cannot_tell_apart_is_held_when_an_arm_is_calibrated(simulated):
    arm, scene, base = simulated
    calibration = calibrate(arm, recorded(arm, scene, base, []), "geometric")
    assert np.isfinite(calibration.covariance).all()
    assert calibration.rms_distance == pytest.approx(NOISE_M * np.sqrt(3), rel=0.15)
    # six numbers per joint describe a chain of hinges twice over: four are enough
    assert len(calibration.held) >= 2 * arm.n_joints


def test_the_torso_that_slides_is_named_with_its_cure():
    file, tip, _ = ARMS["TIAGo"]
    with pytest.raises(
        InputError, match=r"torso_lift_joint.*only turning joints.*hold_joints: \{torso_lift_joint: 0\}"
    ):
        build_arm(RobotDescription(name="t", urdf=str(robots() / file), tip=tip))
