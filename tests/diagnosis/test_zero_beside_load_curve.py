"""A curve of a joint's load and the joint's zero share a constant: without a load only the zero is left."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.physics.scene import Scene
from armscope.robot import chain
from armscope.robot.kinematics import joint_jacobian
from armscope.verdict.corrections import zero_offsets
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.files import curves_table

from ..physics.scenes import arm_named
from .planted import one_run, recorded

QUICK = Settings(resamples=0, cross_validation=False)


def told(zero: float, bent: float, seed: int) -> Diagnosis:
    """What is said of a drive that turns by ``bent`` rad times its load's cube at the largest, beside a zero, rad."""
    arm, rng = arm_named("six-axis"), np.random.default_rng(seed)
    table = replace(one_run(arm, 180, seed), approach=None, temperature=None, speed=None, time=None)
    wanted = {("joint_offset", f"joint {j}"): [1e-4 * rng.normal()] for j in (2, 4, 5)}
    wanted["joint_offset", "joint 3"] = [zero]
    wanted["joint_compliance", "joint 2"] = [3e-7]
    table = recorded(arm, table, wanted, 0.04, seed)
    load = Scene(arm, table).torques[:, 2]
    turn = bent * (load / np.abs(load).max()) ** 3
    moved = joint_jacobian(chain(arm, table.motor_angles))[:, :, 2] * turn[:, None]
    return diagnose(arm, replace(table, positions=table.positions + moved), QUICK)


@pytest.mark.parametrize("seed", [4, 5])
def test_the_constant_of_a_curve_over_load_is_no_zero_to_be_set(seed: int) -> None:
    """The zero is right; a curve's bumps against a constant are worth 4 mrad with a narrow interval."""
    verdict = told(0.0, 1e-2, seed)
    assert ("unknown", "joint 3") in {(e.effect, e.location) for e in verdict.effects}
    assert ("joint_offset", "joint 3") not in {(e.effect, e.location) for e in verdict.effects}
    zeros = zero_offsets(verdict).set_index("joint")
    assert zeros.loc["joint 3", "cause"] == "not named"
    assert zeros.loc["joint 3", "actual_minus_commanded_mrad"] == 0
    table = curves_table(verdict)
    assert table is not None
    of_joint = table[table["location"] == "joint 3"]
    without_load = np.interp(0.0, of_joint["at"], of_joint["value"])
    assert without_load == pytest.approx(0.0, abs=3e-4)  # the table holds the whole constant


def test_a_zero_that_is_there_without_load_is_named_with_all_that_the_curve_may_hold_in_its_interval() -> None:
    zero = 5e-3
    (found,) = (e for e in told(zero, 1e-2, 1).effects if (e.effect, e.location) == ("joint_offset", "joint 3"))
    offset = found.parameters[0]
    assert abs(offset.value - zero) < 2 * offset.stderr
