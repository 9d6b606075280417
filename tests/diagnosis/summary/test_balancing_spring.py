"""A spring that takes half of a joint's load, and that robot.yaml does not state: seen as what it may be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm, chain
from armscope.robot.kinematics import joint_jacobian
from armscope.verdict.effects import FoundEffect

from ...physics.scenes import arm_named
from ..planted import one_run, recorded

QUICK = Settings(resamples=0, cross_validation=False)
ROWS, NOISE_MM, PER_NM = 250, 0.02, 4e-7


def found_at_joint_2(arm: Arm, table: Recordings) -> dict[str, FoundEffect]:
    return {effect.effect: effect for effect in diagnose(arm, table, QUICK).effects if effect.location == "joint 2"}


def with_wave_of_joint_2(lifts_nm: float, ahead: float) -> tuple[Arm, Recordings]:
    """Joint 2 gives way to what gravity leaves of its load when a wave of the angle lifts it; ``ahead`` of upright."""
    arm = arm_named("four-axis")
    table = one_run(arm, ROWS, seed=2)
    angle, load = table.motor_angles[:, 1], Scene(arm, table).torques[:, 1]
    # gravity's torque on joint 2 is a wave of its angle, for the most part: its phase by least squares
    waves = np.column_stack([np.cos(angle), np.sin(angle), np.ones(ROWS)])
    cosine, sine, _ = np.linalg.lstsq(waves, load, rcond=None)[0]
    upright = np.arctan2(sine, cosine)
    turn = PER_NM * (load - lifts_nm * np.cos(angle - upright - ahead))
    lever = joint_jacobian(chain(arm, table.motor_angles))[:, :, 1]
    still = recorded(arm, table, {}, NOISE_MM, seed=4)
    return arm, replace(still, positions=still.positions + lever * turn[:, None])


@pytest.mark.long
def test_a_wave_that_relieves_a_drive_may_be_a_spring_that_nobody_stated() -> None:
    wave = found_at_joint_2(*with_wave_of_joint_2(300.0, ahead=0.0))["gear_eccentricity"]
    assert wave.named_as == "region"
    assert wave.title == "gear eccentricity at joint 2 or balancing spring at joint 2"
    assert wave.alternatives[0].effect == "balancing_spring"
    assert wave.confirm.startswith("See first whether a spring")


@pytest.mark.long
def test_masses_far_below_the_stated_ones_may_be_a_spring_that_nobody_stated() -> None:
    drive = found_at_joint_2(*with_wave_of_joint_2(600.0, ahead=0.0))["joint_compliance"]
    assert drive.named_as == "effect"  # which gives way beside a spring as well
    assert drive.alternatives[0].effect == "balancing_spring"
    assert "the masses may be as stated" in drive.confirm


@pytest.mark.long
@pytest.mark.parametrize("ahead", [np.pi, np.pi / 2, -np.pi / 2])
def test_a_wave_that_adds_to_the_give_or_lies_across_it_is_no_spring(ahead: float) -> None:
    found = found_at_joint_2(*with_wave_of_joint_2(600.0, ahead))
    assert found["gear_eccentricity"].named_as == "effect"
    assert "balancing_spring" not in {other.effect for effect in found.values() for other in effect.alternatives}


@pytest.mark.long
def test_a_spring_that_takes_less_than_masses_are_off_is_not_told_of_the_drive() -> None:
    drive = found_at_joint_2(*with_wave_of_joint_2(300.0, ahead=0.0))["joint_compliance"]
    assert "balancing_spring" not in {other.effect for other in drive.alternatives}
