"""Which models held-out rows don't exclude: the model confidence set of Hansen, Lunde & Nason (2011), Econometrica 79.

Models are compared by their losses on blocks of rows. The worst leaves the set as long as equal models would differ by
as much in fewer than one draw in twenty, blocks being drawn with replacement; what remains holds the best model with
95 % confidence.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.inference.constants import CONFIDENCE


def confidence_set(losses: Array, rng: np.random.Generator) -> NDArray[np.bool_]:
    """Which models are in the set.

    Args:
        losses: (blocks, models) of held-out rows, in any unit; blocks are taken to be independent.
        rng: draws blocks.

    Returns:
        (models,) whether each is not excluded.
    """
    count, models = losses.shape
    inside = np.ones(models, dtype=bool)
    if count < CONFIDENCE.fewest_blocks:
        return inside
    drawn = rng.multinomial(count, np.full(count, 1 / count), CONFIDENCE.draws) / count
    while inside.sum() > 1:
        against = losses[:, inside] - losses[:, inside].mean(axis=1, keepdims=True)
        mean = against.mean(axis=0)
        scattered = drawn @ against - mean
        error = np.maximum(scattered.std(axis=0), 1e-12 * np.abs(losses).max())
        worse = mean / error
        chance = np.mean((scattered / error).max(axis=1) >= worse.max())
        if chance >= CONFIDENCE.chance:
            break
        inside[np.flatnonzero(inside)[int(np.argmax(worse))]] = False
    return inside
