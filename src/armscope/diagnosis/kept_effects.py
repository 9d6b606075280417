"""Which of the chosen effects are kept once held-out rows were asked, and the slow wander of the base is set aside."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.diagnosis.held_out_worth import earned, steady, with_drifts_of_their_own
from armscope.diagnosis.model_space import EffectSpace
from armscope.inference.evidence import Hypothesis
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.problem import Problem
from armscope.physics.backgrounds import DRIFT, FAMILIES
from armscope.physics.drift import BASE_DRIFT
from armscope.physics.effect import Placed
from armscope.physics.wander import is_of_rows


def kept_effects(
    problem: Problem,
    blocks: Sequence[NormalEquations],
    hypothesis: Hypothesis,
    space: EffectSpace,
    wander: Sequence[Placed],
) -> Hypothesis:
    """A hypothesis without what makes held-out rows worse.

    Args:
        problem: the sums of all rows, priors and costs.
        blocks: sums of blocks of rows.
        hypothesis: chosen on all rows.
        space: what competed.
        wander: of the base and of links, that the hypothesis may allow for.

    Returns:
        The hypothesis, with what is kept.
    """
    left = earned(problem, blocks, hypothesis)
    columns = [space.layout.of(placed) for placed in wander]
    if columns:
        drifts = {n for n, placed in enumerate(space.placed) if placed.effect is BASE_DRIFT}
        left = with_drifts_of_their_own(problem, blocks, left, drifts, np.unique(np.concatenate(columns)))
    of_rows = [each for each, placed in zip(columns, wander, strict=True) if is_of_rows(placed)]
    return steady(problem, blocks, left, FAMILIES.index(DRIFT), of_rows)
