"""Better? Cross-validation that repeats the whole selection in every fold, on sums of blocks of rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from armscope.diagnosis.evidence import PERFECT, Chosen, Hypothesis, Problem, weigh
from armscope.diagnosis.problem import Gram, total
from armscope.diagnosis.search import LARGE, Search
from armscope.diagnosis.verdict import HeldOut, WaterfallStep
from armscope.recordings import Recordings

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

FOLDS = 5
BLOCKS = 20
FEWEST_ROWS_PER_RUN = 30
FEWEST_RUNS = 3
CHANCE = 0.99


@dataclass(frozen=True, eq=False)
class Blocks:
    """Which block each row is in, which fold each block is in, and what holds rows together."""

    of_row: Indices
    fold: Indices
    grouped_by: str


def split(recordings: Recordings, rng: np.random.Generator) -> Blocks:
    """Blocks of whole configurations (targets and repeats of one pose stay together), folds of whole runs if several.

    Runs are held out whole where there are at least three with at least thirty rows each.
    """
    runs, which_run, per_run = np.unique(recordings.run, return_inverse=True, return_counts=True)
    by_run = len(runs) >= FEWEST_RUNS and per_run.min() >= FEWEST_ROWS_PER_RUN and len(runs) <= BLOCKS
    _, pose = np.unique(np.round(recordings.motor_angles, 4), axis=0, return_inverse=True)
    pose = pose.reshape(-1)
    count = int(pose.max()) + 1
    order = rng.permutation(count)
    if not by_run:
        blocks = min(BLOCKS, count)
        return Blocks((order % blocks)[pose], np.arange(blocks) % FOLDS, "configuration")
    pieces = max(1, BLOCKS // len(runs))
    of_row = which_run * pieces + (order % pieces)[pose]
    return Blocks(of_row, np.repeat(np.arange(len(runs)), pieces), "run")


def cross_validate(
    problem: Problem,
    blocks: Sequence[Gram],
    plain: Sequence[Gram],
    split: Blocks,
    best: Hypothesis,
    order: Sequence[int],
) -> tuple[HeldOut, tuple[WaterfallStep, ...]]:
    """Held-out RMS before and after, selection repeated per fold; and the waterfall of the chosen effects.

    The linearisation point and the weights of suspect rows come from all rows; a whole held-out run's own base is
    fitted on its rows, as it always is.

    Args:
        blocks: sums over the rows as they were fitted.
        plain: the same without the whitening of scatter: errors are told in millimetres as measured.
        order: candidates of ``best`` in the order in which the waterfall adds them.
    """
    whole = total(blocks)
    folds = [int(k) for k in np.unique(split.fold) if 0 < np.count_nonzero(split.fold == k) < len(blocks)]
    before = after = rows = 0.0
    sets = _steps(best, order)
    steps = np.zeros(len(sets))
    empty = Search.on(problem).empty()
    for fold in folds:
        inside = [int(k) for k in np.flatnonzero(split.fold == fold)]
        trained = problem.with_gram(whole - total([blocks[k] for k in inside]))
        scaled = total([plain[k] for k in inside]).scaled(problem.scale)
        held = scaled
        free = split.grouped_by == "run"
        starts = {best.background} if len(best.columns) > LARGE else {best.background, PERFECT}
        search = Search.on(trained, beam=2 if len(starts) > 1 else 1, branches=2)
        chosen = search.refined(search.best(starts=tuple(sorted(starts))))
        rows += held.n
        before += _held_out(trained, weigh(trained, (), PERFECT, empty.noise), scaled, free)
        after += _held_out(trained, chosen, scaled, free)
        for number, subset in enumerate(sets):
            background = best.background if number == len(sets) - 1 else PERFECT
            steps[number] += _held_out(trained, weigh(trained, subset, background, best.noise), scaled, free)
    if rows == 0:
        return HeldOut(float("nan"), float("nan")), ()
    fitted = [
        _rms(
            total(plain).scaled(problem.scale),
            weigh(problem, subset, best.background if n == len(sets) - 1 else PERFECT, best.noise),
        )
        for n, subset in enumerate(sets)
    ]
    labels = ["free frames", *[str(problem.pool.candidates[c]) for c in order], "tolerances everywhere"]
    waterfall = tuple(
        WaterfallStep(label, float(f), float(np.sqrt(s / rows)))
        for label, f, s in zip(labels, fitted, steps, strict=True)
    )
    return HeldOut(float(np.sqrt(before / rows)), float(np.sqrt(after / rows)), len(folds), split.grouped_by), waterfall


def carry_over(problem: Problem, blocks: Sequence[Gram], split: Blocks, best: Hypothesis) -> dict[int, str]:
    """For effects with plain parameters: whether every run alone gives the same values; empty where runs are few.

    Each run's rows give their own posterior under the chosen hypothesis; the values agree where their scatter about
    the common mean is within chance (one in a hundred).
    """
    if split.grouped_by != "run":
        return {}
    runs = [int(k) for k in np.unique(split.fold)]
    alone = [
        weigh(
            problem.with_gram(total([blocks[int(k)] for k in np.flatnonzero(split.fold == run)])),
            best.chosen,
            best.background,
            best.noise,
        )
        for run in runs
    ]
    said = {}
    for c in best.chosen:
        if problem.pool.candidates[c.candidate].reading != "plain":
            continue
        at = [np.searchsorted(h.columns, problem.pool.columns[c.candidate]) for h in alone]
        values = np.array([h.mean[a] for h, a in zip(alone, at, strict=True)])
        variances = np.array(
            [h.noise**2 * np.sum(h.inverse[:, a] ** 2, axis=0) for h, a in zip(alone, at, strict=True)]
        )
        mean = np.sum(values / variances, axis=0) / np.sum(1 / variances, axis=0)
        misfit = float(np.sum((values - mean) ** 2 / variances))
        agrees = misfit < chi2.ppf(CHANCE, values.size - values.shape[1])
        said[c.candidate] = (
            f"Each of the {len(runs)} runs alone gives the same value within its interval."
            if agrees
            else f"The {len(runs)} runs alone give different values: what is meant here may not be the cause."
        )
    return said


def _steps(best: Hypothesis, order: Sequence[int]) -> list[tuple[Chosen, ...]]:
    """Growing sets of effects, and the whole set once more for the background."""
    chosen = {c.candidate: c for c in best.chosen}
    sets = [tuple(chosen[c] for c in order[:n]) for n in range(len(order) + 1)]
    return [*sets, sets[-1]]


def _held_out(problem: Problem, hypothesis: Hypothesis, held: Gram, free_base: bool) -> float:
    """Residual sum of squares on held-out rows, mm^2; ``free_base`` refits the frames that only they have."""
    values = hypothesis.coefficients(len(held.b))
    if free_base:
        frames = problem.pool.frames
        own = frames[np.diag(problem.gram.G)[frames] < 1e-9 * np.maximum(np.diag(held.G)[frames], 1e-12)]
        if len(own):
            left = held.b[own] - held.G[own] @ values
            values[own] += np.linalg.lstsq(held.G[np.ix_(own, own)], left, rcond=1e-12)[0]
    return max(held.rss(values), 0.0)


def _rms(gram: Gram, hypothesis: Hypothesis) -> float:
    return float(np.sqrt(max(gram.rss(hypothesis.coefficients(len(gram.b))), 0.0) / gram.n))
