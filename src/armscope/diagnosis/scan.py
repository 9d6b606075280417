"""Numbers that are found by scanning: periods per turn of a gear mesh, the time of a jump of base or tool."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

from armscope.diagnosis.evidence import Hypothesis, Problem
from armscope.diagnosis.extra import conditioned, weigh_blocks
from armscope.diagnosis.problem import chunks, columns, pool_values
from armscope.physics.drift import base_shift, tool_shift
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
MOST_TIMES = 240
WORTH_A_LOOK = 3.0
"""Nats that a scanned number must promise before its price to go on to compete."""


def mesh_lines(
    problem: Problem, hypothesis: Hypothesis, model: FittedModel, recordings: Recordings, weights: Array
) -> Iterator[Placed]:
    """The most promising mesh counts of each joint, given a hypothesis."""
    rows = _spread(len(recordings))
    table = recordings.rows(rows)
    joints = moving_joints(recordings)
    if not joints:
        return
    placed = [mesh(j, count) for j in joints for count in MESH_COUNTS]
    factor, half = _in_si(problem, hypothesis)
    share = len(rows) / len(recordings)
    blocks = weigh_blocks(
        [p.terms for p in placed], problem.pool, hypothesis.columns, model, table, weights[rows] / share
    )
    gain = _gain(problem, hypothesis, *conditioned(blocks, factor, half), np.einsum("mcc->mc", blocks.own))
    by_joint = gain.reshape(len(joints), -1)
    for number, row in enumerate(by_joint):
        for at in np.argsort(-row)[:LINES_KEPT]:
            if row[at] > WORTH_A_LOOK:
                yield placed[number * len(MESH_COUNTS) + at]


def _spread(count: int) -> NDArray[np.intp]:
    return np.unique(np.linspace(0, count - 1, min(count, SCANNED_ROWS)).astype(np.intp))


def _in_si(problem: Problem, hypothesis: Hypothesis) -> tuple[Array, Array]:
    """The hypothesis' Cholesky factor for columns in mm per SI unit, and factor^-1 b."""
    at = hypothesis.columns
    half = solve_triangular(hypothesis.factor, problem.gram.b[at], lower=True, check_finite=False)
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
    problem: Problem, hypothesis: Hypothesis, model: FittedModel, recordings: Recordings, weights: Array
) -> Iterator[Placed]:
    """The most promising moment at which the base, or the tool, jumped, given a hypothesis."""
    pieces = list(_pieces(recordings))
    if not pieces:
        return
    tried = sum(len(cuts) for _, cuts in pieces)
    for build in (base_shift, tool_shift):
        best: tuple[float, Placed] | None = None
        for rows, cuts in pieces:
            gain = _step_gains(problem, hypothesis, model, recordings, weights, rows, cuts, build)
            at = int(np.argmax(gain))
            if best is None or gain[at] > best[0]:
                best = float(gain[at]), build(recordings, int(rows[cuts[at]]), tried)
        if best is not None and best[0] > WORTH_A_LOOK + np.log(tried):
            yield best[1]


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


def _step_gains(
    problem: Problem,
    hypothesis: Hypothesis,
    model: FittedModel,
    recordings: Recordings,
    weights: Array,
    rows: NDArray[np.intp],
    cuts: NDArray[np.intp],
    build: Callable[[Recordings, int, int], Placed],
) -> Array:
    """Gain of a step before each cut, from sums over the rows behind it."""
    pool, inside = problem.pool, hypothesis.columns
    table = recordings.rows(rows)
    terms = build(recordings, int(rows[0]), 1).terms
    c, k = len(terms), len(inside)
    model_terms = [pool.terms[i] for i in inside]
    current = pool_values(pool, model)[inside]
    segment = np.searchsorted(cuts, np.arange(len(rows)), side="right")
    own, cross, b = np.zeros((len(cuts) + 1, c, c)), np.zeros((len(cuts) + 1, k, c)), np.zeros((len(cuts) + 1, c))
    for part, posture in chunks(model, table):
        n = len(part)
        w = np.repeat(weights[rows[part]], 3)
        X = columns(posture, model_terms)
        y = (model.to_base(table.positions[part], table.run[part]) - posture.tool).reshape(-1) * 1e3 + X @ current
        E = columns(posture, terms)
        wE = (E * w[:, None]).reshape(n, 3, c)
        np.add.at(own, segment[part], np.einsum("nic,nid->ncd", wE, E.reshape(n, 3, c)))
        np.add.at(cross, segment[part], np.einsum("nik,nic->nkc", X.reshape(n, 3, k), wE, optimize=True))
        np.add.at(b, segment[part], np.einsum("ni,nic->nc", y.reshape(n, 3), wE))
    own, cross, b = (np.cumsum(x[::-1], axis=0)[::-1][1:] for x in (own, cross, b))
    factor, half = _in_si(problem, hypothesis)
    m = len(cuts)
    V = solve_triangular(factor, cross.transpose(1, 0, 2).reshape(k, m * c), lower=True, check_finite=False)
    V = np.moveaxis(V.reshape(k, m, c), 0, 1)
    left = own - np.swapaxes(V, 1, 2) @ V
    return _gain(problem, hypothesis, left, b - np.einsum("mkc,k->mc", V, half), np.einsum("mcc->mc", own))
