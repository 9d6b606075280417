"""Links and loads that weigh less than nothing are no answer; lighter ones are."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

from armscope.core.types import Array
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.verdict import FoundCause
from tests.motion.moving import ROBOT, Plant, moved, robot
from tests.motion.summary.test_differing_runs import diagnosed


def times_its_own(share: float) -> Plant:
    """What the last link's mass alone asks for, some times."""
    stated: Any = ROBOT["links"]
    light = {"mass_kg": 1e-6, "com_mm": [0, 0, 0], "inertia_kg_m2": [1e-9, 1e-9, 1e-9, 0, 0, 0]}
    without = robot(links=[*stated[:2], light]).model
    data = without.createData()

    def plant(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        others = np.array([pin.rnea(without, data, *row).copy() for row in zip(q, dq, ddq, strict=True)])
        return share * (rigid - others)

    return plant


def masses(share: float) -> list[FoundCause]:
    found = diagnose_motion(robot(), moved(robot(), 3, times_its_own(share)), MotionSettings(cutoff=10.0)).verdict
    return [each for each in found.effects if each.parameters[0].name == "mass"]


@pytest.mark.long
def test_a_link_is_as_light_as_it_can_be() -> None:
    """Of 4 kg."""
    told = masses(-0.6)[0]
    assert told.location == "link 3"
    assert told.parameters[0].value == pytest.approx(-0.6 * 4, abs=0.2)


def test_no_link_or_load_is_told_that_weighs_less_than_nothing() -> None:
    """A wrong arm's description, or an encoder that counts backwards, asks for such: "10 kg lighter", of 1.4 kg."""
    for told in masses(-2.0):
        assert told.parameters[0].value > -4 - 2 * told.parameters[0].stderr


@pytest.mark.long
def test_what_one_joint_reads_too_large_in_a_run_is_no_load_inside_the_arm() -> None:
    """A tenth more at joint 2 in one run of three: 0.94 kg on joint 3's axis, 0.3 m from the flange, fitted it."""
    found = diagnosed(1, lambda run, at, torque: (0.0, 0.1, -0.08)[run] * torque).verdict
    assert not [each for each in found.effects if each.location == "payload"]


@pytest.mark.long
def test_a_load_at_the_flange_in_one_run_has_its_name() -> None:
    without, loaded = (
        moved(arm, 3, runs=3) for arm in (robot(), robot(tool_load={"mass_kg": 1.5, "com_mm": [0, 0, 0]}))
    )
    there = (without.run == "path 2")[:, None]
    found = diagnose_motion(robot(), replace(without, effort=np.where(there, loaded.effort, without.effort))).verdict
    (told,) = [each for each in found.effects if not each.minor]
    assert told.location == "payload"
    assert told.parameters[0].value == pytest.approx(1.5, abs=0.15)
