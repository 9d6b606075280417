"""What a path that excites little leaves unknown is said; a lively one is told nothing of the kind."""

import warnings

import numpy as np
import pytest

from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.recordings.motions import Motions, as_motions
from tests.motion.moving import COULOMB, ROTOR, VISCOUS, moved, robot, table


def hardly_moving() -> Motions:
    """All joints together, a few degrees at a tenth of a hertz."""
    arm, content = robot(), table(robot(), 1, runs=1, seconds=20.0)
    time, wave = content["time_s"].to_numpy(), 2 * np.pi * 0.1
    sizes = np.array([0.05, 0.03, 0.03])
    q, dq, ddq = (
        each[:, None] * sizes
        for each in (np.sin(wave * time), wave * np.cos(wave * time), -(wave**2) * np.sin(wave * time))
    )
    torque = arm.torques(q, dq, ddq, arm.inertial) + COULOMB * np.sign(dq) + VISCOUS * dq + ROTOR * ddq
    torque += 0.02 * np.random.default_rng(0).normal(size=torque.shape)
    for j in range(3):
        content[f"q{j + 1}_rad"], content[f"tau{j + 1}_nm"] = q[:, j], torque[:, j]
    return as_motions(content, "motions.csv", 3)


def test_a_path_that_excites_little_says_what_it_leaves_unknown() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # no number runs away
        verdict = diagnose_motion(robot(), hardly_moving()).verdict
    (told,) = (notice.text for notice in verdict.notices if notice.kind == "little excited")
    assert told.startswith("The path excites little: condition number ")
    assert "of link" in told
    assert "Joints 1, 2, 3 move too slowly" in told
    assert verdict.identifiable["condition"] > 1000


@pytest.mark.long
def test_a_lively_path_is_told_nothing_of_the_kind() -> None:
    verdict = diagnose_motion(robot(), moved(robot(), 1, seconds=10.0), MotionSettings(cutoff=10.0)).verdict
    assert not [notice for notice in verdict.notices if notice.kind == "little excited"]
    assert verdict.identifiable["condition"] < 20
    assert verdict.identifiable["combinations"] < verdict.identifiable["parameters"]
