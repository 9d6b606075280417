"""Periods per turn of a gear's mesh, found by scanning."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from armscope.diagnosis.constants import SCANS
from armscope.diagnosis.scans.context import ScanContext, columns_of, scores_given
from armscope.fitting.column_blocks import column_blocks
from armscope.inference.evidence import Hypothesis
from armscope.physics.effect import Placed
from armscope.physics.placing import moving_joints
from armscope.physics.transmission import MESH_COUNTS, mesh


def mesh_lines(context: ScanContext, given: Sequence[Hypothesis]) -> Iterator[Placed]:
    """The most promising mesh counts of each joint, given each of some hypotheses."""
    count = len(context.recordings)
    rows = np.unique(np.linspace(0, count - 1, min(count, SCANS.scanned_rows)).astype(np.intp))
    joints = moving_joints(context.recordings)
    if not joints:
        return
    placed = [mesh(j, count) for j in joints for count in MESH_COUNTS]
    columns, weights = columns_of(given), context.weights.take(rows, len(rows) / count)
    terms, table = [p.terms for p in placed], context.recordings.rows(rows)
    sums = column_blocks(terms, context.space.layout, columns, context.model, table, weights)
    for hypothesis in given:
        scores = scores_given(context.problem, hypothesis, sums, columns)
        for number, row in enumerate(scores.reshape(len(joints), -1)):
            for at in np.argsort(-row)[: SCANS.lines_kept]:
                if row[at] > SCANS.worth_a_look:
                    yield placed[number * len(MESH_COUNTS) + at]
