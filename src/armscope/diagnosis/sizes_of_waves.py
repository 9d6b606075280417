"""Waves of gears as large as the rows say, gear by gear and wave by wave, where held-out rows are the better for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from armscope.diagnosis.held_out_worth import errors_of_fits
from armscope.diagnosis.model_space import EffectSpace
from armscope.inference.constants import SIZES_BY_GROUP
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.problem import Problem
from armscope.inference.sizes_by_group import SizeGroups, sizes_by_group
from armscope.physics.backgrounds import FAMILIES, TRANSMISSION
from armscope.physics.effect import Placed

GEARS = FAMILIES.index(TRANSMISSION)


def freedom_of_waves(
    problem: Problem,
    space: EffectSpace,
    hypothesis: Hypothesis,
    blocks: Sequence[NormalEquations],
    waves: Sequence[Placed],
) -> float | None:
    """How differently large the waves of gears are, by what held-out rows say.

    Args:
        problem: the sums of all rows, priors and costs.
        space: its columns.
        hypothesis: what was chosen.
        blocks: sums of blocks of rows.
        waves: the background as stated.

    Returns:
        The freedom of Student's t; None where the hypothesis has no such background, or held-out rows gain nothing.
    """
    if not hypothesis.background[GEARS]:
        return None
    groups = _groups(space, hypothesis, waves)

    def fit(trained: Problem) -> list[Hypothesis]:
        plain = evaluate(trained, hypothesis.chosen, hypothesis.background, hypothesis.noise)
        return [plain, *(sizes_by_group(trained, plain, groups, freedom)[1] for freedom in SIZES_BY_GROUP.freedoms)]

    errors = errors_of_fits(problem, blocks, 1 + len(SIZES_BY_GROUP.freedoms), fit)
    gains = errors[:, :1] - errors[:, 1:]
    best = int(np.argmax(gains.sum(axis=0)))
    # a gain that another draw of blocks could have taken away is none (the one-standard-error rule, Breiman 1984)
    if not gains[:, best].sum() > np.sqrt(len(blocks)) * np.std(gains[:, best]):
        return None
    return SIZES_BY_GROUP.freedoms[best]


def with_sizes_of_rows(
    problem: Problem, space: EffectSpace, hypothesis: Hypothesis, waves: Sequence[Placed], freedom: float
) -> list[Placed]:
    """The background of gears' waves with the sizes that the rows give them.

    Args:
        problem: the sums of all rows, priors and costs.
        space: its columns.
        hypothesis: what was chosen, with that background.
        waves: the background as stated.
        freedom: of Student's t.

    Returns:
        The same waves, in other sizes.
    """
    factor, _ = sizes_by_group(problem, hypothesis, _groups(space, hypothesis, waves), freedom)
    larger = dict(zip(space.families[GEARS].columns.tolist(), factor.tolist(), strict=True))
    return [
        replace(
            wave,
            prior_scale=tuple(
                scale * larger[space.layout.index[term]]
                for scale, term in zip(wave.prior_scale, wave.terms, strict=True)
            ),
        )
        for wave in waves
    ]


def _groups(space: EffectSpace, hypothesis: Hypothesis, waves: Sequence[Placed]) -> SizeGroups:
    """The two values of a wave are of a size, and the waves of a gear."""
    columns = space.families[GEARS].columns
    small, large = np.zeros(len(columns), dtype=np.intp), np.zeros(len(columns), dtype=np.intp)
    gears = sorted({wave.location for wave in waves})
    for number, wave in enumerate(waves):
        at = np.searchsorted(columns, space.layout.of(wave))
        small[at], large[at] = number, gears.index(wave.location)
    named = [space.candidates[effect.candidate].columns for effect in hypothesis.chosen]
    return SizeGroups(GEARS, small, large, ~np.isin(columns, np.concatenate([[-1], *named])))
