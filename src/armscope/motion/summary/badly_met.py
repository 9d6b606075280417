"""Runs that were held out and are met far worse than the motion that was fitted: something is different there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from armscope.core.types import Array
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.summary.constants import HELD_OUT
from armscope.motion.summary.holding_out import HeldOutTorque, missed_torque


def badly_met(
    selected: SelectedCauses, held: Sequence[HeldOutTorque], by_run: Mapping[str, float], fitted: float
) -> dict[str, float]:
    """Errors of held-out runs that are many times the fitted one, as shares of the torque and as torque, too.

    A run of little torque is met to a larger share of it, and one of much torque to more of it: each is no wonder.

    Args:
        selected: the selection.
        held: torques of what was held out.
        by_run: the model's error on each run, relative to its torque.
        fitted: the same on the motion that was fitted.

    Returns:
        By run, relative to its torque.
    """
    rows = selected.rows
    usual = _size(missed_torque(rows, np.arange(len(rows)), selected.residuals))
    found = {}
    for part in held:
        run, missed = part.rows.run[part.which], part.missed(part.model)
        for name in dict.fromkeys(run.tolist()):
            by = min(by_run[name] / fitted, _size(missed[run == name]) / usual)
            if by > HELD_OUT.badly:
                found[name] = by_run[name]
    return found


def _size(missed: Array) -> float:
    """RMS over rows of what is missed at all joints together."""
    return float(np.sqrt(np.mean(np.sum(missed**2, axis=1))))
