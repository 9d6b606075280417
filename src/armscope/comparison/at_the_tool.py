"""What a change does at the tool, beyond what base and tool of each recording take up."""

from __future__ import annotations

import numpy as np

from armscope.comparison.scoring import Possible
from armscope.comparison.shared_model import SharedModel
from armscope.core.types import Array


def moved_mm(model: SharedModel, possible: Possible, change: Array) -> float:
    """What a change moves the tool by.

    Args:
        model: what recordings share.
        possible: the change.
        change: (q,) its size, SI units.

    Returns:
        RMS of the distance in the recordings that have it, mm.
    """
    moved = beyond_frames(model, model.columns_of(possible.number, possible.sets) @ change)
    return float(np.sqrt(3) * _rms(model, possible, moved))


def taken_back_mm(model: SharedModel, possible: Possible, change: Array) -> tuple[float, float]:
    """What base and tool leave of the recordings with a change, as they are, and if it were taken back.

    How large a cause is in all recordings the poses may leave open: others look like it. What taking it back does to
    them they do not: who sets a zero by as much as it moved, after it was repaired, undoes the repair.

    Args:
        model: what recordings share.
        possible: the change.
        change: (q,) its size, SI units.

    Returns:
        RMS per axis, mm, of each.
    """
    left = beyond_frames(model, model.residual)
    moved = beyond_frames(model, model.columns_of(possible.number, possible.sets) @ change)
    return _rms(model, possible, left), _rms(model, possible, left - moved)


def worse_sigmas(model: SharedModel, possible: Possible, change: Array) -> float:
    """By how many standard errors more is left of the rows with a change if it is taken back; below zero: less.

    Args:
        model: what recordings share.
        possible: the change.
        change: (q,) its size, SI units.

    Returns:
        Of the mean over the rows, each paired with itself: on other poses of this kind it would be as much.
    """
    rows = np.isin(model.group, possible.sets)
    left = (beyond_frames(model, model.residual) / model.weight)[rows]
    back = left - (beyond_frames(model, model.columns_of(possible.number, possible.sets) @ change) / model.weight)[rows]
    more = np.sum((back**2 - left**2).reshape(-1, 3), axis=1)
    return float(more.mean() / np.sqrt(model.dispersion * np.var(more, ddof=1) / len(more)))


def beyond_frames(model: SharedModel, numbers: Array) -> Array:
    """(3N,) what is left of weighed numbers once every recording has the base and tool that suit it best."""
    return np.asarray(numbers - model.frames @ np.linalg.lstsq(model.frames, numbers, rcond=None)[0])


def _rms(model: SharedModel, possible: Possible, numbers: Array) -> float:
    """Per axis, in the recordings with a change, without weights."""
    return float(np.sqrt(np.mean((numbers / model.weight)[np.isin(model.group, possible.sets)] ** 2)))
