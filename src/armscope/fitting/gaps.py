"""By how much joints stand apart after motion to either side, beside all that was fitted to the rows."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.location import Location
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.refit import Refit
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
    fit: Refit, table: Recordings, weights: RowWeights, noise: float, taken_out: Sequence[Part] = ()
) -> dict[int, Gap]:
    """The gap of each motor whose side of approach varies in a table, by the motor, counted from 1.

    Each is fitted with all else, of which what follows the angle follows the side a little, too; and without the
    others, for all of which the rows are summed up once.

    Args:
        fit: all else.
        table: its rows, with sides of approach.
        weights: of the rows.
        noise: of the rows where they have these weights, mm per axis; NaN takes what the fit leaves of them, which is
            more than noise where there is play.
        taken_out: parts of the fit that are taken out before, since play may be what they stand for.

    Returns:
        Nothing where no side varies.
    """
    found = [placed for placed in BACKLASH.place(fit.model.arm, table) if is_play_by_approach(placed)]
    if not found:
        return {}
    layout = replace(fit.layout, terms=(*fit.layout.terms, *(term for gap in found for term in gap.terms)))
    (sums,) = normal_equations_by_block(layout, fit.model, table, weights, np.zeros(len(table), dtype=np.intp))
    out = [column for part in taken_out for column in fit.layout.of(part.placed)]
    beside = np.setdiff1d(np.arange(len(fit.precision)), out)
    ridge = fit.noise**2 * np.append(fit.precision[beside], 0.0)
    if np.isnan(noise):
        left = np.linalg.solve(sums.G[np.ix_(beside, beside)] + np.diag(ridge[:-1]), sums.b[beside])
        coefficients = np.zeros(len(sums.b))
        coefficients[beside] = left
        noise = float(np.sqrt(sums.rss(coefficients) / sums.n))
    told = {}
    for number, gap in enumerate(found, len(fit.precision)):
        at = np.append(beside, number)
        inverse = np.linalg.inv(sums.G[np.ix_(at, at)] + np.diag(ridge))
        size, stderr = float(inverse[-1] @ sums.b[at]), noise * float(np.sqrt(inverse[-1, -1]))
        rms_mm = abs(size) * float(np.sqrt(sums.G[number, number] / sums.n))
        told[Location.of(gap.location).index + 1] = Gap(size, stderr, rms_mm)
    return told


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
