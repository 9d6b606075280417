"""A link's own error in place of what can't be told from it: a load that hardly varies, a wobble hardly turned.

A bearing that tilts under a load that is the same in all poses is a link that is twisted. It pays for one number where
a link pays for all of its row, and so comes first although it fits no better. Every arm has errors of its links, and in
poses like the recorded ones the corrected row takes the tool where it should go in either case; a new bearing does in
one. The other stands as what it may be as well. A wobble that turns with its joint, once per turn, is always the same
as a link that is twisted and the zero of the next joint: a bearing of which nobody could tell that it is worn.
"""

from __future__ import annotations

from armscope.inference.edits import Edits
from armscope.inference.evidence import Hypothesis
from armscope.inference.problem import SelectedEffect
from armscope.physics.effect import Effect
from armscope.physics.elastic import LINK_BENDING
from armscope.physics.geometric import JOINT_OFFSET, LINK_GEOMETRY
from armscope.physics.instrument import INSTRUMENT_SCALE
from armscope.physics.tilting import BEARING_COMPLIANCE
from armscope.physics.wobble import AXIS_WOBBLE
from armscope.verdict.effects import INDISTINGUISHABLE_NATS

LIKE_A_LINK = {effect.name for effect in (BEARING_COMPLIANCE, LINK_BENDING, AXIS_WOBBLE, INSTRUMENT_SCALE)}
"""What turns a link's frame against its neighbour's, as an error of the link does, or makes all links longer, of which
base and tool take up the first and the last.
"""


def as_plain_geometry(edits: Edits, hypothesis: Hypothesis) -> Hypothesis:
    """The hypothesis with a link's constant errors in place of each effect that explains the rows no better.

    Args:
        edits: of the search.
        hypothesis: named.

    Returns:
        The hypothesis with those names.
    """
    for effect in [c for c in hypothesis.chosen if edits.candidate(c.candidate).kind in LIKE_A_LINK]:
        instead = _as_good(edits, hypothesis, effect)
        hypothesis = hypothesis if instead is None else instead
    return hypothesis


def _as_good(edits: Edits, hypothesis: Hypothesis, effect: SelectedEffect) -> Hypothesis | None:
    """With the link that comes nearest, if rows tell it from the effect at less than odds of 20 to 1.

    In place of a wobble a link and a zero will do, too.
    """
    held = edits.holding(edits.candidate(effect.candidate).held)
    alone = _with_one(held, held.without(hypothesis, [effect.candidate]), LINK_GEOMETRY)
    wobbles = edits.candidate(effect.candidate).kind == AXIS_WOBBLE.name
    pairs = [pair for link in alone for pair in _with_one(held, link, JOINT_OFFSET)] if wobbles else []
    for other in (*alone[:1], *pairs):
        worse = (other.rss - hypothesis.rss) / (2 * hypothesis.noise**2)
        if worse < INDISTINGUISHABLE_NATS:
            return edits.evaluated(other.chosen, hypothesis)
    return None


def _with_one(edits: Edits, base: Hypothesis, effect: Effect) -> list[Hypothesis]:
    """With one place more of an effect, the two most promising."""
    others = {n for n, candidate in enumerate(edits.space.candidates) if candidate.kind != effect.name}
    return edits.additions(base, 2, others)
