"""Recorded torques that are too large, turned, or in another unit, in words that mend them."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from armscope.motion.library.clauses_of_gains import gain_clause, other_unit
from armscope.motion.pipeline import diagnose_motion
from armscope.motion.verdict import FoundCause
from armscope.verdict.effects import Parameter
from tests.motion.moving import moved, robot

KGF_M = 9.80665


def told(gain: float, stderr: float = 0.01) -> str:
    number = Parameter("gain", "", gain, stderr)
    cause = FoundCause(
        "motor_constant", "joint 3", "drive", "load", "", False, (number,), 2.0, "N m", "joint 3", 0.3, 9
    )
    return gain_clause(cause, {"gain": number})


@pytest.mark.parametrize(
    ("gain", "words"),
    [
        (0.08, "8.0 ± 2.0 % too large"),
        (1 / KGF_M - 1, "89.8 ± 2.0 % too small: as in kgf m"),
        (7.85, "785.0 ± 2.0 % too large: as in lbf in"),
        (-1.0 - 1 / 3, "the sign of the recorded torque of joint 3 is turned"),
    ],
)
def test_a_gain_is_told_with_its_size_and_another_unit_where_one_fits(gain: float, words: str) -> None:
    assert words in told(gain)


@pytest.mark.parametrize("gain", [0.0, -0.5, 1.0, -0.262, 5.0])
def test_a_gain_that_no_unit_has_is_none(gain: float) -> None:
    assert other_unit(Parameter("gain", "", gain, 0.01)) == ""


@pytest.mark.parametrize("factor", [1 / KGF_M, 8.850746])
def test_one_joint_in_another_unit_is_the_cause_and_its_cure_mends_the_table(factor: float) -> None:
    as_it_is = moved(robot(), 1, noise=0.005, seconds=15.0)
    scale = np.array([1.0, 1.0, factor])
    found = diagnose_motion(robot(), replace(as_it_is, effort=as_it_is.effort * scale))
    first = found.verdict.effects[0]
    assert (first.effect, first.location, first.minor) == ("motor_constant", "joint 3", False)
    by = re.search(r"by ([\d.]+)", first.cure)
    assert by is not None
    scale[2] *= float(by.group(1))
    mended = diagnose_motion(robot(), replace(as_it_is, effort=as_it_is.effort * scale))
    assert mended.verdict.answer == "nothing missing"
