"""Names that would push against their load: what gives way can't."""

from __future__ import annotations

from armscope.diagnosis.constants import LOOP
from armscope.diagnosis.model_space import EffectSpace
from armscope.fitting.refit import Refit
from armscope.inference.evidence import Hypothesis
from armscope.physics.effect import Part
from armscope.physics.elastic import TWO_AXES, stiffest_of_two


def against_their_load(space: EffectSpace, hypothesis: Hypothesis, fit: Refit) -> list[int]:
    """Names whose fitted values turned out negative where they can't be: in a background, or about an axis.

    Args:
        space: which effect each candidate is.
        hypothesis: with the names.
        fit: its exact fit.

    Returns:
        Their candidates.
    """
    return [
        c.candidate
        for c, part in zip(hypothesis.chosen, fit.model.parts, strict=True)
        if (c.nested and space.nonnegative[c.candidate] and part.values[0] < 0)
        or (part.placed.variant == TWO_AXES and _pushes(part, fit))
    ]


def _pushes(part: Part, fit: Refit) -> bool:
    """Whether a compliance about two axes is surely negative about one of them."""
    pushing, stderr = stiffest_of_two(part.values, fit.covariance_of(part.placed))
    return pushing < -LOOP.surely_negative * stderr
