"""Which runs stand on one base: bases of runs are compared, and what was set up anew is told from what settled."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from armscope.core.types import Array, Indices
from armscope.fitting.constants import SET_UPS
from armscope.fitting.linearisation import linearised
from armscope.fitting.placement import nearest_rotation
from armscope.measurement import robust
from armscope.physics.model import FittedModel
from armscope.physics.set_ups import SetUps, in_order_of_time
from armscope.recordings import Recordings


@dataclass(frozen=True, eq=False)
class ComparedBases:
    """What the bases of a table's runs say of its set-ups."""

    set_ups: SetUps  # the runs of each, in order of time
    # per set-up but the first, what one base for it and the one before would leave beyond their own
    apart_mm: tuple[float, ...]


def compare_bases(own: FittedModel, recordings: Recordings) -> ComparedBases:
    """Runs that stand on one base, by what one base leaves beyond what each run's own leaves.

    A run joins the set-up that it agrees with best; what neither's rows determine cannot part them. Of very many runs
    each keeps its own.

    Args:
        own: the arm with its frames fitted to the recordings, a base for every run.
        recordings: the rows.
    """
    runs = in_order_of_time(recordings)
    if not 2 <= len(runs) <= SET_UPS.most_runs:
        return ComparedBases(tuple((run,) for run in runs), (float("nan"),) * (len(runs) - 1))
    points = _Points.of(own, recordings)
    groups: list[list[str]] = []
    for run in runs:
        rows = np.flatnonzero(recordings.run == run)
        misses = [points.miss_mm(np.flatnonzero(np.isin(recordings.run, group)), rows) for group in groups]
        if misses and min(misses) < SET_UPS.settled_mm:
            groups[int(np.argmin(misses))].append(run)
        else:
            groups.append([run])
    rows_of = [np.flatnonzero(np.isin(recordings.run, group)) for group in groups]
    return ComparedBases(
        tuple(tuple(group) for group in groups),
        tuple(points.miss_mm(before, after) for before, after in pairwise(rows_of)),
    )


@dataclass(frozen=True, eq=False)
class _Points:
    """Tool points (N, 3) in base axes as modelled and in the measurement frame as measured, m, and weights (N,)."""

    modelled: Array
    measured: Array
    weight: Array

    @classmethod
    def of(cls, model: FittedModel, recordings: Recordings) -> _Points:
        tool = np.empty((len(recordings), 3))
        # all rows' frames at once would take 4 kB of each
        parts = linearised(recordings).each_part(model, lambda chunks: [(rows, made.tool) for rows, made in chunks])
        for rows, points in itertools.chain.from_iterable(parts):
            tool[rows] = points
        left = model.to_base(recordings.positions, recordings.run) - tool
        return cls(tool, recordings.positions, robust.huber_weights(left, np.ones(len(left)), 0.0))

    def miss_mm(self, some: Indices, others: Indices) -> float:
        """What one base leaves beyond two, RMS distance of the rows of that part that it leaves more of, mm."""
        together = self._squares(np.concatenate([some, others]))
        more = [self._mean(together[: len(some)], some) - self._mean(self._squares(some), some)]
        more += [self._mean(together[len(some) :], others) - self._mean(self._squares(others), others)]
        return 1e3 * float(np.sqrt(max(*more, 0.0)))

    def _mean(self, squares: Array, rows: Indices) -> float:
        return float(np.average(squares, weights=self.weight[rows]))

    def _squares(self, rows: Indices) -> Array:
        """(n,) squared distances that the best base for some rows leaves, m^2."""
        weight, here, there = self.weight[rows], self.modelled[rows], self.measured[rows]
        here, there = (each - np.average(each, axis=0, weights=weight) for each in (here, there))
        turn = nearest_rotation((there * weight[:, None]).T @ here)
        return np.asarray(np.sum((there - here @ turn.T) ** 2, axis=1))


def set_up_anew(compared: ComparedBases) -> str:
    """What was set up anew, in words; empty where all runs stand on one base."""
    if np.isnan(compared.apart_mm).any():
        return ""
    parts = [
        f"one base for {_names(before)} and {_names(after)} misses their points by {apart:.3g} mm more"
        for (before, after), apart in zip(pairwise(compared.set_ups), compared.apart_mm, strict=True)
    ]
    if not parts:
        return ""
    return f"The arm or the instrument was set up anew: {'; '.join(parts)} than one for each."


def _names(runs: Sequence[str]) -> str:
    return f"run {runs[0]}" if len(runs) == 1 else f"runs {', '.join(runs)}"
