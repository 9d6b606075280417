"""Whether a name earns its place on rows that took no part in fitting it.

The columns stay; their values are fitted on four fifths of the rows and judged on the rest, once with all names and
once without each. What makes held-out rows worse is no cause, whatever the evidence on the fitted rows.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence, Set
from dataclasses import replace

import numpy as np

from armscope.core.types import Array, Indices
from armscope.diagnosis.constants import FOLDING, LOOP
from armscope.inference.edits import Edits, replaced
from armscope.inference.evidence import Hypothesis, at_noise, evaluate, fitted_values, is_beside
from armscope.inference.model_space import BackgroundSizes
from armscope.inference.normal_equations import NormalEquations, total
from armscope.inference.problem import Problem, SelectedEffect, prior_variances
from armscope.inference.search import Search

Reading = tuple[tuple[SelectedEffect, ...], BackgroundSizes]
"""Effects and backgrounds whose values are fitted anew."""


def earned(problem: Problem, blocks: Sequence[NormalEquations], hypothesis: Hypothesis) -> Hypothesis:
    """The hypothesis without the names that make held-out rows worse, the worst first.

    Names that without those are not worth their price go, too. A name that a background or a curve holds, too, changes
    nothing that is predicted, and is not asked.

    Args:
        problem: the sums of all rows, priors and costs.
        blocks: sums of blocks of rows.
        hypothesis: chosen on all rows.

    Returns:
        The hypothesis with the names that earn their place.
    """
    search, found = Search.on(problem), hypothesis
    while own := [c for c in hypothesis.chosen if not c.nested and not search.in_background(hypothesis, c.candidate)]:
        without = [(search.kept(hypothesis, [c.candidate]), hypothesis.background) for c in own]
        gains = held_out_gains(problem, blocks, hypothesis, without)
        worst = int(np.argmin(gains))
        if not gains[worst] < 0:
            break
        hypothesis = search.evaluated(without[worst][0], hypothesis)
    while hypothesis is not found and (weakest := search.weakest(hypothesis)) is not None:
        hypothesis = search.without(hypothesis, [weakest.candidate])
    return hypothesis


def steady(
    problem: Problem, blocks: Sequence[NormalEquations], hypothesis: Hypothesis, wander: int, of_rows: Sequence[Indices]
) -> Hypothesis:
    """A hypothesis without a wander in the order of rows that is barely seen and makes other rows worse.

    Args:
        problem: the sums of all rows, priors and costs.
        blocks: sums of blocks of rows.
        hypothesis: chosen on all rows.
        wander: number of the wander's family.
        of_rows: its columns that follow the order of rows.

    Returns:
        The hypothesis, with or without it.
    """
    if not hypothesis.background[wander] or not of_rows:
        return hypothesis
    without = Search.on(problem).with_background(hypothesis, wander, 0)
    sure = hypothesis.log_posterior - without.log_posterior > LOOP.surely_wanders
    if sure or predicted_better(problem, blocks, hypothesis, wander, np.concatenate(of_rows)):
        return hypothesis
    return without


def predicted_better(
    problem: Problem, blocks: Sequence[NormalEquations], hypothesis: Hypothesis, family: int, untold: Indices
) -> bool:
    """Whether held-out rows are predicted better where a background took part in the fit that says nothing of them.

    A wander by the order of rows is no other rows'. Where poses came in order it takes what follows the posture, and
    what is left predicts worse.

    Args:
        problem: the sums of all rows, priors and costs.
        blocks: sums of blocks of rows.
        hypothesis: that holds the background.
        family: the background's number.
        untold: its columns that say nothing of other rows.

    Returns:
        Whether it is; so it is where blocks are too few to hold out.
    """
    without = replaced(hypothesis.background, family, 0)
    readings = (hypothesis.chosen, hypothesis.background), (hypothesis.chosen, without)
    return _lost_without(problem, blocks, readings, hypothesis.noise, untold) <= 0


def with_drifts_of_their_own(
    problem: Problem, blocks: Sequence[NormalEquations], hypothesis: Hypothesis, drifts: Set[int], wander: Indices
) -> Hypothesis:
    """The hypothesis without named drifts that a wander takes back.

    Both move the base in the order of time. A drift of centimetres against a wander of centimetres can follow what
    neither can alone, but it is no motion that anybody would measure: without the wander it predicts worse than none.

    Args:
        problem: the sums of all rows, priors and costs.
        blocks: sums of blocks of rows.
        hypothesis: chosen on all rows.
        drifts: candidates that are drifts.
        wander: columns of the wander.

    Returns:
        The hypothesis with the drifts that predict by themselves.
    """
    for drift in sorted(drifts & hypothesis.candidates if len(wander) else ()):
        less = Search.on(problem).without(hypothesis, [drift])
        readings = (hypothesis.chosen, hypothesis.background), (less.chosen, less.background)
        if _lost_without(problem, blocks, readings, hypothesis.noise, wander) > 0:
            hypothesis = less
    return hypothesis


def _lost_without(
    problem: Problem,
    blocks: Sequence[NormalEquations],
    readings: tuple[Reading, Reading],
    noise: float,
    untold: Indices,
) -> float:
    """How much more the first of two readings leaves of held-out rows, of which some columns say nothing, mm^2."""
    lost = 0.0
    for fold, trained in _folds(problem, blocks):
        for sign, reading in zip((1, -1), readings, strict=True):
            (values,) = fitted_values(problem, [evaluate(trained, *reading, noise)])
            values[untold] = 0.0
            lost += sign * sum(blocks[int(k)].rss(values) for k in fold)
    return lost


def held_out_gains(
    problem: Problem, blocks: Sequence[NormalEquations], hypothesis: Hypothesis, others: Sequence[Reading]
) -> Array:
    """By how much a hypothesis predicts held-out rows better than some others, as a reduction of their chi squared.

    Args:
        problem: the sums of all rows, priors and costs.
        blocks: sums of blocks of rows.
        hypothesis: that is judged.
        others: effects and backgrounds that are judged beside it.

    Returns:
        (others,) in squares of the hypothesis' noise, summed over all rows; zeros where rows are too few to hold out.
    """
    readings = [(hypothesis.chosen, hypothesis.background), *others]
    alone, left = without_companions(problem, blocks, hypothesis)
    errors = held_out_errors(alone, left, readings, hypothesis.noise).sum(axis=0)
    return np.asarray((errors[1:] - errors[0]) / hypothesis.noise**2)


def without_companions(
    problem: Problem, blocks: Sequence[NormalEquations], hypothesis: Hypothesis
) -> tuple[Problem, list[NormalEquations]]:
    """Sums less what companions explain in a hypothesis, which then are as it has them in whatever is asked.

    Masses that are off are so in every part of the rows. And their errors were written around what gives way in the
    hypothesis: free, they would go on giving way in place of a name that is taken out, heavier by all there is.

    Args:
        problem: the sums of all rows, priors and costs.
        blocks: sums of blocks of rows.
        hypothesis: chosen on all rows.

    Returns:
        The problem without companions, and the blocks.
    """
    joined = [c for c in problem.space.companions if c.joins(hypothesis.candidates, hypothesis.background)]
    if not joined:
        return problem, list(blocks)
    found = np.zeros(len(problem.scale))
    for companion in joined:
        found[companion.family.columns] = hypothesis.means(companion.family.columns)
    values = found / problem.scale
    alone = replace(problem, space=replace(problem.space, companions=()))
    return alone, [NormalEquations(part.G, part.b - part.G @ values, part.rss(values), part.n) for part in blocks]


def held_out_errors(
    problem: Problem, blocks: Sequence[NormalEquations], readings: Sequence[Reading], noise: float
) -> Array:
    """What readings that are fitted to four fifths of the blocks leave of the others.

    Args:
        problem: the sums of all rows, priors and costs.
        blocks: sums of blocks of rows.
        readings: effects and backgrounds, fitted anew.
        noise: where the noise starts, mm.

    Returns:
        (blocks, readings) sums of squares, mm^2; zeros where blocks are too few to hold out.
    """

    def fit(trained: Problem) -> Iterator[Hypothesis]:
        large = is_beside(len(np.flatnonzero(prior_variances(trained, *readings[0]))))
        near = at_noise(trained, *readings[0], noise) if large else None  # of which the others are parts
        return (evaluate(trained, *reading, noise, near) for reading in readings)

    return errors_of_fits(problem, blocks, len(readings), fit)


def errors_of_fits(
    problem: Problem,
    blocks: Sequence[NormalEquations],
    count: int,
    fit: Callable[[Problem], Iterable[Hypothesis]],
) -> Array:
    """What hypotheses that are fitted to four fifths of the blocks leave of the others.

    Args:
        problem: the sums of all rows, priors and costs.
        blocks: sums of blocks of rows.
        count: K, how many hypotheses.
        fit: K hypotheses on the sums of some rows; one after the other, they need not be kept together.

    Returns:
        (blocks, K) sums of squares, mm^2; zeros where blocks are too few to hold out.
    """
    errors = np.zeros((len(blocks), count))
    for fold, trained in _folds(problem, blocks):
        values = fitted_values(problem, fit(trained))
        errors[fold] = [blocks[int(k)].rss_of_each(values) for k in fold]
    return errors


def _folds(problem: Problem, blocks: Sequence[NormalEquations]) -> Iterator[tuple[Indices, Problem]]:
    """Numbers of blocks held out together, and the problem on the others; nothing where blocks are too few."""
    everything = total(blocks)
    for first in range(FOLDING.folds if len(blocks) >= FOLDING.folds else 0):
        fold = np.arange(first, len(blocks), FOLDING.folds)
        yield fold, problem.with_equations(everything - total([blocks[int(k)] for k in fold]))


def without_members(
    edits: Edits, hypothesis: Hypothesis, members: Collection[int], families: Collection[int]
) -> Reading:
    """A hypothesis without some effects and without the backgrounds of some families.

    Args:
        edits: of the search.
        hypothesis: from which they are taken.
        members: candidates.
        families: numbers of families.

    Returns:
        The effects and backgrounds that are left.
    """
    background = tuple(0 if n in families else size for n, size in enumerate(hypothesis.background))
    return edits.kept(hypothesis, members), background
