"""Moments at which base, tool, a joint's zero or what its drive gives way by changed, found by scanning along a run."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array, Indices
from armscope.diagnosis.scans.constants import SCANS
from armscope.diagnosis.scans.context import ScanContext, columns_of, scores_given
from armscope.fitting.column_blocks import active_effects
from armscope.fitting.design_matrix import columns
from armscope.fitting.linearisation import linearised
from armscope.inference.additions import block_scores
from armscope.inference.evidence import Hypothesis
from armscope.inference.linear_algebra import ColumnBlocks
from armscope.measurement.whitening import WhitenedPosture
from armscope.physics.compliance_change import COMPLIANCE_CHANGE, compliance_change, plausible_change
from armscope.physics.drift import BASE_SHIFT, TOOL_SHIFT, base_shift, tool_shift
from armscope.physics.effect import Driver, Placed, Term
from armscope.physics.elastic import loaded_joints
from armscope.physics.placing import moving_joints
from armscope.physics.zero_shift import ZERO_SHIFT, zero_shift
from armscope.recordings import Recordings

SET_UP = {"base": base_shift, "tool": tool_shift}
At = tuple[str, str]
"""Effect and location of what may have jumped."""


def jumps(context: ScanContext, given: Sequence[Hypothesis]) -> Iterator[Placed]:
    """The likeliest moment at which anything of `may_jump` did, if promising, given each hypothesis."""
    beside = ModelRows(context, columns_of(given))
    for places in may_jump(context):
        yield from _jumps_at(beside, given, places)


def may_jump(context: ScanContext) -> list[list[At]]:
    """What may have jumped; of a list's places any one may have."""
    table, arm = context.recordings, context.model.arm
    known = arm.has_masses or table.torque is not None
    loaded = loaded_joints(context.scene) if known else []
    return [
        [(BASE_SHIFT.name, "base")],
        [(TOOL_SHIFT.name, "tool")],
        [(ZERO_SHIFT.name, f"joint {j}") for j in moving_joints(table)],
        [(COMPLIANCE_CHANGE.name, f"joint {j}") for j in loaded],
    ]


def _jumps_at(beside: ModelRows, given: Sequence[Hypothesis], locations: Sequence[At]) -> Iterator[Placed]:
    """The same at some places, any of which may have jumped: all pay for all of their moments."""
    context, inside = beside.context, beside.inside
    pieces = list(pieces_of(context.recordings, SCANS.nearest_edge))
    if not locations:
        return
    tried = len(locations) * sum(len(cuts) for _, cuts in pieces)
    builds = {location: _jump_of(context, location) for location in locations}
    best: dict[tuple[At, int], tuple[float, int]] = {}
    for rows, cuts in pieces:
        terms = {location: build(int(rows[0]), 1).terms for location, build in builds.items()}
        sums = step_sums(beside, rows, cuts, [each for of_one in terms.values() for each in of_one])
        told = (cuts >= SCANS.shortest_piece) & (cuts <= len(rows) - SCANS.shortest_piece)
        start = 0
        for location in locations:
            own = slice(start, start := start + len(terms[location]))
            block = ColumnBlocks(sums.own[:, own, own], sums.cross[:, :, own], sums.b[:, own])
            for number, hypothesis in enumerate(given):
                scores = scores_given(context.problem, hypothesis, block, inside)
                # a jump must show far from either end; then it may have been nearer to one
                promising = float(scores[told].max()), int(rows[cuts[np.argmax(scores)]])
                best[location, number] = max(best.get((location, number), promising), promising)
    for (location, _), (score, row) in best.items():
        if score > SCANS.worth_a_look + np.log(tried):
            yield builds[location](row, tried)


def _jump_of(context: ScanContext, at: At) -> Callable[[int, int], Placed]:
    """What jumps at a place before a row, by the row and by how many moments compete."""
    recordings, (effect, location) = context.recordings, at
    j = Location.of(location).number
    if effect == ZERO_SHIFT.name:
        return lambda row, tried: zero_shift(recordings, row, tried, j)
    if effect == COMPLIANCE_CHANGE.name:
        size = plausible_change(context.scene, j)
        return lambda row, tried: compliance_change(recordings, row, tried, j, size)

    def build(row: int, tried: int) -> Placed:
        _, later = context.runs_around(location, str(recordings.run[row]))
        return SET_UP[location](recordings, row, tried, later)

    return build


def when_stderr(placed: Placed, context: ScanContext, without: Hypothesis) -> float:
    """Standard error of a jump's row, or time (s): its spread over all moments, each as likely as its evidence says.

    Args:
        placed: a jump within a run.
        context: the rows.
        without: the hypothesis without it.

    Returns:
        Rows, or s where times are recorded.
    """
    run = moment_of(placed.terms).arguments[1]
    build, recordings = _jump_of(context, placed.key), context.recordings
    for rows, cuts in pieces_of(recordings, SCANS.nearest_edge):
        if str(recordings.run[rows[0]]) != run:
            continue
        sums = step_sums(ModelRows(context, without.columns), rows, cuts, build(int(rows[0]), 1).terms)
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


def pieces_of(recordings: Recordings, edge: int = SCANS.shortest_piece) -> Iterator[tuple[Indices, Indices]]:
    """Per run: its rows in order of time, and the positions in that order before which a jump may lie, off its ends."""
    for run in np.unique(recordings.run):
        rows = np.flatnonzero(recordings.run == run)
        if recordings.time is not None:
            if np.isnan(recordings.time[rows]).any():
                continue
            rows = rows[np.argsort(recordings.time[rows], kind="stable")]
        if len(rows) >= 2 * SCANS.shortest_piece:
            count = min(len(rows) - 2 * edge + 1, SCANS.most_times)
            yield rows, np.unique(np.linspace(edge, len(rows) - edge, count).astype(np.intp))


class ModelRows:
    """What steps are multiplied with: some of the model's columns, and the response.

    It is computed once for all that may have jumped in the same rows.

    Args:
        context: the rows.
        inside: (k,) the columns.
    """

    def __init__(self, context: ScanContext, inside: Indices) -> None:
        self.context, self.inside = context, inside
        self._known: dict[bytes, list[tuple[Indices, WhitenedPosture, Array, Array]]] = {}

    def on(self, rows: Indices) -> list[tuple[Indices, WhitenedPosture, Array, Array]]:
        """Chunk by chunk: which of the rows, how all channels see them, response (n, c) and columns (n, c, k)."""
        if rows.tobytes() not in self._known:
            self._known[rows.tobytes()] = list(self._made(rows))
        return self._known[rows.tobytes()]

    def _made(self, rows: Indices) -> Iterator[tuple[Indices, WhitenedPosture, Array, Array]]:
        context, layout = self.context, self.context.space.layout
        terms = [layout.terms[i] for i in self.inside]
        values, active, present = active_effects(layout, context.model)
        for part, posture in linearised(context.recordings.rows(rows)).chunks(context.model):
            whitener = context.weights.whitener(rows[part])
            seen, y = WhitenedPosture(posture, whitener), whitener.response(context.model, posture)
            if present:
                # the response before any effect
                y = y + (columns(seen, present) @ values[active]).reshape(y.shape)
            yield part, seen, y, columns(seen, terms).reshape(*y.shape, -1)


def moment_of(terms: Sequence[Term]) -> Driver:
    """From when on a step holds: what it follows, or what its load is multiplied with."""
    driver = terms[0].products[0].driver
    held = driver.arguments[-1] if driver.kind == "both" else driver
    assert isinstance(held, Driver)
    return held


def step_sums(beside: ModelRows, rows: Indices, cuts: Indices, terms: Sequence[Term]) -> ColumnBlocks:
    """Sums over the rows behind each cut, and over those of the later runs in which the step holds.

    Args:
        beside: the model with whose columns the steps' are multiplied.
        rows: of a run, in order.
        cuts: positions in that order.
        terms: of the step, wherever it begins.

    Returns:
        One block per cut.
    """
    _, _, *later = moment_of(terms).arguments
    run = beside.context.recordings.run
    rows = np.concatenate([rows, np.flatnonzero(np.isin(run, [str(each) for each in later]))])
    c, k = len(terms), len(beside.inside)
    segment = np.searchsorted(cuts, np.arange(len(rows)), side="right")
    own, cross, b = np.zeros((len(cuts) + 1, c, c)), np.zeros((len(cuts) + 1, k, c)), np.zeros((len(cuts) + 1, c))
    for part, seen, y, X in beside.on(rows):
        E = columns(seen, terms).reshape(*y.shape, c)
        starts = np.flatnonzero(np.diff(segment[part], prepend=-1))
        for start, end in itertools.pairwise([*starts, len(part)]):
            at, step = segment[part[start]], E[start:end].reshape(-1, c)
            own[at] += step.T @ step
            cross[at] += X[start:end].reshape(-1, k).T @ step
            b[at] += y[start:end].reshape(-1) @ step
    own, cross, b = (np.cumsum(x[::-1], axis=0)[::-1][1:] for x in (own, cross, b))
    return ColumnBlocks(own, cross, b)
