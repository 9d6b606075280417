"""Free curves are the last resort: a law that does as well comes first, and rows that took no part must be predicted.

In a short table some joint's curve follows nearly anything. It has a value for every stretch of its joint, and rows of
one configuration lie on the same stretch: of 25 configurations it can take most of what is left, at high evidence, and
misses the next one by ten times the noise. So the best reading without any curve is asked beside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from armscope.diagnosis.constants import FOLDING
from armscope.diagnosis.held_out_worth import held_out_errors
from armscope.inference.constants import PRIORS
from armscope.inference.edits import Edits
from armscope.inference.evidence import Hypothesis
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.problem import Problem
from armscope.inference.search import Search


def predicted_without_curves(
    problem: Problem, blocks: Sequence[NormalEquations], hypothesis: Hypothesis
) -> Hypothesis | None:
    """The best hypothesis without free curves, where it predicts held-out rows better than one with some.

    Better is by more than a standard error over the blocks; by anything where the evidence is for it, too.

    Args:
        problem: the sums of all rows, priors and costs.
        blocks: sums of blocks of rows.
        hypothesis: that the search found.

    Returns:
        The hypothesis; None where there is no curve, or where the curves predict the rows.
    """
    space = problem.space
    if not any(space.candidates[c].is_curve for c in hypothesis.candidates):
        return None
    reading = hypothesis.chosen, hypothesis.background
    errors = held_out_errors(problem, blocks, [reading], hypothesis.noise)
    if np.sqrt(errors.sum() / problem.n) < FOLDING.overfitted * hypothesis.noise:
        return None
    plain = tuple(replace(each, competes=each.competes and not each.is_curve) for each in space.candidates)
    rival = Search.on(replace(problem, space=replace(space, candidates=plain))).best()
    errors = held_out_errors(problem, blocks, [reading, (rival.chosen, rival.background)], hypothesis.noise)
    gain = errors[:, 0] - errors[:, 1]
    doubt = 0.0 if rival.log_posterior > hypothesis.log_posterior else float(gain.std(ddof=1) * np.sqrt(len(gain)))
    return rival if gain.sum() > doubt else None


def told_by_laws(edits: Edits, hypothesis: Hypothesis) -> Hypothesis:
    """A hypothesis with the law in a free curve's place that the evidence does not tell from it, at odds of 20 to 1.

    Both are told then, the law first: it says what to mend, and what holds beyond the angles that were measured.
    """
    for curve in hypothesis.chosen:
        laws = edits.candidate(curve.candidate).special_cases - hypothesis.candidates
        if laws:
            others = set(range(len(edits.space.candidates))) - laws
            best = edits.additions(edits.without(hypothesis, [curve.candidate]), 1, others)
            if best and best[0].log_posterior > hypothesis.log_posterior - PRIORS.sure_nats:
                hypothesis = best[0]
    return hypothesis
