"""Cures that add what has no law: where its numbers are, in which units, and how they are applied."""

from __future__ import annotations

from armscope.motion.library.clauses import SCALE, amount
from armscope.motion.library.remedies import Fitted

CURVES = "curves.csv"
"""The file that holds the points of all curves of a model."""
WAY, PLAY, UNEVEN = "way since the last reversal", "torque since its last reversal", "joint angle and direction"
"""What torque without a law follows beside the drivers of curves."""


def unit_of(driver: str, sliding: bool) -> str:
    """SI unit of what a curve follows.

    Args:
        driver: as a cause has it.
        sliding: whether the joint does.
    """
    length, torque = ("m", "N") if sliding else ("rad", "N m")
    units = {"speed": f"{length}/s", "load": torque, "time": "s", "temperature": "deg C", PLAY: torque}
    return units.get(driver, length)


def by_its_points(fitted: Fitted) -> str:
    """What follows something by no known law: points of a curve, or what slips after a way."""
    if fitted.driver == SCALE:
        return _bent_reading(fitted)
    if fitted.driver == UNEVEN:
        sine, cosine = (amount(fitted.numbers[name], sign=True) for name in ("sine", "cosine"))
        return f"{fitted.in_general}: ({sine} × sin(angle) {cosine} × cos(angle)) × sign of the speed."
    if fitted.driver in (WAY, PLAY):
        return f"{fitted.in_general}: {_slipping(fitted)}"
    sliding = fitted.first.unit == "N"
    unit, torque = unit_of(fitted.driver, sliding), "N" if sliding else "N m"
    follows = "torque of the stated masses" if fitted.driver == "load" else fitted.driver
    return (
        f"{fitted.in_general}: {CURVES} has it for {fitted.place} over the {follows} ({unit}; torque in {torque}). Add "
        "it to the torque of the joint, straight between its points, and beyond them as at the last."
    )


def _slipping(fitted: Fitted) -> str:
    """Prandtl's stops, each with the step that it is taken along by before it slips."""
    of_torque = fitted.driver == PLAY
    steps = "step of the torque that the model has" if of_torque else "step of the position"
    low = f", low-passed at {fitted.of_law[0]:.3g} Hz but for its dry friction" if of_torque else ""
    return (
        f"{CURVES} has {len(fitted.parameters)} rows of shape `stop` for {fitted.place}, each with its `at` and "
        f"`torque`. Keep a number s for each: from sample to sample it grows by the {steps}{low} divided by `at`, and "
        "is held between −1 and 1; it starts as 1 with the sign of the first step. Add the sum of all `torque` × s to "
        "the torque of the joint."
    )


def _bent_reading(fitted: Fitted) -> str:
    """A torque that is recorded by another curve than a straight line."""
    (usual,) = fitted.of_law
    linear, square, cube = (amount(each, sign=True) for each in fitted.parameters)
    return (
        f"{fitted.in_general}: to the torque T that the model has of {fitted.place} add "
        f"({linear} {square} × |x| {cube} × x²) × T, where x is T / ({usual:.4g} SI)."
    )
