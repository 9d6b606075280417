"""Better? Cross-validation that repeats the whole selection in every fold, on sums of blocks of rows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.grouping import same_configuration, visited_by_others
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array, Indices
from armscope.diagnosis.constants import FOLDING
from armscope.diagnosis.linearised_rows import LinearisedRows
from armscope.diagnosis.placed_by_points import placed_by_points
from armscope.inference.constants import BUDGET
from armscope.inference.evidence import Hypothesis, evaluate, fitted_values
from armscope.inference.normal_equations import NormalEquations, total
from armscope.inference.problem import Problem, SelectedEffect
from armscope.inference.search import Search
from armscope.physics.drift import six_terms
from armscope.physics.effect import Driver, Term
from armscope.recordings import Recordings
from armscope.verdict.schema import HeldOut, WaterfallStep


@dataclass(frozen=True, eq=False)
class RowSplit:
    """How rows are held out."""

    of_row: Indices  # (N,) number of each row's block, from 0
    fold: Indices  # (blocks,) number of each block's fold; blocks of one fold are held out together
    grouped_by: str  # what is never parted: "configuration" or "run"

    def within_runs(self) -> RowSplit:
        """The same blocks with a part of every run in each fold, where runs have several blocks."""
        runs, pieces = np.unique(self.fold, return_counts=True)
        if self.grouped_by != "run" or pieces.min() < 2:
            return self
        return RowSplit(self.of_row, np.tile(np.arange(pieces[0]) % FOLDING.folds, len(runs)), "configuration")


def split_rows(recordings: Recordings, rng: np.random.Generator) -> RowSplit:
    """Blocks of whole configurations (targets and repeats of one pose stay together), folds of whole runs if several.

    Runs are held out whole where there are at least three with at least thirty rows each, of poses of their own: one
    that visits the others' poses would be foretold by what was learned there.
    """
    runs, which_run, per_run = np.unique(recordings.run, return_inverse=True, return_counts=True)
    pose = same_configuration(recordings.motor_angles)
    by_run = (
        len(runs) >= FOLDING.fewest_runs
        and per_run.min() >= FOLDING.fewest_rows_per_run
        and len(runs) <= FOLDING.blocks
        and np.mean(visited_by_others(pose, which_run)) < FOLDING.seen_elsewhere
    )
    count = int(pose.max()) + 1
    order = rng.permutation(count)
    if not by_run:
        blocks = min(FOLDING.blocks, count)
        return RowSplit((order % blocks)[pose], np.arange(blocks) % FOLDING.folds, "configuration")
    pieces = max(1, FOLDING.blocks // len(runs))
    of_row = which_run * pieces + (order % pieces)[pose]
    return RowSplit(of_row, np.repeat(np.arange(len(runs)), pieces), "run")


def cross_validate(
    problem: Problem,
    blocks: Sequence[NormalEquations],
    split: RowSplit,
    best: Hypothesis,
    order: Sequence[int],
    rows: LinearisedRows,
) -> tuple[HeldOut, tuple[WaterfallStep, ...]]:
    """Held-out RMS before and after, selection repeated per fold; and the waterfall of the chosen effects.

    Every fold's search starts from nothing and sees only its own rows' sums. What comes from all rows: the point of
    linearisation, the weights of rows, the scanned numbers that compete (periods, times of jumps) and, for a hypothesis
    of many columns, the backgrounds' sizes from which the search starts. Where a whole held-out run stands is fitted on
    its rows, as it always is.

    Args:
        problem: the sums of all rows, priors and costs.
        blocks: sums over the rows as they were fitted.
        split: which blocks make which fold.
        best: the hypothesis chosen on all rows.
        order: candidates of ``best`` in the order in which the waterfall adds them.
        rows: the rows at the point of linearisation of ``blocks``.

    Returns:
        Errors per axis, mm, and one step per effect.
    """
    folds = [int(k) for k in np.unique(split.fold) if 0 < np.count_nonzero(split.fold == k) < len(blocks)]
    if not folds:
        return HeldOut(float("nan"), float("nan")), ()
    sets, noise = _steps(best, order), Search.on(problem).empty().noise
    own_values = fitted_values(problem, _readings(problem, sets, best, noise))
    whole, values = total(blocks), {}
    for fold in folds:
        trained = problem.with_equations(whole - _sums_of(fold, blocks, split))
        values[fold] = _values_without(trained, best, sets, noise)
    some = spread_evenly(len(split.of_row), FOLDING.judged_rows)
    split, rows = replace(split, of_row=split.of_row[some]), rows.some(some)
    errors, own = _held_out_errors(problem, blocks, split, rows, values), rows.residuals(own_values)
    fold_of = split.fold[split.of_row]
    each_fold, tested = [np.flatnonzero(fold_of == fold) for fold in folds], np.isin(fold_of, folds)
    turns = _rms(errors[:, tested & rows.trusted], rows.slices.get("orientation", slice(0)))
    if "orientation" in rows.slices:
        _place_by_points(problem, rows, errors, own, each_fold)
    held, held_all = _rms(errors[:, tested & rows.trusted]), _rms(errors[:, tested])
    spread = _spread(errors, [part[rows.trusted[part]] for part in each_fold])
    labels = ["free frames", *[problem.space.candidates[c].label for c in order], "tolerances everywhere"]
    steps = zip(labels, _rms(own[:, rows.trusted]), held[:-1], spread[:-1], strict=True)
    told = HeldOut(
        before=float(held[0]),
        after=float(held[-1]),
        folds=len(folds),
        grouped_by=split.grouped_by,
        before_all_rows=float(held_all[0]),
        after_all_rows=float(held_all[-1]),
        spread=float(spread[-1]),
        turn_before=float(turns[0]),
        turn_after=float(turns[-1]),
    )
    return told, tuple(WaterfallStep(label, float(f), float(h), float(s)) for label, f, h, s in steps)


def _sums_of(fold: int, blocks: Sequence[NormalEquations], split: RowSplit) -> NormalEquations:
    return total([blocks[int(k)] for k in np.flatnonzero(split.fold == fold)])


def _values_without(
    trained: Problem, best: Hypothesis, sets: Sequence[tuple[SelectedEffect, ...]], noise: float
) -> Array:
    """What is fitted without a fold's rows: by every step of the waterfall, and by the selection repeated there."""
    values = fitted_values(trained, _readings(trained, sets, best, noise))
    return np.concatenate([values, fitted_values(trained, [_chosen_again(trained, best)])])


def _place_by_points(
    problem: Problem, rows: LinearisedRows, errors: Array, own: Array, each_fold: Sequence[Indices]
) -> None:
    """Points of the nominal arm are judged by frames that were fitted to points alone, in both kinds of errors."""
    frames = [rows.layout.terms[k] for k in problem.space.frames]
    nominal = own[0, :, POINTS].copy()
    for told, parts in ((errors, each_fold), (own, [np.arange(own.shape[1])])):
        told[0, :, POINTS] = placed_by_points(rows, frames, nominal, parts)


def _spread(errors: Array, each_fold: Sequence[Indices]) -> Array:
    """(K,) standard deviation of the RMS between folds; NaN for a single one."""
    per_fold = np.array([_rms(errors[:, part]) for part in each_fold if len(part)])
    return per_fold.std(axis=0, ddof=1) if len(per_fold) > 1 else np.full(len(errors), np.nan)


def _chosen_again(trained: Problem, best: Hypothesis) -> Hypothesis:
    """The selection repeated on a fold's own rows, from as many starts as on all rows; from one where it is large."""
    if len(best.columns) > BUDGET.large:
        search, starts = Search.on(trained, beam=1, branches=2), {best.background}
    else:
        search, starts = Search.on(trained), {best.background, *trained.space.starts}
    return search.refined(search.best(starts=tuple(sorted(starts))))


def _readings(
    problem: Problem, sets: Sequence[tuple[SelectedEffect, ...]], best: Hypothesis, first_noise: float
) -> Iterator[Hypothesis]:
    """The waterfall's hypotheses: nothing, growing sets of effects, all of them with the background."""
    noises = [first_noise, *[best.noise] * (len(sets) - 1)]
    backgrounds = [*[problem.space.no_background] * (len(sets) - 1), best.background]
    return (evaluate(problem, *each) for each in zip(sets, backgrounds, noises, strict=True))


def _held_out_errors(
    problem: Problem,
    blocks: Sequence[NormalEquations],
    split: RowSplit,
    rows: LinearisedRows,
    values: Mapping[int, Array],
) -> Array:
    """(K, N, c) errors, mm and mrad, of every row under the readings of the fold that it took no part in.

    Where whole runs are held out, the frames that only they have are refitted on them, and so is where they stand on a
    base that they share.
    """
    folds = sorted(values)
    fold_of = split.fold[split.of_row]
    number = np.searchsorted(folds, np.where(np.isin(fold_of, folds), fold_of, folds[0]))
    errors = rows.residuals(np.array([values[f] for f in folds]), number)
    if split.grouped_by != "run":
        return errors
    whole = total(blocks)
    for fold in folds:
        held = _sums_of(fold, blocks, split)
        frames = problem.space.frames
        seen = np.diag(whole.G)[frames]
        own = frames[seen - np.diag(held.G)[frames] < 1e-9 * np.maximum(seen, 1e-12)]
        at = np.flatnonzero(fold_of == fold)
        terms = [rows.layout.terms[k] for k in own]
        terms += [
            term
            for run in np.unique(rows.recordings.run[at])
            for term in six_terms("base", Driver("in run", (str(run),)))
            if term not in terms
        ]
        errors[:, at] = _refitted(rows, terms, at, errors[:, at])
    return errors


def _refitted(rows: LinearisedRows, terms: Sequence[Term], at: Indices, errors: Array) -> Array:
    """Errors (K, n, c) of rows ``at`` once their own frames are fitted to them."""
    X = rows.unweighted_columns(terms, at)
    y = np.moveaxis(errors, 0, 2).reshape(len(X), -1)
    alone = rows.weights.unwhitened.of_channels
    roots = [np.repeat(each.factor(at)[:, None], each.channel.width, axis=1) for each in alone]
    root = np.concatenate(roots, axis=1).reshape(-1, 1)
    values = np.linalg.lstsq(root * X, root * np.nan_to_num(y), rcond=1e-12)[0]
    return np.asarray(np.moveaxis((y - X @ values).reshape(len(at), -1, y.shape[1]), 2, 0))


POINTS = slice(0, 3)


def _rms(errors: Array, which: slice = POINTS) -> Array:
    """(K,) RMS per axis of the points, or of other numbers, of errors (K, n, c); NaN where none was measured."""
    squares = errors[:, :, which] ** 2
    known = np.isfinite(squares)
    sums = np.sum(np.where(known, squares, 0.0), axis=(1, 2))
    counts = np.count_nonzero(known, axis=(1, 2))
    return np.asarray(np.sqrt(np.divide(sums, counts, out=np.full(len(errors), np.nan), where=counts > 0)))


def _steps(best: Hypothesis, order: Sequence[int]) -> list[tuple[SelectedEffect, ...]]:
    """Growing sets of effects, and the whole set once more for the background."""
    chosen = {c.candidate: c for c in best.chosen}
    sets = [tuple(chosen[c] for c in order[:n]) for n in range(len(order) + 1)]
    return [*sets, sets[-1]]
