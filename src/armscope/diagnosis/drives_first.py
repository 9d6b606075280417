"""Drives before links: a link that bends is told only where rows tell it from drives that all give way a little.

Two soft joints move the tool much as the bending of the link between them does, and one name for the link costs less
than one for each of them. Most of what an arm gives way is its drives'.
"""

from __future__ import annotations

from armscope.inference.edits import Edits
from armscope.inference.evidence import Hypothesis
from armscope.physics.backgrounds import ELASTIC, FAMILIES
from armscope.physics.elastic import LINK_BENDING
from armscope.verdict.effects import INDISTINGUISHABLE_NATS

GIVE = FAMILIES.index(ELASTIC)


def drives_first(edits: Edits, hypothesis: Hypothesis) -> Hypothesis:
    """The hypothesis with a little give everywhere in place of each link that bends no better.

    Args:
        edits: of the search.
        hypothesis: that the search found.

    Returns:
        The hypothesis.
    """
    for effect in [c for c in hypothesis.chosen if edits.candidate(c.candidate).kind == LINK_BENDING.name]:
        instead = little_give_instead(edits, hypothesis, effect.candidate)
        hypothesis = hypothesis if instead is None else instead
    return hypothesis


def little_give_instead(edits: Edits, hypothesis: Hypothesis, link: int, unlawful: float = 0.0) -> Hypothesis | None:
    """A hypothesis with a little give everywhere in a link's place, if rows hardly tell it from the link.

    Args:
        edits: of the problem that the hypothesis is of.
        hypothesis: that holds the link.
        link: number of its candidate.
        unlawful: share of what the link explains that tells no two laws apart, since no part keeps its own exactly.

    Returns:
        The other hypothesis; None where rows tell the two apart, or the first holds a little give already.
    """
    if hypothesis.background[GIVE]:
        return None
    rest, sizes = edits.without(hypothesis, [link]), range(1, edits.space.families[GIVE].sizes)
    best = max((edits.with_background(rest, GIVE, size) for size in sizes), key=lambda h: h.log_posterior)
    worth = hypothesis.log_posterior - rest.log_posterior
    told_apart = max(INDISTINGUISHABLE_NATS, unlawful * worth)
    return best if best.log_posterior > hypothesis.log_posterior - told_apart else None
