"""Links and joints that turn with the angle of a joint before them, found by scanning what is left."""

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
from armscope.physics.unexplained_turn import bowing_links, led_joints


def turns_with_other_joints(context: ScanContext, given: Sequence[Hypothesis]) -> Iterator[Placed]:
    """The most promising link, and joint, that follows a joint before it, given each of some hypotheses.

    Args:
        context: the rows where the problem was linearised.
        given: hypotheses beside which it would stand.

    Returns:
        What promises enough to go on to compete.
    """
    groups = _groups(tuple(moving_joints(context.recordings)), context.model.arm.n_joints)
    if not groups:
        return
    count = len(context.recordings)
    rows = scanned_rows(count)
    columns, weights = columns_of(given), context.weights.take(rows, len(rows) / count)
    table = context.few or few_rows(context.recordings)
    every = ModelColumns(context.space.layout, columns, context.model, table, weights).sums([b for _, b in groups])
    for (placed, _), sums in zip(groups, every, strict=True):
        for hypothesis in given:
            scores = scores_given(context.problem, hypothesis, sums, columns)
            best = int(np.argmax(scores))
            if scores[best] > SCANS.worth_a_look + np.log(placed[best].multiplicity):
                yield placed[best]


@functools.lru_cache(maxsize=16)
def _groups(moving: tuple[int, ...], links: int) -> list[tuple[list[Placed], TermBlocks]]:
    """What is tried, by how many columns each has: the same at every scan, as is their order."""
    both = [placed for placed in (bowing_links(moving, links), led_joints(moving)) if placed]
    return [(placed, TermBlocks.of([each.terms for each in placed])) for placed in both]
