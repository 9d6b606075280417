"""Causes as clauses of a sentence."""

from __future__ import annotations

from armscope.motion.library.clauses import power_clause, stribeck_clause
from armscope.motion.verdict import FoundCause
from armscope.verdict.effects import Parameter


def test_a_curve_of_friction_is_told_with_its_power() -> None:
    numbers = (Parameter("bent", "N m s^0.61/rad^0.61", 4.1, 0.02), Parameter("power", "", 0.612, float("nan")))
    cause = FoundCause(
        "viscous_curve", "joint 2", "friction", "speed", "", False, numbers, 0.83, "N m", "joint 2", 0.3, 9
    )
    told = power_clause(cause, {each.name: each for each in numbers})
    assert told == "friction of joint 2 grows as its speed to the power of 0.61, not in proportion to it (0.83 N m RMS)"


def test_friction_that_rises_from_rest_before_it_falls_is_not_higher_near_rest() -> None:
    """It was 3 N m lower there, and told as 2.6 N m higher."""
    for height, wider, told in (
        (2.6, 10.7, "not what it is farther"),
        (2.6, 0.1, "N m higher"),
        (-2.6, 0.1, "N m lower"),
    ):
        numbers = (Parameter("stribeck", "N m", height, 0.5), Parameter("wider", "N m", wider, 0.5))
        cause = FoundCause(
            "stribeck_friction", "joint 2", "friction", "speed", "", False, numbers, 0.8, "N m", "joint 2", 0.3, 9
        )
        assert told in stribeck_clause(cause, {each.name: each for each in numbers})
