"""Periods per turn of a gear's mesh, found by scanning."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence

import numpy as np

from armscope.diagnosis.scans.constants import SCANS
from armscope.diagnosis.scans.context import ScanContext, columns_of, few_rows, scanned_rows, scores_given
from armscope.fitting.column_blocks import ModelColumns, TermBlocks
from armscope.inference.evidence import Hypothesis
from armscope.physics.effect import Placed
from armscope.physics.placing import moving_joints
from armscope.physics.transmission import MESH_COUNTS, mesh


def mesh_lines(context: ScanContext, given: Sequence[Hypothesis], most: int = MESH_COUNTS[-1]) -> Iterator[Placed]:
    """The most promising mesh counts of each joint, given each of some hypotheses.

    Args:
        context: the rows where the problem was linearised.
        given: hypotheses beside which a line would stand.
        most: periods per turn up to which are looked at.

    Returns:
        Lines that promise enough to go on to compete.
    """
    count = len(context.recordings)
    rows = scanned_rows(count)
    columns, weights = columns_of(given), context.weights.take(rows, len(rows) / count)
    table = context.few or few_rows(context.recordings)
    lines = [_lines(j, most) for j in moving_joints(context.recordings)]
    terms = [of_joint for _, of_joint in lines]
    every = ModelColumns(context.space.layout, columns, context.model, table, weights).sums(terms)
    for (placed, _), sums in zip(lines, every, strict=True):
        for hypothesis in given:
            scores = scores_given(context.problem, hypothesis, sums, columns)
            for at in np.argsort(-scores)[: SCANS.lines_kept]:
                if scores[at] > SCANS.worth_a_look:
                    yield placed[at]


@functools.lru_cache(maxsize=16)
def _lines(j: int, most: int) -> tuple[tuple[Placed, ...], TermBlocks]:
    """The meshes of motor j up to so many periods per turn: the same at every scan, as is their order."""
    placed = tuple(mesh(j, n) for n in MESH_COUNTS if n <= most)
    return placed, TermBlocks.of([line.terms for line in placed])
