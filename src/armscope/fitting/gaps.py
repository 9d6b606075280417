"""By how much joints stand apart after motion to either side, beside all that was fitted to the rows."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.location import Location
from armscope.fitting.block_sums import normal_equations_by_block, slope_at
from armscope.fitting.column_blocks import ModelColumns, TermBlocks
from armscope.fitting.linearisation import Measured, linearised
from armscope.fitting.parameter_layout import current_parameters
from armscope.fitting.refit import Refit
from armscope.inference.constants import NUMERICS
from armscope.inference.linear_algebra import ColumnBlocks, among, lower_cholesky, solve_lower, solve_upper
from armscope.inference.normal_equations import NormalEquations
from armscope.measurement.row_weights import RowWeights
from armscope.physics.effect import Part, Placed
from armscope.physics.transmission import BACKLASH
from armscope.recordings import Recordings


@dataclass(frozen=True)
class Gap:
    """Play of a motor, rad, below zero where it stands ahead of its reading on each way; RMS per axis, mm, if asked."""

    size: float
    stderr: float
    rms_mm: float = float("nan")

    @property
    def clearly(self) -> float:
        """How many standard errors it is from none."""
        return abs(self.size) / self.stderr


def gaps(
    fit: Refit,
    rows: Measured,
    weights: RowWeights,
    noise: float,
    taken_out: Sequence[Part] = (),
    sums: NormalEquations | None = None,
) -> dict[int, Gap]:
    """The gap of each motor whose side of approach varies in a table, by the motor, counted from 1.

    Each is fitted with all else, of which what follows the angle follows the side a little, too; and without the
    others. Only products with the gaps' own columns are summed up: how all else hangs together is known.

    Args:
        fit: all else.
        rows: its rows, with sides of approach.
        weights: of the rows.
        noise: of the rows where they have these weights, mm per axis; NaN takes what the fit leaves of them, which is
            more than noise where there is play.
        taken_out: parts of the fit that are taken out before, since play may be what they stand for.
        sums: of the fit's columns over the rows so weighted, by `sums_beside` where not given.

    Returns:
        Nothing where no side varies.
    """
    table = linearised(rows)
    found = [placed for placed in BACKLASH.place(fit.model.arm, table.recordings) if is_play_by_approach(placed)]
    if not found:
        return {}
    sums = sums or sums_beside(fit, table, weights)
    columns = ModelColumns(fit.layout, np.arange(len(fit.precision)), fit.model, table, weights)
    (blocks,) = columns.sums([TermBlocks.of([gap.terms for gap in found])])
    out = [column for part in taken_out for column in fit.layout.of(part.placed)]
    beside = np.setdiff1d(np.arange(len(fit.precision)), out)
    factor = lower_cholesky(among(sums.G, beside), fit.noise**2 * fit.precision[beside])
    whitened_rhs = solve_lower(factor, sums.b[beside])
    if np.isnan(noise):
        coefficients = np.zeros(len(sums.b))
        coefficients[beside] = solve_upper(factor, whitened_rhs)
        noise = float(np.sqrt(sums.rss(coefficients) / sums.n))
    left, b = ColumnBlocks(blocks.own, blocks.cross[:, beside], blocks.b).conditioned(factor, whitened_rhs)
    told = {}
    for gap, seen, own, pull in zip(found, blocks.diagonal[:, 0], left[:, 0, 0], b[:, 0], strict=True):
        own = max(own, NUMERICS.absorbed * seen)
        size, stderr = float(pull / own), noise / float(np.sqrt(own))
        rms_mm = abs(size) * float(np.sqrt(seen / sums.n))
        told[Location.of(gap.location).index + 1] = Gap(size, stderr, rms_mm)
    return told


def sums_beside(fit: Refit, table: Measured, weights: RowWeights) -> NormalEquations:
    """Sums of a fit's columns over its rows with some weights; with its own, products of the columns are known.

    Args:
        fit: whose columns they are.
        table: its rows.
        weights: of the rows.

    Returns:
        Sums where the fit ended, mm per SI unit.
    """
    if weights is fit.weights:
        at = current_parameters(fit.layout, fit.model)
        return slope_at(fit.layout, fit.model, table, weights).about(fit.equations.G, at)
    return normal_equations_by_block(fit.layout, fit.model, table, weights, np.zeros(len(table), dtype=np.intp))[0]


def is_play_by_approach(placed: Placed) -> bool:
    """Whether an effect is play by the side of approach."""
    return placed.name == BACKLASH.name and placed.variant == "approach"


def rows_of_unknown_side(recordings: Recordings, plays: Iterable[Placed]) -> NDArray[np.bool_]:
    """(N,) rows of which it is not known from which side a joint with play by approach came."""
    unknown = np.zeros(len(recordings), dtype=bool)
    for play in plays:
        sides = recordings.approach
        unknown |= True if sides is None else np.isnan(sides[:, Location.of(play.location).index])
    return unknown
