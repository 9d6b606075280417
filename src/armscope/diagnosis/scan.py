"""Numbers that are found by scanning: periods per turn of a gear mesh, the time of a jump of base or tool."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from armscope.diagnosis.evidence import Hypothesis, Problem
from armscope.diagnosis.extra import Blocks, conditioned, weigh_blocks
from armscope.diagnosis.problem import chunks, columns, pool_values
from armscope.diagnosis.weights import RowWeights
from armscope.physics.drift import BASE_SHIFT, base_shift, row_number, tool_shift
from armscope.physics.effect import Placed
from armscope.physics.model import FittedModel
from armscope.physics.placing import moving_joints
from armscope.physics.transmission import MESH_COUNTS, mesh
from armscope.recordings import Recordings

Array = NDArray[np.float64]

SCANNED_ROWS = 4000
"""A scan looks at this many rows at most, spread evenly."""
LINES_KEPT = 2
"""Mesh counts per joint that go on to compete."""
SHORTEST_PIECE = 8
"""Rows on either side of a jump."""
MOST_TIMES = 600
WORTH_A_LOOK = 8.0
"""Nats that a scanned number must promise before its price to go on to compete."""


def mesh_lines(
    problem: Problem, given: Sequence[Hypothesis], model: FittedModel, recordings: Recordings, weights: RowWeights
) -> Iterator[Placed]:
    """The most promising mesh counts of each joint, given each of some hypotheses."""
    rows = _spread(len(recordings))
    table = recordings.rows(rows)
    joints = moving_joints(recordings)
    if not joints:
        return
    placed = [mesh(j, count) for j in joints for count in MESH_COUNTS]
    share = len(rows) / len(recordings)
    columns = _all_columns(given)
    sums = weigh_blocks([p.terms for p in placed], problem.pool, columns, model, table, weights.take(rows, share))
    before = np.einsum("mcc->mc", sums.own)
    for hypothesis in given:
        inside = np.isin(columns, hypothesis.columns)
        narrowed = Blocks(sums.own, sums.cross[:, inside], sums.b)
        gain = _gain(problem, hypothesis, *conditioned(narrowed, *_in_si(problem, hypothesis)), before)
        for number, row in enumerate(gain.reshape(len(joints), -1)):
            for at in np.argsort(-row)[:LINES_KEPT]:
                if row[at] > WORTH_A_LOOK:
                    yield placed[number * len(MESH_COUNTS) + at]


def _all_columns(given: Sequence[Hypothesis]) -> NDArray[np.intp]:
    return np.unique(np.concatenate([hypothesis.columns for hypothesis in given]))


def _spread(count: int) -> NDArray[np.intp]:
    return np.unique(np.linspace(0, count - 1, min(count, SCANNED_ROWS)).astype(np.intp))


def _in_si(problem: Problem, hypothesis: Hypothesis) -> tuple[Array, Array]:
    """The hypothesis' Cholesky factor for columns in mm per SI unit, and factor^-1 b."""
    at = hypothesis.columns
    half = hypothesis.inverse @ problem.gram.b[at]
    return hypothesis.factor * problem.scale[at][:, None], half


def _gain(problem: Problem, hypothesis: Hypothesis, own: Array, b: Array, before: Array) -> Array:
    """(m,) nats that each block promises at the best size; its price is not taken off."""
    scale = np.sqrt(np.maximum(before, 1e-300) / problem.n)
    D = own / (scale[:, :, None] * scale[:, None, :]) / hypothesis.noise**2
    r = b / scale / hypothesis.noise**2
    values, vectors = np.linalg.eigh(D)
    values = np.maximum(values, 0)
    u2 = np.einsum("mij,mi->mj", vectors, r) ** 2
    s2 = problem.sizes[:, None, None] ** 2
    gain = 0.5 * np.sum(u2 * s2 / (1 + s2 * values) - np.log1p(s2 * values), axis=2)
    return np.asarray(gain.max(axis=0))


def jumps(
    problem: Problem, given: Sequence[Hypothesis], model: FittedModel, recordings: Recordings, weights: RowWeights
) -> Iterator[Placed]:
    """The most promising moment at which the base, or the tool, jumped, given each of some hypotheses."""
    pieces = list(_pieces(recordings))
    tried = sum(len(cuts) for _, cuts in pieces)
    for build in (base_shift, tool_shift):
        best: list[tuple[float, Placed] | None] = [None] * len(given)
        for rows, cuts in pieces:
            sums = _step_sums(problem, _all_columns(given), model, recordings, weights, rows, cuts, build)
            before = np.einsum("mcc->mc", sums.own)
            for number, hypothesis in enumerate(given):
                inside = np.isin(_all_columns(given), hypothesis.columns)
                narrowed = Blocks(sums.own, sums.cross[:, inside], sums.b)
                gain = _gain(problem, hypothesis, *conditioned(narrowed, *_in_si(problem, hypothesis)), before)
                at = int(np.argmax(gain))
                promising = float(gain[at]), build(recordings, int(rows[cuts[at]]), tried)
                best[number] = max((b for b in (best[number], promising) if b), key=lambda entry: entry[0])
        for found in best:
            if found is not None and found[0] > WORTH_A_LOOK + np.log(tried):
                yield found[1]


def when_stderr(
    placed: Placed,
    problem: Problem,
    without: Hypothesis,
    model: FittedModel,
    recordings: Recordings,
    weights: RowWeights,
) -> float:
    """Standard error of a jump's row, or time (s): its spread over all moments, each as likely as its evidence says.

    Args:
        placed: a shift of base or tool within a run.
        without: the hypothesis without it.
    """
    build, run = (base_shift if placed.effect is BASE_SHIFT else tool_shift), placed.terms[0].products[0].driver
    for rows, cuts in _pieces(recordings):
        if str(recordings.run[rows[0]]) != run.arguments[1]:
            continue
        sums = _step_sums(problem, without.columns, model, recordings, weights, rows, cuts, build)
        before = np.einsum("mcc->mc", sums.own)
        gain = _gain(problem, without, *conditioned(sums, *_in_si(problem, without)), before)
        likely = np.exp(gain - gain.max())
        at = rows[cuts]
        moment = recordings.time[at] if recordings.time is not None else [row_number(recordings, int(r)) for r in at]
        moments = np.asarray(moment, dtype=np.float64)
        mean = float(np.average(moments, weights=likely))
        spacing = float(np.median(np.diff(moments))) if len(moments) > 1 else 0.0
        # between two rows it may have been at any moment
        return float(np.sqrt(np.average((moments - mean) ** 2, weights=likely) + spacing**2 / 12))
    return 0.0


def _pieces(recordings: Recordings) -> Iterator[tuple[NDArray[np.intp], NDArray[np.intp]]]:
    """Per run: its rows in order of time, and the positions in that order before which a jump may lie."""
    for run in np.unique(recordings.run):
        rows = np.flatnonzero(recordings.run == run)
        if recordings.time is not None:
            if np.isnan(recordings.time[rows]).any():
                continue
            rows = rows[np.argsort(recordings.time[rows], kind="stable")]
        if len(rows) >= 2 * SHORTEST_PIECE:
            count = min(len(rows) - 2 * SHORTEST_PIECE + 1, MOST_TIMES)
            yield rows, np.unique(np.linspace(SHORTEST_PIECE, len(rows) - SHORTEST_PIECE, count).astype(np.intp))


def _step_sums(
    problem: Problem,
    inside: NDArray[np.intp],
    model: FittedModel,
    recordings: Recordings,
    weights: RowWeights,
    rows: NDArray[np.intp],
    cuts: NDArray[np.intp],
    build: Callable[[Recordings, int, int], Placed],
) -> Blocks:
    """Sums over the rows behind each cut."""
    pool = problem.pool
    table = recordings.rows(rows)
    terms = build(recordings, int(rows[0]), 1).terms
    c, k = len(terms), len(inside)
    model_terms = [pool.terms[i] for i in inside]
    values = pool_values(pool, model)
    active = np.flatnonzero(values)
    present = [pool.terms[i] for i in active]
    segment = np.searchsorted(cuts, np.arange(len(rows)), side="right")
    own, cross, b = np.zeros((len(cuts) + 1, c, c)), np.zeros((len(cuts) + 1, k, c)), np.zeros((len(cuts) + 1, c))
    for part, posture in chunks(model, table):
        here = rows[part]
        seen = posture.through(weights.lens(here))
        y = weights.times(here, (model.to_base(table.positions[part], table.run[part]) - posture.tool) * 1e3)
        if present:
            # the response before any effect
            y = y + (columns(seen, present) @ values[active]).reshape(-1, 3)
        X, E = (columns(seen, wanted).reshape(len(part), 3, -1) for wanted in (model_terms, terms))
        np.add.at(own, segment[part], np.einsum("nic,nid->ncd", E, E))
        np.add.at(cross, segment[part], np.einsum("nik,nic->nkc", X, E, optimize=True))
        np.add.at(b, segment[part], np.einsum("ni,nic->nc", y, E))
    own, cross, b = (np.cumsum(x[::-1], axis=0)[::-1][1:] for x in (own, cross, b))
    return Blocks(own, cross, b)
