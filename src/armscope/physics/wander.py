"""Wander: a base or instrument that moves a little and slowly in every session, allowed for without a name."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.cure import Cure
from armscope.physics.drift import LEAST_SPAN_S, six_terms
from armscope.physics.effect import Driver, Effect, Placed
from armscope.physics.placing import varies
from armscope.physics.scene import numbers_of_rows
from armscope.physics.set_ups import SetUps
from armscope.recordings import Recordings

WAVE_OF_ROWS = "slow wave of rows"
WANDER_WAVES, ROWS_PER_WAVE = 6, 12
"""Half waves of a set-up's slow wander at most, and rows for each of them: what is faster is hardly a set-up's."""

BASE_WANDER = Effect(
    "base_wander",
    "drift",
    lambda arm, recordings: iter(()),
    "The base or the instrument wanders a little in the course of the recording, as any set-up does.",
    "Measure fixed reference points on the base now and then.",
    Cure("Nothing to cure."),
)
"""Allowed for, never named: what stands out of it is a drift or a jump."""


def wander(recordings: Recordings, set_ups: SetUps) -> list[Placed]:
    """A base that wanders slowly in the order of time, and stands a little elsewhere in each run of a set-up.

    A random walk in the waves that count, its cosines falling with their number (Karhunen-Loeve). In time where it is
    recorded, else in the order of rows. All waves together, and every run, are as large as is plausible.

    Args:
        recordings: the table.
        set_ups: runs that share a base.

    Returns:
        Waves, then runs, in place.
    """
    count = min(WANDER_WAVES, len(recordings) // ROWS_PER_WAVE)
    along, kind = _clock(recordings)
    if not np.ptp(along) > 0:
        count = 0
    falling = 1 / np.arange(1, count + 1)
    falling /= np.sqrt(np.sum(falling**2))
    ends = float(along.min()), float(along.max())
    waves = [_wandering(Driver(kind, (k, *ends)), share, f"wave {k}") for k, share in enumerate(falling.tolist(), 1)]
    together = [run for runs in set_ups if len(runs) > 1 for run in runs]
    return [*waves, *(_wandering(Driver("during run", (run,)), 1.0, f"run {run}") for run in together)]


def _wandering(driver: Driver, share: float, variant: str) -> Placed:
    sizes = (PLAUSIBLE.wander_m,) * 3 + (PLAUSIBLE.wander_rad,) * 3
    terms = six_terms("base", driver)
    return Placed(BASE_WANDER, "base", terms, tuple(share * size for size in sizes), "time", variant=variant)


def is_of_rows(placed: Placed) -> bool:
    """Whether an effect follows the order of the rows it was learned from, which says nothing of other rows."""
    return placed.terms[0].products[0].driver.kind == WAVE_OF_ROWS


def _clock(recordings: Recordings) -> tuple[Array, str]:
    """(N,) what orders the rows, and the kind of driver that has waves along it."""
    time = recordings.time
    if time is not None and np.isfinite(time).all() and varies(time, LEAST_SPAN_S):
        return time, "slow wave"
    return numbers_of_rows(recordings), WAVE_OF_ROWS
