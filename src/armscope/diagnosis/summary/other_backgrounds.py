"""What backgrounds of other sizes would make of an effect: its interval owns what the rows leave open of them.

Which small errors an arm has everywhere is selected by evidence that pays a price for each family, lest there be too
many kinds of them. An interval need not pay: every arm gives way a little in all its joints. What is fitted is averaged
over the sizes of each family's background, none among them (Hoeting et al. 1999, "Bayesian model averaging").
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from scipy.special import softmax

from armscope.core.types import Array
from armscope.inference.edits import replaced
from armscope.inference.evidence import Hypothesis
from armscope.inference.search import Search


def doubts(search: Search, best: Hypothesis) -> Mapping[int, Array]:
    """What the covariance of each effect's values gains when backgrounds may have other sizes; not of free curves.

    Returns:
        By candidate, (k, k) in SI units: the spread about the values as they are told, beyond their covariance.
    """
    chosen = {c.candidate: search.candidate(c.candidate) for c in best.chosen}
    own = {number: candidate.columns for number, candidate in chosen.items() if not candidate.is_curve}
    gained = {n: np.zeros((len(columns), len(columns))) for n, columns in own.items()}
    for readings, weights in _by_family(search, best):
        for n, columns in own.items():
            told, within = best.means(columns), best.covariance(columns)
            for other, weight in zip(readings, weights, strict=True):
                away = other.means(columns) - told
                gained[n] += weight * (other.covariance(columns) - within + np.outer(away, away))
    scale = search.problem.scale
    return {n: _positive(extra) / np.outer(scale[own[n]], scale[own[n]]) for n, extra in gained.items()}


def _by_family(search: Search, best: Hypothesis) -> Iterator[tuple[list[Hypothesis], Array]]:
    """The effects with each size of a family's background, the others as they are; and how likely each is."""
    unpaid = np.log(search.space.kinds)
    for number, family in enumerate(search.space.families):
        sizes = [replaced(best.background, number, size) for size in range(family.sizes)]
        readings = [search.evaluated(best.chosen, best, background) for background in sizes]
        likely = [r.log_posterior + unpaid * (family.is_priced and size > 0) for size, r in enumerate(readings)]
        yield readings, softmax(np.array(likely))


def _positive(symmetric: Array) -> Array:
    """A symmetric matrix without what would take away from another's spread."""
    size, axes = np.linalg.eigh((symmetric + symmetric.T) / 2)
    return np.asarray((axes * np.maximum(size, 0.0)) @ axes.T)
