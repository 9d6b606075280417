"""Which way a target has play on the tool, found by scanning: no nest need lie along the tool's axes."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence

import numpy as np

from armscope.diagnosis.scans.constants import SCANS
from armscope.diagnosis.scans.context import ScanContext, columns_of, few_rows, scanned_rows, scores_given
from armscope.fitting.column_blocks import TermBlocks, column_blocks
from armscope.inference.evidence import Hypothesis
from armscope.physics.effect import Placed
from armscope.physics.loose_target import LOOSE_TARGET, finer_nests, nests_anyhow


def loose_nests(context: ScanContext, given: Sequence[Hypothesis]) -> Iterator[Placed]:
    """The most promising nests given each of some hypotheses, and finer directions about one that is chosen.

    Args:
        context: the rows where the problem was linearised.
        given: hypotheses beside which a nest would stand.

    Returns:
        Nests that promise enough to go on to compete; none where nests along the tool's axes do not.
    """
    if not any(placed.effect is LOOSE_TARGET for placed in context.space.placed):
        return
    count = len(context.recordings)
    rows = scanned_rows(count)
    columns, weights = columns_of(given), context.weights.take(rows, len(rows) / count)
    table = context.few or few_rows(context.recordings)
    sums = column_blocks(_blocks(), context.space.layout, columns, context.model, table, weights)
    for nests, of_way in zip(nests_anyhow().values(), sums, strict=True):
        for hypothesis in given:
            scores = scores_given(context.problem, hypothesis, of_way, columns)
            best = int(np.argmax(scores))
            if scores[best] > SCANS.worth_a_look:
                yield nests[best]
    for number in sorted({n for hypothesis in given for n in hypothesis.candidates}):
        yield from finer_nests(context.space.placed[number])


@functools.cache
def _blocks() -> list[TermBlocks]:
    """By way, the same at every scan, as is their order."""
    return [TermBlocks.of([placed.terms for placed in nests]) for nests in nests_anyhow().values()]
