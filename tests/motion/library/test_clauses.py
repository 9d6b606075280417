"""Causes as clauses of a sentence."""

from __future__ import annotations

from armscope.motion.library.clauses import power_clause
from armscope.motion.verdict import FoundCause
from armscope.verdict.effects import Parameter


def test_a_curve_of_friction_is_told_with_its_power() -> None:
    numbers = (Parameter("bent", "N m s^0.61/rad^0.61", 4.1, 0.02), Parameter("power", "", 0.612, float("nan")))
    cause = FoundCause(
        "viscous_curve", "joint 2", "friction", "speed", "", False, numbers, 0.83, "N m", "joint 2", 0.3, 9
    )
    told = power_clause(cause, {each.name: each for each in numbers})
    assert told == "friction of joint 2 grows as its speed to the power of 0.61, not in proportion to it (0.83 N m RMS)"
