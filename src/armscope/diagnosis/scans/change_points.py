"""Moments at which base or tool jumped, found by scanning along the rows of a run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

import numpy as np

from armscope.core.types import Indices
from armscope.diagnosis.scans.constants import SCANS
from armscope.diagnosis.scans.context import ScanContext, columns_of, scores_given
from armscope.fitting.column_blocks import active_effects
from armscope.fitting.design_matrix import columns
from armscope.fitting.linearisation import linearised
from armscope.inference.additions import block_scores
from armscope.inference.evidence import Hypothesis
from armscope.inference.linear_algebra import ColumnBlocks
from armscope.measurement.whitening import WhitenedPosture
from armscope.physics.drift import base_shift, tool_shift
from armscope.physics.effect import Placed
from armscope.recordings import Recordings

BUILDS = {"base": base_shift, "tool": tool_shift}


def jumps(context: ScanContext, given: Sequence[Hypothesis]) -> Iterator[Placed]:
    """The most promising moment at which the base, or the tool, jumped, given each of some hypotheses."""
    recordings = context.recordings
    pieces = list(pieces_of(recordings))
    tried, inside = sum(len(cuts) for _, cuts in pieces), columns_of(given)
    for location, build in BUILDS.items():
        best: list[tuple[float, Placed] | None] = [None] * len(given)
        for rows, cuts in pieces:
            _, later = context.runs_around(location, str(recordings.run[rows[0]]))
            sums = step_sums(context, inside, rows, cuts, partial(build, later=later))
            for number, hypothesis in enumerate(given):
                scores = scores_given(context.problem, hypothesis, sums, inside)
                at = int(np.argmax(scores))
                promising = float(scores[at]), build(recordings, int(rows[cuts[at]]), tried, later)
                best[number] = max((b for b in (best[number], promising) if b), key=lambda entry: entry[0])
        for found in best:
            if found is not None and found[0] > SCANS.worth_a_look + np.log(tried):
                yield found[1]


def when_stderr(placed: Placed, context: ScanContext, without: Hypothesis) -> float:
    """Standard error of a jump's row, or time (s): its spread over all moments, each as likely as its evidence says.

    Args:
        placed: a shift of base or tool within a run.
        context: the rows.
        without: the hypothesis without it.

    Returns:
        Rows, or s where times are recorded.
    """
    _, run, *later = placed.terms[0].products[0].driver.arguments
    build = partial(BUILDS[placed.location], later=tuple(str(each) for each in later))
    recordings = context.recordings
    for rows, cuts in pieces_of(recordings):
        if str(recordings.run[rows[0]]) != run:
            continue
        sums = step_sums(context, without.columns, rows, cuts, build)
        scores = block_scores(context.problem, without, sums)
        likely = np.exp(scores - scores.max())
        at = rows[cuts]
        moment = recordings.time[at] if recordings.time is not None else recordings.number[at]
        moments = np.asarray(moment, dtype=np.float64)
        mean = float(np.average(moments, weights=likely))
        spacing = float(np.median(np.diff(moments))) if len(moments) > 1 else 0.0
        # between two rows it may have been at any moment
        return float(np.sqrt(np.average((moments - mean) ** 2, weights=likely) + spacing**2 / 12))
    return 0.0


def pieces_of(recordings: Recordings) -> Iterator[tuple[Indices, Indices]]:
    """Per run: its rows in order of time, and the positions in that order before which a jump may lie."""
    for run in np.unique(recordings.run):
        rows = np.flatnonzero(recordings.run == run)
        if recordings.time is not None:
            if np.isnan(recordings.time[rows]).any():
                continue
            rows = rows[np.argsort(recordings.time[rows], kind="stable")]
        if len(rows) >= 2 * SCANS.shortest_piece:
            count = min(len(rows) - 2 * SCANS.shortest_piece + 1, SCANS.most_times)
            yield (
                rows,
                np.unique(np.linspace(SCANS.shortest_piece, len(rows) - SCANS.shortest_piece, count).astype(np.intp)),
            )


def step_sums(
    context: ScanContext, inside: Indices, rows: Indices, cuts: Indices, build: Callable[[Recordings, int, int], Placed]
) -> ColumnBlocks:
    """Sums over the rows behind each cut, and over those of the later runs in which the step holds.

    Args:
        context: the rows.
        inside: columns of the model against which the steps' are multiplied.
        rows: of a run, in order.
        cuts: positions in that order.
        build: the step.

    Returns:
        One block per cut.
    """
    terms = build(context.recordings, int(rows[0]), 1).terms
    _, _, *later = terms[0].products[0].driver.arguments
    rows = np.concatenate([rows, np.flatnonzero(np.isin(context.recordings.run, [str(each) for each in later]))])
    c, k = len(terms), len(inside)
    model_terms = [context.space.layout.terms[i] for i in inside]
    values, active, present = active_effects(context.space.layout, context.model)
    segment = np.searchsorted(cuts, np.arange(len(rows)), side="right")
    own, cross, b = np.zeros((len(cuts) + 1, c, c)), np.zeros((len(cuts) + 1, k, c)), np.zeros((len(cuts) + 1, c))
    for part, posture in linearised(context.recordings.rows(rows)).chunks(context.model):
        whitener = context.weights.whitener(rows[part])
        seen, y = WhitenedPosture(posture, whitener), whitener.response(context.model, posture)
        if present:
            # the response before any effect
            y = y + (columns(seen, present) @ values[active]).reshape(y.shape)
        X, E = (columns(seen, wanted).reshape(*y.shape, -1) for wanted in (model_terms, terms))
        starts = np.flatnonzero(np.diff(segment[part], prepend=-1))
        for total, products in (
            (own, np.swapaxes(E, 1, 2) @ E),
            (cross, np.swapaxes(X, 1, 2) @ E),
            (b, np.einsum("ni,nic->nc", y, E)),
        ):
            total[segment[part][starts]] += np.add.reduceat(products, starts, axis=0)
    own, cross, b = (np.cumsum(x[::-1], axis=0)[::-1][1:] for x in (own, cross, b))
    return ColumnBlocks(own, cross, b)
