"""Whether a change can stand under its name, by the numbers that are told of it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import fdtri

from armscope.comparison.constants import COMPARING
from armscope.comparison.dispersion import Possible
from armscope.comparison.gained import cannot_be_negative
from armscope.comparison.result import Change
from armscope.comparison.shared_model import SharedModel


def stands(model: SharedModel, found: Possible, change: Change, taken: Sequence[Possible], tried: int) -> bool:
    """Whether a change's own numbers say that it is one, and one that this cause can make.

    Args:
        model: what recordings share.
        found: the change.
        change: as it would be told.
        taken: all changes, this one included.
        tried: how many there were to choose from.

    Returns:
        False where each number may be as it was, where one is below zero that cannot be, or where all of it moves the
        tool by less than the noise lets anyone see.
    """
    surely = any(low > 0 or high < 0 for low, high in (number.interval_95 for number in change.parameters))
    return surely and not _impossible(change) and change.rms_mm >= least_seen_mm(model, found, taken, tried)


def _impossible(change: Change) -> bool:
    """Whether what cannot be below zero is."""
    if not cannot_be_negative(change.effect, len(change.parameters)):
        return False
    (number,) = change.parameters
    return any(
        value < -COMPARING.surely_negative * stderr for value, stderr in zip(number.values, number.stderrs, strict=True)
    )


def least_seen_mm(model: SharedModel, found: Possible, taken: Sequence[Possible], tried: int) -> float:
    """What a change must move the tool by to be told from noise if nothing else could look like it.

    Args:
        model: what recordings share.
        found: the change, of q numbers.
        taken: all changes: what they do is no noise.
        tried: how many there were to choose from.

    Returns:
        RMS of the distance, mm: of it chance makes as much, on these rows, as often as the level says.
    """
    points = [np.sum(model.weight[rows] ** 2) / 3 for rows in (found.there, ~found.there)]
    q, variance = len(found.placed.terms), model.variance(taken)
    least = fdtri(q, len(model.weight) - q, 1 - COMPARING.level / tried)
    return float(np.sqrt(q * least * model.dispersion * variance * sum(1 / each for each in points)))
