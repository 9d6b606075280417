"""What a scan looks at: the rows at the point where the problem was linearised."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from armscope.core.sampling import spread_evenly
from armscope.core.types import Array, Indices
from armscope.diagnosis.model_space import EffectSpace
from armscope.diagnosis.scans.constants import SCANS
from armscope.fitting.linearisation import LinearisedTable
from armscope.inference.additions import block_scores
from armscope.inference.evidence import Hypothesis
from armscope.inference.linear_algebra import ColumnBlocks
from armscope.inference.problem import Problem
from armscope.measurement.row_weights import RowWeights
from armscope.physics.frames import runs_of
from armscope.physics.model import FittedModel
from armscope.physics.scene import Scene
from armscope.physics.set_ups import runs_around
from armscope.recordings import Recordings


def scanned_rows(count: int) -> Indices:
    """Numbers of the rows, of so many, on which many waves are tried."""
    return spread_evenly(count, SCANS.scanned_rows)


def few_rows(recordings: Recordings) -> LinearisedTable:
    """The same as a table that keeps what is computed on them."""
    rows = scanned_rows(len(recordings))
    return LinearisedTable(recordings.rows(rows), order=np.arange(len(rows)))


@dataclass(frozen=True, eq=False)
class ScanContext:
    """Rows, and the problem that was made of them."""

    problem: Problem  # the normal equations and priors
    space: EffectSpace  # what their columns are
    model: FittedModel  # where they were taken
    recordings: Recordings  # the rows
    weights: RowWeights  # of the rows
    # rows spread evenly, on which many waves are tried; what the waves are there is kept from scan to scan
    few: LinearisedTable | None = None

    @functools.cached_property
    def scene(self) -> Scene:
        """The nominal arm at the rows."""
        return Scene(self.model.arm, self.recordings)

    def runs_around(self, location: str, run: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """The runs before and after one that share its base, or its tool, so that what moved in one stays so."""
        drivers = [self.space.layout.terms[column].products[0].driver for column in self.space.frames]
        if location == "tool" and any(driver.kind == "on target in run" for driver in drivers):
            return (), ()
        return runs_around(tuple(runs_of(driver) for driver in drivers if driver.kind == "in run"), run)


def columns_of(given: Sequence[Hypothesis]) -> Indices:
    """Columns that take part in any of some hypotheses."""
    return np.unique(np.concatenate([hypothesis.columns for hypothesis in given]))


def scores_given(problem: Problem, hypothesis: Hypothesis, blocks: ColumnBlocks, columns: Indices) -> Array:
    """(m,) nats that blocks promise beside a hypothesis, from sums against ``columns``, which hold its own.

    Args:
        problem: the normal equations and priors.
        hypothesis: beside which they would stand.
        blocks: sums of the blocks with themselves, the columns and the response.
        columns: of the problem, that the blocks' sums are against.

    Returns:
        (m,) nats.
    """
    inside = np.isin(columns, hypothesis.columns)
    return block_scores(problem, hypothesis, ColumnBlocks(blocks.own, blocks.cross[:, inside], blocks.b))
