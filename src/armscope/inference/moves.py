"""Which of a hypothesis' effects are taken out together, when another one is tried in their place."""

from __future__ import annotations

from collections.abc import Sequence

from armscope.fitting.model_space import Pool
from armscope.physics.drift import BASE_DRIFT
from armscope.physics.effect import region


def block_removals(pool: Pool, chosen: Sequence[int]) -> list[tuple[int, ...]]:
    """Each effect by itself; all of one region; a drift and one more of the base."""
    return [*((candidate,) for candidate in chosen), *_regions(pool, chosen), *_drifting(pool, chosen)]


def _regions(pool: Pool, chosen: Sequence[int]) -> list[tuple[int, ...]]:
    by_region: dict[str, list[int]] = {}
    for candidate in chosen:
        by_region.setdefault(region(pool.candidates[candidate]), []).append(candidate)
    return [tuple(members) for members in by_region.values() if len(members) > 1]


def _drifting(pool: Pool, chosen: Sequence[int]) -> list[tuple[int, ...]]:
    """A drift and one more effect of the base, which a drift with other pauses may hold, where there are such."""
    base = [candidate for candidate in chosen if pool.candidates[candidate].location == "base"]
    drifts = [candidate for candidate in base if pool.candidates[candidate].effect is BASE_DRIFT]
    with_pauses = any(placed.effect is BASE_DRIFT and placed.multiplicity > 1 for placed in pool.candidates)
    return [(drift, other) for drift in drifts for other in base if other != drift] if with_pauses else []
