"""When friction changes sides, as all of a motion tells it, beside sums over a part of it.

Moves from point to point hardly tell what a path shows that turns back, and guess it by what clings where they start:
their best guess is off by more than most names say. It is no name's, so names are judged on motion that took no part
with it as known as all of the motion makes it, without curves that have no name: beside one of those friction may
change sides in any way, as long as the two cancel each other on the paths that are known.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.model_space import BackgroundSizes
from armscope.inference.normal_equations import NormalEquations, total
from armscope.inference.problem import Problem, SelectedEffect
from armscope.motion.fitting.space import OF_REVERSALS


def fitted_beside(
    whole: Problem, rest: Problem, effects: tuple[SelectedEffect, ...], background: BackgroundSizes, noise: float
) -> Hypothesis:
    """Effects and a background fitted to a part, but for what all says of how friction changes sides.

    Args:
        whole: all of the motion.
        rest: the part.
        effects: what is fitted.
        background: size of each family's background.
        noise: where it starts.

    Returns:
        The hypothesis.
    """
    named = tuple(effect for effect in effects if not whole.space.candidates[effect.candidate].is_curve)
    told = _told_sides(whole, evaluate(whole, named, background, noise))
    return evaluate(replace(rest, equations=total([rest.equations, told])), effects, background, noise)


def _told_sides(problem: Problem, found: Hypothesis) -> NormalEquations:
    """Sums as if a measurement had told what a hypothesis knows of how friction changes sides, as surely as it does."""
    families = [family.columns for family in problem.space.families if family.name in OF_REVERSALS]
    sides = np.intersect1d(found.columns, np.concatenate([np.empty(0, dtype=np.intp), *families]))
    known, means = np.zeros((2, len(problem.scale)))
    known[sides], means[sides] = found.noise**2 / found.variances(sides), found.means(sides)
    return NormalEquations(np.diag(known), known * means, float(known @ means**2), 0.0)
