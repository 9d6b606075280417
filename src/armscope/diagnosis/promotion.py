"""What a found hypothesis is called: names out of its backgrounds, and lines out of its curves.

Naming changes neither the fit nor the search: a background explains its members with or without their names, and a
curve contains its line. So names given here pay no price of the library.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from armscope.core.types import Indices
from armscope.inference.evidence import SURE_NATS, Hypothesis, Problem, SelectedEffect, evaluate, savage_dickey
from armscope.inference.search import Search
from armscope.physics.elastic import JOINT_COMPLIANCE
from armscope.physics.freeform import REST_OF_LOAD

STANDS_OUT_NATS, STANDS_OUT = 20.0, 0.25
"""A background's member is named when holding it right loses this much and it is worth this share of the RMS."""
GIVES_NATS, GIVES = SURE_NATS, 0.1
"""A joint's drive in an elastic background is named at odds of 20 to 1, if it is worth this share of the RMS at all: of
what gives way, drives do first and most."""
LINE_SHARE = 0.9
"""A curve of load whose line explains this share of it is told as the line, and what is left of the curve."""


def named(search: Search, hypothesis: Hypothesis) -> Hypothesis:
    """The hypothesis with lines told as compliances, with the members of backgrounds named that stand out.

    What then is not worth its name any more is left to the background, in which others may stand out.
    """
    while True:
        told = _promoted(search.problem, _straightened(search.problem, hypothesis))
        faintest = search.weakest(told)
        if faintest is None:
            return told
        hypothesis = search.without(hypothesis, [faintest.candidate])


def _promoted(problem: Problem, hypothesis: Hypothesis) -> Hypothesis:
    """With the members of a background named that stand out by themselves.

    In an arm that is a little wrong everywhere, the place that is so most deserves its name, although the background
    explains it, too: its evidence is what is lost when it alone is held right. Drives are weighed as they will be
    fitted: as large as they come, not held small by the background.
    """
    within = list(_unnamed(problem, hypothesis))
    drives = [number for number in within if problem.pool.candidates[number].effect is JOINT_COMPLIANCE]
    others = [number for number in within if number not in drives]
    added = [number for number in others if _stands_out(problem, hypothesis, number, STANDS_OUT_NATS, STANDS_OUT)]
    if drives:
        free = _with_names(problem, hypothesis, drives, np.full(len(drives), problem.mismatch))
        added += [d for d in drives if _stands_out(problem, free, d, GIVES_NATS, GIVES)]
    while True:
        sizes = np.array([np.linalg.norm(_means(problem, hypothesis, number)) for number in added])
        told = _with_names(problem, hypothesis, added, sizes)
        # several that stand in for each other stand out only as long as the others are held small
        lost = {d: _lost(problem, told, d) for d in added if d in drives}
        weakest = min(lost, key=lambda d: lost[d], default=None)
        if weakest is None or lost[weakest] > GIVES_NATS:
            return told
        added.remove(weakest)


def _with_names(problem: Problem, hypothesis: Hypothesis, names: Sequence[int], rms: np.ndarray) -> Hypothesis:
    added = [
        SelectedEffect(n, _nearest_size(problem, float(size)), nested=True) for n, size in zip(names, rms, strict=True)
    ]
    return evaluate(problem, (*hypothesis.chosen, *added), hypothesis.background, hypothesis.noise)


def _means(problem: Problem, hypothesis: Hypothesis, number: int) -> np.ndarray:
    return np.asarray(hypothesis.mean[np.searchsorted(hypothesis.columns, problem.pool.columns[number])])


def _stands_out(problem: Problem, hypothesis: Hypothesis, number: int, least: float, share: float) -> bool:
    return _lost(problem, hypothesis, number) > least and bool(
        np.linalg.norm(_means(problem, hypothesis, number)) > share * problem.mismatch
    )


def _unnamed(problem: Problem, hypothesis: Hypothesis) -> Iterator[int]:
    """Candidates whose columns a background holds, none of which has a name yet nor another form of it."""
    pool = problem.pool
    taken = {column for c in hypothesis.chosen for column in pool.columns[c.candidate]}
    taken_keys = {pool.candidates[c.candidate].key for c in hypothesis.chosen}
    for family, size in zip(pool.background, hypothesis.background, strict=True):
        inside = set(family) if size else set()
        for number, columns in enumerate(pool.columns):
            if set(columns) <= inside and not taken & set(columns) and pool.candidates[number].key not in taken_keys:
                yield number


def _lost(problem: Problem, hypothesis: Hypothesis, number: int) -> float:
    """Nats lost when a candidate's columns are held at zero; all, where a value that can't be negative is."""
    if problem.pool.nonnegative[number] and _means(problem, hypothesis, number)[0] <= 0:
        return -np.inf
    return float(savage_dickey(problem, hypothesis, [problem.pool.columns[number]])[0])


def _nearest_size(problem: Problem, rms: float) -> int:
    within = np.clip(rms, problem.sizes.min(), problem.sizes.max())  # what is held at zero gets the smallest
    return int(np.argmin(np.abs(np.log(problem.sizes / within))))


def _straightened(problem: Problem, hypothesis: Hypothesis) -> Hypothesis:
    """With curves of load that are lines for the most part told as compliances, and what is left of them as curves."""
    stated = {p.key: n for n, p in enumerate(problem.pool.candidates) if p.effect is JOINT_COMPLIANCE and not p.variant}
    rests = {p.location: n for n, p in enumerate(problem.pool.candidates) if p.variant == REST_OF_LOAD}
    for curve in hypothesis.chosen:
        placed = problem.pool.candidates[curve.candidate]
        key = (JOINT_COMPLIANCE.name, placed.location)
        if placed.parametrisation != "curve" or placed.variant != "load" or key not in stated:
            continue
        straight, bent = _line(problem, hypothesis, curve.candidate)
        if straight**2 < LINE_SHARE * (straight**2 + bent**2):
            continue
        others = tuple(c for c in hypothesis.chosen if c is not curve)
        line = SelectedEffect(stated[key], _nearest_size(problem, straight), nested=True)
        rest = SelectedEffect(rests[placed.location], _nearest_size(problem, bent), nested=True)
        hypothesis = evaluate(problem, (*others, line, rest), hypothesis.background, hypothesis.noise)
    return hypothesis


def _line(problem: Problem, hypothesis: Hypothesis, curve: int) -> tuple[float, float]:
    """RMS, mm, of a load curve's line beyond a constant (0 for a line against the load), and of what is left of it."""
    columns = problem.pool.columns[curve]
    at = {term.name: n for n, term in enumerate(problem.pool.candidates[curve].terms)}
    mean = hypothesis.mean[np.searchsorted(hypothesis.columns, columns)]
    M = _beyond_frames(problem, columns)
    constant = [at["offset"]] if "offset" in at else []
    whole = _left(M, mean, constant)
    rest = _left(M, mean, [*constant, at["compliance"]])
    along = M[at["compliance"]] @ mean
    if constant:
        n = constant[0]
        along = along - M[at["compliance"], n] / M[n, n] * (M[n] @ mean)
    straight = max(whole - rest, 0.0) if along > 0 else 0.0
    return float(np.sqrt(straight / problem.n)), float(np.sqrt(max(rest, 1e-12) / problem.n))


def _beyond_frames(problem: Problem, columns: Indices) -> np.ndarray:
    """(c, c) products of columns beyond what the free frames absorb."""
    G, frames = problem.equations.G, problem.pool.frames
    absorbed = np.linalg.lstsq(G[np.ix_(frames, frames)], G[np.ix_(frames, columns)], rcond=1e-12)[0]
    return np.asarray(G[np.ix_(columns, columns)] - G[np.ix_(columns, frames)] @ absorbed)


def _left(M: np.ndarray, mean: np.ndarray, fitted: list[int]) -> float:
    """Sum of squares of a combination of columns beyond the best one of some of them."""
    total = float(mean @ M @ mean)
    if not fitted:
        return total
    b = M[fitted] @ mean
    return total - float(b @ np.linalg.lstsq(M[np.ix_(fitted, fitted)], b, rcond=1e-12)[0])


def rest_of(problem: Problem, hypothesis: Hypothesis, line: int) -> list[int]:
    """What is left, in a hypothesis, of the curve that a named line was taken from."""
    placed = problem.pool.candidates[line]
    if placed.effect is not JOINT_COMPLIANCE:
        return []
    others = {c: problem.pool.candidates[c] for c in hypothesis.candidates}
    return [c for c, p in others.items() if p.location == placed.location and p.variant == REST_OF_LOAD]


def worth(problem: Problem, hypothesis: Hypothesis, name: SelectedEffect) -> float:
    """Evidence for a name within a background or a curve, nats: lost when it is held at zero, the noise growing."""
    members = [name.candidate, *rest_of(problem, hypothesis, name.candidate)]
    columns = np.unique(np.concatenate([problem.pool.columns[c] for c in members]))
    lost = float(savage_dickey(problem, hypothesis, [columns])[0])
    return problem.n / 2 * float(np.log1p(2 * max(lost, 0.0) / problem.n))
