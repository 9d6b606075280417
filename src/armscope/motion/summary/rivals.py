"""What could stand in a cause's place."""

from __future__ import annotations

from collections.abc import Sequence

from armscope.inference.evidence import Hypothesis
from armscope.inference.model_space import Candidate
from armscope.inference.search import Search
from armscope.motion.constants import TELLING
from armscope.motion.library.catalogue import MASSES
from armscope.verdict.effects import Alternative


def listed_rivals(
    search: Search, best: Hypothesis, number: int, rivals: Sequence[Hypothesis], more: Sequence[Alternative] = ()
) -> tuple[Alternative, ...]:
    """Rivals of a cause that are told, nearest first, each name once.

    Args:
        search: on the selection's problem.
        best: what won.
        number: of the cause's candidate.
        rivals: hypotheses with another candidate, their last, in its place.
        more: rivals that are no candidates.

    Returns:
        The nearest.
    """
    candidate = search.space.candidates[number]
    rest = search.without(best, [number])
    taken = {search.space.candidates[c].key for c in best.candidates}
    limit = max(TELLING.listed_nats, TELLING.listed_share * (best.log_posterior - rest.log_posterior))
    nearest: dict[tuple[str, str], tuple[float, Candidate, float]] = {}
    for other in rivals:
        rival = search.space.candidates[other.chosen[-1].candidate]
        gap = max(
            best.log_posterior - other.log_posterior, 0.0
        )  # what is named for its plausibility may fit a bit worse
        if rival.key in taken or rival.key == candidate.key or gap > limit:
            continue
        if rival.key not in nearest or gap < nearest[rival.key][0]:
            nearest[rival.key] = (gap, rival, _apart(best, other, candidate, rival))
    listed = [Alternative(c.kind, c.location, c.family, gap, c.driver, by) for gap, c, by in nearest.values()]
    listed += [each for each in more if each.evidence_gap_nats < limit]
    return tuple(sorted(listed, key=lambda each: each.evidence_gap_nats)[: TELLING.listed])


def _apart(best: Hypothesis, other: Hypothesis, candidate: Candidate, rival: Candidate) -> float:
    """Nats by which rows tell a cause and its rival apart.

    What a link's centre pays for three numbers, where its mass has one, is no measurement of the same link.
    """
    gap = float(best.log_posterior - other.log_posterior)
    if not (candidate.location == rival.location and candidate.family == rival.family == MASSES):
        return gap
    return min(gap, max(float(other.rss - best.rss) / (2 * best.noise**2), 0.0))
