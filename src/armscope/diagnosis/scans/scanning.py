"""Numbers that are found by scanning: periods per turn of a gear mesh, the time of a jump of base or tool."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.fitting.column_blocks import ColumnBlocks, schur_complement, weigh_blocks
from armscope.fitting.design_matrix import columns
from armscope.fitting.linearisation import chunks, current_parameters, response
from armscope.inference.evidence import Hypothesis, Problem, solve_lower
from armscope.measurement.row_weights import RowWeights
from armscope.physics.drift import BASE_SHIFT, Pause, base_shift, drift_with_pauses, pauses_of, row_number, tool_shift
from armscope.physics.effect import Placed
from armscope.physics.model import FittedModel
from armscope.physics.placing import moving_joints
from armscope.physics.transmission import MESH_COUNTS, mesh
from armscope.recordings import Recordings

SCANNED_ROWS = 4000
"""A scan looks at this many rows at most, spread evenly."""
LINES_KEPT = 2
"""Mesh counts per joint that go on to compete."""
SHORTEST_PIECE = 8
"""Rows on either side of a jump."""
MOST_TIMES = 600
LENGTHS_OF_PAUSES = 20
"""How many lengths of a pause compete at each row: one number's price, 3 nats."""
MOST_PAUSES = 4
WORTH_SETTING_RIGHT = 1.0
"""Nats that better lengths of known pauses must promise."""
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
        narrowed = ColumnBlocks(sums.own, sums.cross[:, inside], sums.b)
        gain = _gain(problem, hypothesis, *schur_complement(narrowed, *_in_si(problem, hypothesis)), before)
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
    whitened_rhs = hypothesis.inverse @ problem.equations.b[at]
    return hypothesis.cholesky * problem.scale[at][:, None], whitened_rhs


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
                narrowed = ColumnBlocks(sums.own, sums.cross[:, inside], sums.b)
                gain = _gain(problem, hypothesis, *schur_complement(narrowed, *_in_si(problem, hypothesis)), before)
                at = int(np.argmax(gain))
                promising = float(gain[at]), build(recordings, int(rows[cuts[at]]), tried)
                best[number] = max((b for b in (best[number], promising) if b), key=lambda entry: entry[0])
        for found in best:
            if found is not None and found[0] > WORTH_A_LOOK + np.log(tried):
                yield found[1]


def pauses(
    problem: Problem,
    drifting: Hypothesis,
    drift: int,
    model: FittedModel,
    recordings: Recordings,
    weights: RowWeights,
) -> Iterator[Placed]:
    """A drift by the order of rows with one, two, ... pauses, where nobody recorded when rows were measured.

    In a pause the base moves on the way that it moves all the time: one number, where a jump has six. It never moves
    back.

    Args:
        drifting: a hypothesis with the drift, without what pauses may stand for.
        drift: the drift's number among the candidates.
    """
    placed, at = problem.pool.candidates[drift], problem.pool.columns[drift]
    way = drifting.mean[np.searchsorted(drifting.columns, at)] / problem.scale[at]
    known = pauses_of(placed)
    passed = _rows_passed(recordings, known)
    pieces = list(_pieces(recordings))
    ways_to_pause = LENGTHS_OF_PAUSES * sum(len(cuts) for _, cuts in pieces)
    factor, whitened_rhs = _in_si(problem, drifting)
    for rows, cuts in pieces:
        sums = _step_sums(problem, drifting.columns, model, recordings, weights, rows, cuts, base_shift)
        V = solve_lower(factor, (sums.cross @ way).T)
        alone = np.einsum("mij,i,j->m", sums.own, way, way)
        # two steps have the rows behind the later one in common
        own = alone[np.maximum.outer(np.arange(len(cuts)), np.arange(len(cuts)))] - V.T @ V
        line = passed[rows] - passed[rows].mean()
        run, pull = str(recordings.run[rows[0]]), sums.b @ way - V.T @ whitened_rhs
        before = [(run, row_number(recordings, int(row))) for row in rows[cuts]]
        fitted = [before.index((p.run, p.row)) for p in known if (p.run, p.row) in before]
        for chosen, length in _steps(own, pull, drifting, fitted, np.log(ways_to_pause)):
            # the drift has taken its share of every step: as large as a line's share of it
            taken = sum(
                a * float(line[cut:].sum() / (line @ line)) for a, cut in zip(length, cuts[chosen], strict=True)
            )
            if taken < 1:
                new = [Pause(before[n][1], run, 1e3 * a / (1 - taken)) for a, n in zip(length, chosen, strict=True)]
                together = _together(known, new)
                if all(p.rows > 0 for p in together):
                    yield drift_with_pauses(together, ways_to_pause ** len(together))


def _steps(
    own: Array, pull: Array, given: Hypothesis, fitted: Sequence[int], price: float
) -> Iterator[tuple[list[int], Array]]:
    """Steps and their sizes, one more each time: that which explains most beside the others, if it promises enough.

    Args:
        own: (m, m) products of the steps once the hypothesis is conditioned on.
        pull: (m,) their products with what is left to explain.
        fitted: steps that the hypothesis has already; their sizes are set right first.
        price: nats of one step more.
    """
    chosen, size = list(fitted), _sizes(own, pull, fitted)
    if len(chosen) and 0.5 * size @ pull[chosen] / given.noise**2 > WORTH_SETTING_RIGHT:
        yield list(chosen), size
    while len(chosen) < MOST_PAUSES:
        left, inside = pull - own[:, chosen] @ size, own[np.ix_(chosen, chosen)]
        beside = np.diag(own) - np.einsum("mi,im->m", own[:, chosen], np.linalg.pinv(inside) @ own[chosen])
        seen = beside > 1e-6 * np.diag(own)
        gain = np.where(seen & (left > 0), 0.5 * left**2 / np.where(seen, beside, 1.0) / given.noise**2, 0.0)
        best = int(np.argmax(gain))
        if gain[best] < WORTH_A_LOOK + price:
            return
        chosen.append(best)
        size = _sizes(own, pull, chosen)
        if np.any(size[len(fitted) :] <= 0):
            return
        yield list(chosen), size


def _sizes(own: Array, pull: Array, chosen: Sequence[int]) -> Array:
    """Sizes of steps that explain most together."""
    return np.asarray(np.linalg.solve(own[np.ix_(chosen, chosen)], pull[list(chosen)]), dtype=np.float64)


def _together(known: Sequence[Pause], new: Sequence[Pause]) -> list[Pause]:
    """All pauses in order; those before one row are one."""
    rows: dict[tuple[str, float], float] = {}
    for each in (*known, *new):
        rows[each.run, each.row] = rows.get((each.run, each.row), 0.0) + each.rows
    return [Pause(row, run, length) for (run, row), length in sorted(rows.items())]


def _rows_passed(recordings: Recordings, known: Sequence[Pause]) -> Array:
    """(N,) thousands of rows, pauses included."""
    number = np.array([row_number(recordings, row) for row in range(len(recordings))])
    passed = number / 1e3
    for p in known:
        passed = passed + p.rows / 1e3 * ((number >= p.row) & (recordings.run == p.run))
    return passed


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
        gain = _gain(problem, without, *schur_complement(sums, *_in_si(problem, without)), before)
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
) -> ColumnBlocks:
    """Sums over the rows behind each cut."""
    pool = problem.pool
    table = recordings.rows(rows)
    terms = build(recordings, int(rows[0]), 1).terms
    c, k = len(terms), len(inside)
    model_terms = [pool.terms[i] for i in inside]
    values = current_parameters(pool, model)
    active = np.flatnonzero(values)
    present = [pool.terms[i] for i in active]
    segment = np.searchsorted(cuts, np.arange(len(rows)), side="right")
    own, cross, b = np.zeros((len(cuts) + 1, c, c)), np.zeros((len(cuts) + 1, k, c)), np.zeros((len(cuts) + 1, c))
    for part, posture in chunks(model, table):
        here = rows[part]
        lens = weights.lens(here)
        seen, y = posture.through(lens), response(model, posture, lens)
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
