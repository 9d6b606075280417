"""A load that seems wrong, or the gains of every drive."""

import dataclasses

import numpy as np
import pytest

from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.summary.confounding import EVERY_JOINT, gains_instead
from armscope.robot.dynamics import MovingArm
from tests.motion.moving import moved, robot

DRIVES = [{"gain_nm_per_a": 10.0}] * 3


def weighed(arm: MovingArm, kind: str) -> MotionDiagnosis:
    """1.5 kg more than stated at the tool, recorded as torque or as current."""
    heavier = robot(tool_load={"mass_kg": 1.5, "com_mm": [0, 0, 0]})
    motions = moved(heavier, 3, seconds=10.0)
    if kind == "current":
        motions = dataclasses.replace(motions, kind="current", effort=motions.effort / 10.0)
    return diagnose_motion(arm, motions, MotionSettings(cutoff=10.0))


def load_of(found: MotionDiagnosis) -> int:
    placed = found.selected.rows.layout.placed
    return next(n for n in found.selected.best.candidates if placed[n].cause.name == "payload_error")


@pytest.mark.long
def test_gains_can_stand_in_the_place_of_a_load_where_currents_were_recorded() -> None:
    found = weighed(robot(drives=DRIVES), "current")
    rival = gains_instead(found.selected, load_of(found))
    assert rival is not None
    assert (rival.effect, rival.location) == ("motor_constant", EVERY_JOINT)
    assert np.isfinite(rival.evidence_gap_nats)
    assert rival.evidence_gap_nats > 20, "a load that hangs at the tool is not a factor of all torques"


@pytest.mark.long
def test_they_can_not_where_torques_were() -> None:
    found = weighed(robot(), "torque")
    assert gains_instead(found.selected, load_of(found)) is None
