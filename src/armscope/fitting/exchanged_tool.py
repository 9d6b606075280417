"""Whether a tool was exchanged between runs: one answer for the check, the calibration and the diagnosis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array
from armscope.fitting.constants import EXCHANGE
from armscope.fitting.linearisation import residuals
from armscope.fitting.registration import fit_frames
from armscope.measurement import robust
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings


@dataclass(frozen=True, eq=False)
class ExchangedTool:
    """Tools of a target that lie elsewhere on the flange from run to run."""

    model: FittedModel  # the arm with its frames fitted, the tool free in every run
    # shared_mm, own_mm: what one tool for all runs and one per run leave of the usual point, per axis
    shared_mm: float
    own_mm: float
    point_mm: float | None  # largest distance between a target's tool points; None where these are no others
    turn_rad: float | None  # largest angle between a target's tools; None where orientations do not show any

    @property
    def apart(self) -> str:
        """How far the tools lie apart, in words."""
        point = [] if self.point_mm is None else [f"its point up to {self.point_mm:.3g} mm"]
        turn = [] if self.turn_rad is None else [f"its axes up to {np.degrees(self.turn_rad):.3g} degrees"]
        return " and ".join([*point, *turn])


def exchanged_tool(shared: FittedModel, recordings: Recordings) -> ExchangedTool | None:
    """Tools that lie elsewhere in some runs, by points or by orientations; None where one tool per target does.

    What one tool per run leaves is enlarged for the numbers that it costs; where frames take up half of the measured
    numbers, they would follow anything and tell nothing.

    Args:
        shared: the arm with its frames fitted to the recordings, one tool for all runs.
        recordings: the rows.
    """
    if len(shared.bases) < 2:
        return None
    free = fit_frames(shared.arm, recordings, tool_per_run=True)
    measured, spent = 3 * len(recordings), 6 * len(free.bases) + 3 * len(free.tools)
    if len(free.tools) == len(shared.tools) or measured < EXCHANGE.least_numbers * spent:
        return None
    cost = float(np.sqrt(measured / (measured - spent)))
    before, after = residuals(shared, recordings), residuals(free, recordings)
    apart: dict[str, float] = {}
    for channel, left in before.by_channel.items():
        known = np.isfinite(left).all(axis=1)
        moved = max(channel.tools_apart(free, str(target)) for target in np.unique(recordings.target))
        if known.any() and _exchanged(1e3 * moved, 1e3 * left[known], 1e3 * after[channel.name][known], cost):
            apart[channel.name] = moved
    if not apart:
        return None
    point, turn = apart.get("position"), apart.get("orientation")
    shared_mm, own_mm = (robust.scale_of(each.points_mm) for each in (before, after))
    return ExchangedTool(free, shared_mm, own_mm, None if point is None else 1e3 * point, turn)


def _exchanged(apart: float, before: Array, after: Array, cost: float) -> bool:
    """Whether tools lie apart, seen by residuals (N, c) with one tool for all runs and with one per run."""
    left = robust.scale_of(after)
    return robust.scale_of(before) > EXCHANGE.worse * cost * left and apart > EXCHANGE.apart * left
