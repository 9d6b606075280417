"""Random search: what a swarm must beat to be worth its name."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from armscope.swarm.engine import Objective, checked_box
from armscope.swarm.result import StopReason, SwarmResult, final_reason
from armscope.swarm.settings import SwarmSettings


def random_search(
    objective: Objective,
    lower: ArrayLike,
    upper: ArrayLike,
    generators: Sequence[np.random.Generator],
    settings: SwarmSettings | None = None,
) -> SwarmResult:
    """The best of as many independent uniform points of the box as a swarm with these settings would evaluate.

    The points come in rounds of ``settings.particles``, so that its history stands beside a swarm's. Arguments, result
    and errors as `minimise`; update rule, neighbourhood and clamp have no meaning here, the threshold has.

    Args:
        objective: see `Objective`.
        lower, upper: the box, D or S x D for S generators.
        generators: one for each search.
        settings: how many points, and the threshold.

    Returns:
        The best point of each search, with its history by rounds.
    """
    settings = settings or SwarmSettings()
    low, high = checked_box(lower, upper, len(generators))
    parts = [
        _search_one(objective, low[row], high[row], generator, row, settings)
        for row, generator in enumerate(generators)
    ]
    return SwarmResult.joined(parts)


def _search_one(
    objective: Objective,
    lower: np.ndarray,
    upper: np.ndarray,
    generator: np.random.Generator,
    number: int,
    settings: SwarmSettings,
) -> SwarmResult:
    rounds = settings.iterations + 1
    points = lower + (upper - lower) * generator.random((rounds, settings.particles, len(lower)))
    fitness = np.asarray(objective(points, np.full(rounds, number)))
    fitness = np.where(np.isfinite(fitness), fitness, np.inf)
    history = np.minimum.accumulate(fitness.min(axis=1))
    last, reason = rounds - 1, final_reason(history[-1])
    if settings.threshold is not None and history[-1] < settings.threshold:
        last, reason = int(np.argmax(history < settings.threshold)), StopReason.THRESHOLD
        history[last:] = history[last]
    best = np.unravel_index(np.argmin(fitness[: last + 1]), (last + 1, settings.particles))
    position = points[best] if np.isfinite(history[last]) else np.full(len(lower), np.nan)
    reasons = np.empty(1, dtype=object)
    reasons[0] = reason
    return SwarmResult(position[None], history[last:][:1].copy(), history[None], np.array([last]), reasons)
