"""Is anything missing at all? All that could be wrong together against a perfect arm, before anything gets a name.

A name must stand out from nothing by itself. That something is missing is known earlier: every effect of the library,
at every place and size, adds its share of the odds (the evidence averaged over the library, Kass & Raftery 1995), and
so does each family's background.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from armscope.core.types import Array
from armscope.inference.evidence import BACKGROUND_SIZES, FAMILY_SIZES, SURE_NATS, kinds
from armscope.inference.search import Search
from armscope.inference.updates import addition_scores
from armscope.physics.effect import Placed, region

DETECTED_NATS = 2.0
"""Log odds from which something is said to be missing: no false alarm in 600 simulated clean arms. (Where nothing is
missing, an average of evidence exceeds log odds x with a chance of exp(-x) at most; in fact far less often.)"""
SURE_OF_PLACE = 0.95
LISTED = 3


@dataclass(frozen=True)
class Detection:
    """What is known before anything is named.

    Attributes:
        log_odds: that anything is missing, nats.
        size_mm: of the likeliest single effect at the tool.
        location: the place that holds nearly all of the odds, if one does.
        likeliest: effects in order of their odds.
    """

    log_odds: float
    size_mm: float
    location: str | None
    likeliest: tuple[Placed, ...]

    @property
    def detected(self) -> bool:
        """Whether something is missing beyond reasonable doubt."""
        return self.log_odds > DETECTED_NATS


def averaged_log_odds(search: Search) -> Detection:
    """The odds that anything is missing, against a perfect arm."""
    problem = search.problem
    nothing = search.perfect()
    by_size = addition_scores(problem, search.groups, nothing) + SURE_NATS
    by_size[:, list(problem.pool.requires)] = -np.inf
    effects = logsumexp(by_size, axis=0)
    backgrounds = _background_odds(search)
    # a background is one more kind of error
    shares = np.log(kinds(problem.pool) / (kinds(problem.pool) + len(backgrounds)))
    everything = np.concatenate([effects, backgrounds]) + shares
    order = np.argsort(-effects)
    size = float(problem.sizes[int(np.argmax(by_size[:, order[0]]))])
    likeliest = {problem.pool.candidates[c].key: problem.pool.candidates[c] for c in order[: 3 * LISTED]}
    return Detection(
        float(logsumexp(everything)), size, _place(search, effects), tuple(list(likeliest.values())[:LISTED])
    )


def _background_odds(search: Search) -> Array:
    """(families,) log odds of each family's background alone, averaged over its sizes."""
    nothing = search.perfect()
    odds = []
    for family, columns in enumerate(search.problem.pool.background):
        if not len(columns):
            continue
        sizes = range(1, len(BACKGROUND_SIZES) if family == 0 else FAMILY_SIZES)
        alone = [tuple(size if n == family else 0 for n in range(len(nothing.background))) for size in sizes]
        values = [
            search.with_background(nothing, background).log_posterior - nothing.log_posterior for background in alone
        ]
        # the geometric one is free in a hypothesis; here it pays like every kind
        paid = 0.0 if family else np.log(kinds(search.problem.pool)) + np.log(len(values))
        odds.append(float(logsumexp(values)) - paid)
    return np.array(odds)


def _place(search: Search, effects: Array) -> str | None:
    places: dict[str, list[float]] = {}
    for placed, odds in zip(search.problem.pool.candidates, effects, strict=True):
        places.setdefault(region(placed), []).append(float(odds))
    totals = {place: float(logsumexp(odds)) for place, odds in places.items()}
    best = max(totals, key=lambda place: totals[place])
    if totals[best] - logsumexp(list(totals.values())) < np.log(SURE_OF_PLACE):
        return None
    return f"joint {best}" if best.isdigit() else best
