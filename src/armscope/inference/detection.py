"""Is anything missing at all? All that could be wrong together against a perfect arm, before anything gets a name.

A name must stand out from nothing by itself. That something is missing is known earlier: every candidate, at every
place and size, adds its share of the odds (the evidence averaged over the space, Kass & Raftery 1995), and so does each
family's background.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from armscope.core.types import Array
from armscope.inference.additions import addition_scores
from armscope.inference.constants import DETECTION, PRIORS
from armscope.inference.edits import Edits
from armscope.inference.model_space import Candidate


@dataclass(frozen=True)
class Detection:
    """What is known before anything is named."""

    log_odds: float  # that anything is missing, nats
    size_mm: float  # of the likeliest single effect at the tool
    region: str | None  # the one that holds nearly all of the odds, if one does
    likeliest: tuple[Candidate, ...]  # candidates in order of their odds, each kind at each location once

    @property
    def detected(self) -> bool:
        """Whether something is missing beyond reasonable doubt."""
        return self.log_odds > DETECTION.detected_nats


def averaged_log_odds(edits: Edits) -> Detection:
    """The odds that anything is missing, against a perfect arm."""
    problem, space = edits.problem, edits.space
    by_size = addition_scores(problem, edits.groups, edits.perfect()) + PRIORS.sure_nats
    by_size[:, list(space.requires)] = -np.inf
    effects = logsumexp(by_size, axis=0)
    backgrounds = _background_odds(edits)
    # a background is one more kind of error
    shares = np.log(space.kinds / (space.kinds + len(backgrounds)))
    everything = np.concatenate([effects, backgrounds]) + shares
    order = np.argsort(-effects)
    size = float(problem.sizes[int(np.argmax(by_size[:, order[0]]))])
    likeliest = {space.candidates[c].key: space.candidates[c] for c in order[: 3 * DETECTION.listed]}
    return Detection(
        float(logsumexp(everything)),
        size,
        _region(space.candidates, effects),
        tuple(list(likeliest.values())[: DETECTION.listed]),
    )


def _background_odds(edits: Edits) -> Array:
    """(families,) log odds of each family's background alone, averaged over its sizes."""
    nothing = edits.perfect()
    odds = []
    for number, family in enumerate(edits.space.families):
        if not len(family.columns):
            continue
        alone = [edits.with_background(nothing, number, size) for size in range(1, family.sizes)]
        values = [each.log_posterior - nothing.log_posterior for each in alone]
        # one that is free in a hypothesis here pays like every kind
        paid = 0.0 if family.is_priced else np.log(edits.space.kinds) + np.log(len(values))
        odds.append(float(logsumexp(values)) - paid)
    return np.array(odds)


def _region(candidates: tuple[Candidate, ...], effects: Array) -> str | None:
    regions: dict[str, list[float]] = {}
    for candidate, odds in zip(candidates, effects, strict=True):
        regions.setdefault(candidate.region, []).append(float(odds))
    totals = {region: float(logsumexp(odds)) for region, odds in regions.items()}
    best = max(totals, key=lambda region: totals[region])
    return best if totals[best] - logsumexp(list(totals.values())) >= np.log(DETECTION.sure_of_place) else None
