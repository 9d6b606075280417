"""A link that bends is told only where rows tell it from what every arm has: all joints and links give way a little.

Drives make up most of it (Dumas et al. 2011 leave links out), and two soft joints move the tool much as the bending of
the link between them does. One name for the link costs less than one for each of the joints.
"""

from __future__ import annotations

from armscope.diagnosis.free_curves import told_by_laws
from armscope.diagnosis.model_space import EffectSpace
from armscope.inference.constants import PRIORS
from armscope.inference.edits import Edits
from armscope.inference.evidence import Hypothesis
from armscope.physics.backgrounds import ELASTIC, FAMILIES
from armscope.physics.elastic import LINK_BENDING

GIVE = FAMILIES.index(ELASTIC)


def told_plainly(edits: Edits, space: EffectSpace, hypothesis: Hypothesis) -> Hypothesis:
    """A hypothesis with the plainer reading wherever rows do not tell it from the other: laws for curves, and this.

    Args:
        edits: of the problem that the hypothesis is of.
        space: what its candidates are.
        hypothesis: as the search found it.

    Returns:
        The hypothesis that is told.
    """
    return told_as_ordinary(edits, space, told_by_laws(edits, hypothesis))


def told_as_ordinary(edits: Edits, space: EffectSpace, hypothesis: Hypothesis) -> Hypothesis:
    """A hypothesis with a little give everywhere in a bending link's place, if not told from it at odds of 20 to 1.

    Args:
        edits: of the problem that the hypothesis is of.
        space: what its candidates are.
        hypothesis: as the search found it.

    Returns:
        The hypothesis; as it is where it holds such a background already, or no bending link.
    """
    if hypothesis.background[GIVE]:
        return hypothesis
    for link in [c for c in hypothesis.candidates if space.placed[c].effect is LINK_BENDING]:
        rest, sizes = edits.without(hypothesis, [link]), range(1, edits.space.families[GIVE].sizes)
        best = max((edits.with_background(rest, GIVE, size) for size in sizes), key=lambda h: h.log_posterior)
        if best.log_posterior > hypothesis.log_posterior - PRIORS.sure_nats:
            return best
    return hypothesis
