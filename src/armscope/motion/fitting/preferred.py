"""Of hypotheses that say nearly the same the plainest: a name, and a law of which nothing was scanned."""

from __future__ import annotations

from armscope.inference.evidence import Hypothesis
from armscope.inference.search import Search
from armscope.motion.constants import NOISE
from armscope.verdict.effects import INDISTINGUISHABLE_NATS, UNKNOWN


def named_first(search: Search, best: Hypothesis) -> Hypothesis:
    """Names in place of what has none wherever they explain nearly all that it does; a free curve's rest may stay.

    A curve fits every little thing about a real joint; that is no reason not to say what most of it is. A law of few
    numbers fits less by chance, and what it has beyond the name must be next to nothing.
    """
    for effect in best.chosen:
        candidate = search.candidate(effect.candidate)
        if candidate.family != UNKNOWN or not candidate.special_cases or effect not in best.chosen:
            continue
        base = search.without(best, [effect.candidate])
        others = set(range(len(search.space.candidates))) - candidate.special_cases
        named = base
        for _ in range(NOISE.names_for_a_curve):
            better = search.additions(named, 1, others)
            if not better or better[0].log_posterior <= named.log_posterior:
                break
            named = better[0]
        for added in named.chosen[len(base.chosen) :]:
            again = search.additions(search.without(named, [added.candidate]), 1, others)
            named = max([named, *again], key=lambda hypothesis: hypothesis.log_posterior)
        worth = best.log_posterior - base.log_posterior
        most = NOISE.nearly_all if candidate.is_curve else NOISE.nearly_all_of_a_law
        if named.log_posterior - base.log_posterior > most * worth:
            both = [search.evaluated((*named.chosen, effect), named)] if candidate.is_curve else []
            best = max([named, *both], key=lambda hypothesis: hypothesis.log_posterior)
    return best


def plain_first(search: Search, best: Hypothesis) -> Hypothesis:
    """Laws of which no number was scanned in place of others of the same cause that fit no better, within doubt.

    A spring that pulls in proportion to the angle is one between two links as well, for some mount far from any real
    one: which of the two has a little more evidence is a matter of priors, and the mount's numbers say nothing.
    """
    candidates = search.space.candidates
    for effect in best.chosen:
        own = search.candidate(effect.candidate)
        if own.family == UNKNOWN or own.multiplicity == 1:
            continue
        plain = {n for n in own.excludes if candidates[n].key == own.key and candidates[n].multiplicity == 1}
        others = set(range(len(candidates))) - plain
        rivals = search.additions(search.without(best, [effect.candidate]), 1, others) if plain else []
        if rivals and rivals[0].log_posterior > best.log_posterior - INDISTINGUISHABLE_NATS:
            best = rivals[0]
    return best
