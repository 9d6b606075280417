"""Offsets that a curve of the angle holds: a hose pulls one way at one end of its joint's range, another at the other.

Somewhere in the range it rests. A curve that pulls one way nearly all over it, and says hardly more than an offset, is
one.
"""

from __future__ import annotations

from collections.abc import Sequence

from armscope.inference.edits import by_posterior
from armscope.inference.evidence import Hypothesis
from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.motion.library import catalogue
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.layout import OWN
from armscope.verdict.effects import INDISTINGUISHABLE_NATS


def offsets_for_cables(search: Search, best: Hypothesis, placed: Sequence[PlacedCause]) -> Hypothesis:
    """Offsets in the place of cables that are mostly that, where the evidence hardly tells one from the other.

    Args:
        search: on the hypothesis' problem.
        best: a hypothesis.
        placed: what competes.

    Returns:
        The hypothesis, or one that is about as likely.
    """
    offsets = {cause.joints: n for n, cause in enumerate(placed) if cause.cause is catalogue.OFFSET}
    for effect in best.chosen:
        cause = placed[effect.candidate]
        if cause.cause is not catalogue.CABLE or not _is_mostly_offset(search, best, effect, cause.joints[0]):
            continue
        rest, offset = search.without(best, [effect.candidate]), offsets[cause.joints]
        sizes = range(len(search.problem.sizes))
        tried = [search.evaluated((*rest.chosen, SelectedEffect(offset, size)), rest) for size in sizes]
        told = max(tried, key=by_posterior)
        if told.log_posterior > best.log_posterior - INDISTINGUISHABLE_NATS:
            best = told
    return best


def _is_mostly_offset(search: Search, best: Hypothesis, cable: SelectedEffect, joint: int) -> bool:
    """Whether more of a curve's square is its mean's than what it varies by."""
    columns, constant = search.candidate(cable.candidate).columns, OWN * joint
    G, c = search.problem.equations.G, best.means(columns)
    mean = float(G[constant, columns] @ c) ** 2 / float(G[constant, constant])
    return mean > float(c @ G[columns][:, columns] @ c) / 2
