"""A rocker's direction that nobody stated, between those that are tried at first."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.physics.loaded_arm import LINKAGE_JOINT
from armscope.physics.scene import Scene
from armscope.robot import chain
from armscope.robot.arm import build_arm
from armscope.robot.kinematics import joint_jacobian
from armscope.robot.parallelogram import Linkage, forearm_deviation
from tests.diagnosis.planted import planted


@pytest.mark.long
@pytest.mark.parametrize("direction", [88.4, pytest.param(91.6, marks=pytest.mark.long)])
def test_bars_in_error_are_all_that_is_told_whichever_way_the_rocker_points(direction: float) -> None:
    """Half a coarse step away a slope is left that passes for a ratio and a coupling of the joint."""
    arm, table = planted("parallelogram-120kg", {}, 200, 0.02, seed=7)
    arm = build_arm(arm.description.model_copy(update={"parallelogram": None}))
    true = Linkage(crank=0.35, rocker=0.35, rod=1.1, upper_arm=1.1, crank_angle=float(np.radians(direction)))
    wrong = replace(true, rod=true.rod - 5e-4, rocker=true.rocker - 5e-4)
    elbow = Scene(arm, table).elbow_angle
    turn = forearm_deviation(wrong, elbow) - forearm_deviation(true, elbow)
    moved = joint_jacobian(chain(arm, table.motor_angles))[:, :, LINKAGE_JOINT - 1] * turn[:, None]
    verdict = diagnose(
        arm, replace(table, positions=table.positions + moved), Settings(resamples=0, cross_validation=False)
    )
    (bars,) = verdict.effects
    assert bars.effect == "parallelogram_geometry"
    told = {parameter.name: parameter.value for parameter in bars.parameters}
    assert abs(told["crank_angle"] - direction) < 0.5
    assert abs(told["rod"] / (-5e-4 / 0.35) - 1) < 0.03
