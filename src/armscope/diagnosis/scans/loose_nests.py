"""Which way a target has play on the tool, found by scanning: no nest need lie along the tool's axes."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence

import numpy as np

from armscope.diagnosis.scans.constants import SCANS
from armscope.diagnosis.scans.context import ScanContext, few_rows, scanned_rows
from armscope.fitting.column_blocks import ModelColumns, TermBlocks
from armscope.inference.additions import block_scores
from armscope.inference.evidence import Hypothesis
from armscope.inference.problem import Problem
from armscope.physics.effect import Placed
from armscope.physics.form_constants import FORM
from armscope.physics.loose_target import LOOSE_TARGET, nests_about, nests_anyhow


def loose_nests(context: ScanContext, given: Sequence[Hypothesis]) -> Iterator[Placed]:
    """The most promising nest of either way, given each of some hypotheses.

    Args:
        context: the rows where the problem was linearised.
        given: hypotheses beside which a nest would stand; none has one.

    Returns:
        Nests that promise enough to go on to compete; none where nests along the tool's axes do not.
    """
    if not any(placed.effect is LOOSE_TARGET for placed in context.space.placed):
        return
    for hypothesis in given:
        beside = _beside(context, hypothesis)
        for nests in nests_anyhow().values():
            found, promised = _best(context.problem, hypothesis, beside, nests, _blocks(nests))
            for tilt in (FORM.nest_step_deg / part for part in (2, 4, 10)):
                about = nests_about(found, tilt)
                blocks = TermBlocks.of([each.terms for each in about])
                found, promised = _best(context.problem, hypothesis, beside, about, blocks)
            if promised > SCANS.worth_a_look:
                yield found


def _beside(context: ScanContext, hypothesis: Hypothesis) -> ModelColumns:
    """What all nests are multiplied with."""
    count = len(context.recordings)
    rows = scanned_rows(count)
    table = context.few or few_rows(context.recordings)
    weights = context.weights.take(rows, len(rows) / count)
    return ModelColumns(context.space.layout, hypothesis.columns, context.model, table, weights).kept()


def _best(
    problem: Problem, hypothesis: Hypothesis, beside: ModelColumns, nests: Sequence[Placed], blocks: TermBlocks
) -> tuple[Placed, float]:
    """The most promising of some nests, and how many nats it promises."""
    (sums,) = beside.sums([blocks])
    scores = block_scores(problem, hypothesis, sums)
    return nests[int(np.argmax(scores))], float(scores.max())


@functools.lru_cache(maxsize=2)
def _blocks(nests: tuple[Placed, ...]) -> TermBlocks:
    """The same at every scan, as is their order."""
    return TermBlocks.of([placed.terms for placed in nests])
