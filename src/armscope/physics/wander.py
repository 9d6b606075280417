"""Wander: set-ups that move and links that warm up a little and slowly, as in every session, allowed for, not named."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.drift import six_terms
from armscope.physics.effect import Cure, Driver, Effect, Placed, Product, Term, term
from armscope.physics.form_constants import FORM
from armscope.physics.placing import nowhere, varies
from armscope.physics.set_ups import SetUps
from armscope.physics.thermal import growing_links
from armscope.recordings import Recordings
from armscope.robot import Arm

WAVE_OF_ROWS = "slow wave of rows"

BASE_WANDER = Effect(
    "base_wander",
    "drift",
    nowhere,
    "The base or the instrument wanders a little in the course of the recording, as any set-up does.",
    "Measure fixed reference points on the base now and then.",
    Cure("Nothing to cure."),
)
"""Allowed for, never named: what stands out of it is a drift or a jump."""

LINK_WANDER = Effect(
    "link_wander",
    "drift",
    nowhere,
    "Links warm up and cool down a little in the course of the recording, whatever a thermometer in the hall says.",
    "Measure one pose now and then.",
    Cure("Record `temperature_c` beside the poses, best the link's own, and diagnose again."),
)
"""Allowed for, never named: what follows the recorded temperature is thermal expansion."""


def wander(recordings: Recordings, set_ups: SetUps) -> list[Placed]:
    """A base that wanders slowly in the order of time, and stands a little elsewhere in each run of a set-up.

    A random walk in the waves that count, its cosines falling with their number (Karhunen-Loeve). In time where it is
    recorded, else in the order of rows. All waves together, and every run, are as large as is plausible.
    """
    waves = [_wandering(driver, share, f"wave {k}") for k, driver, share in _waves(recordings, FORM.wander_waves)]
    if any(map(is_of_rows, waves)):
        waves = [_about_runs(wave, recordings) for wave in waves]
    together = [run for runs in set_ups if len(runs) > 1 for run in runs]
    return [*waves, *(_wandering(Driver("during run", (run,)), 1.0, f"run {run}") for run in together)]


def _wandering(driver: Driver, share: float, variant: str) -> Placed:
    sizes = (PLAUSIBLE.wander_m,) * 3 + (PLAUSIBLE.wander_rad,) * 3
    terms = six_terms("base", driver)
    return Placed(BASE_WANDER, "base", terms, tuple(share * size for size in sizes), "time", variant=variant)


def link_wander(arm: Arm, recordings: Recordings) -> list[Placed]:
    """Links whose lengths change slowly in the order of time: a hall's day, and links that follow it late."""
    waves = [
        _growing(place, products, share, f"wave {k}")
        for k, driver, share in _waves(recordings, FORM.growth_waves)
        for place, products in growing_links(arm, driver)
    ]
    runs = [str(run) for run in np.unique(recordings.run)]
    if len(runs) == 1 or not any(map(is_of_rows, waves)):
        return waves
    of_runs = [
        _growing(place, products, 1.0, f"run {run}")
        for run in runs
        for place, products in growing_links(arm, Driver("during run", (run,)))
    ]
    return [*(_about_runs(wave, recordings) for wave in waves), *of_runs]


def _growing(place: str, products: tuple[Product, ...], share: float, variant: str) -> Placed:
    growth = term("growth", "m/m", *products)
    return Placed(LINK_WANDER, place, (growth,), (share * PLAUSIBLE.growth,), "time", variant=variant)


def _waves(recordings: Recordings, most: int) -> Iterator[tuple[int, Driver, float]]:
    """Numbers of slow waves, from 1, what they follow, and their shares, whose squares add up to one."""
    count = min(most, len(recordings) // FORM.rows_per_wander_wave)
    along, kind = _clock(recordings)
    if not np.ptp(along) > 0:
        return
    falling = 1 / np.arange(1, count + 1)
    falling /= np.sqrt(np.sum(falling**2))
    ends = float(along.min()), float(along.max())
    for k, share in enumerate(falling.tolist(), 1):
        yield k, Driver(kind, (k, *ends)), share


def _about_runs(wave: Placed, recordings: Recordings) -> Placed:
    """A wave in the order of rows without its mean in each run, which is the run's: that holds for its other rows."""
    count, first, last = (wave.terms[0].products[0].driver.number(n) for n in range(3))
    course = np.cos(np.pi * count * (recordings.number - first) / (last - first))
    means = {str(run): float(course[recordings.run == run].mean()) for run in np.unique(recordings.run)}

    def about(each: Term) -> Term:
        less = [
            replace(product, driver=Driver("rows in run", (run,)), factor=-mean * product.factor)
            for product in each.products
            for run, mean in means.items()
        ]
        return replace(each, products=(*each.products, *less))

    return wave if len(means) == 1 else replace(wave, terms=tuple(map(about, wave.terms)))


def is_of_rows(placed: Placed) -> bool:
    """Whether an effect follows the order of the rows it was learned from, which says nothing of other rows."""
    return placed.terms[0].products[0].driver.kind == WAVE_OF_ROWS


def _clock(recordings: Recordings) -> tuple[Array, str]:
    """(N,) what orders the rows, and the kind of driver that has waves along it."""
    time = recordings.time
    if time is not None and np.isfinite(time).all() and varies(time, FORM.least_span_s):
        return time, "slow wave"
    return recordings.number, WAVE_OF_ROWS
