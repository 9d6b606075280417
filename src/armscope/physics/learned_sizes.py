"""Sizes learned from other arms of the same type, in place of what is plausible of any arm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from armscope.core.inputs import InputError, nearest
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import Placed, Term
from armscope.robot.arm_type import ArmType, LearnedSize


def with_learned_sizes(placed: Sequence[Placed], arm_type: ArmType, known: Sequence[str]) -> list[Placed]:
    """Placed effects whose terms are as large as arms of the type have shown; others are as they were.

    Args:
        placed: effects on an arm.
        arm_type: what is known of its type.
        known: names of all effects.

    Returns:
        The same effects.

    Raises:
        InputError: a size is of an effect that nobody knows.
    """
    for cause in arm_type.sizes:
        if (name := cause.partition(" at ")[0]) not in known:
            raise InputError(arm_type.source, f"sizes: {cause}", name, "this effect is not known", nearest(name, known))
    return [_learned(each, arm_type) for each in placed]


def _learned(placed: Placed, arm_type: ArmType) -> Placed:
    sizes = arm_type.sizes.get(" at ".join(placed.key))
    if sizes is None or placed.parametrisation == "curve":
        return placed
    waves = placed.parametrisation == "sine"  # an amplitude is told of several equal parts
    names = ["amplitude" if waves else term.name for term in placed.terms]
    units = ["rad" if waves else term.unit for term in placed.terms]
    parts = len(placed.terms) if waves else 1
    terms = tuple(
        replace(term, learned=_size(term, sizes[name], parts)) if name in sizes and sizes[name].unit == unit else term
        for term, name, unit in zip(placed.terms, names, units, strict=True)
    )
    return replace(placed, terms=terms)


def _size(term: Term, learned: LearnedSize, parts: int) -> float:
    """SI; one arm more is as large as is plausible of any, and the rest moves it within bounds.

    As the mean of a scaled inverse chi-squared distribution moves from one pseudo-observation (Gelman et al., Bayesian
    Data Analysis, 3rd ed., section 2.6).
    """
    if not np.isfinite(term.plausible):
        return term.plausible
    shown = learned.rms * term.si / np.sqrt(parts)
    size = np.sqrt((term.plausible**2 + learned.arms * shown**2) / (1 + learned.arms))
    return float(np.clip(size, term.plausible / PLAUSIBLE.learned_within, term.plausible * PLAUSIBLE.learned_within))
