"""What could stand in an effect's place, and by how much rows tell the two apart."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from armscope.inference.evidence import Hypothesis
from armscope.inference.model_space import Candidate
from armscope.verdict.effects import INDISTINGUISHABLE_NATS


class Rival(NamedTuple):
    """What could stand in an effect's place."""

    gap: float  # nats by which it falls short
    # candidate, hypothesis: what it is, and the hypothesis with it
    candidate: Candidate
    hypothesis: Hypothesis
    near: bool  # whether its evidence is near enough for it to be listed whatever other rows say
    held: tuple[int, ...] = ()  # columns that are zero in it, though a background has them
    excluded: bool | None = None  # whether rows that took no part exclude it
    spared: float = 0.0  # nats that the effect did not pay, as one cause with others: by these it is no farther
    same_motion: bool = False  # whether it moves the tool as the effect does in every pose that the arm can take

    def in_background_of(self, effect: Candidate) -> bool:
        """Whether an effect and this are two of the many that one background holds."""
        return bool(self.held) and self.hypothesis.chosen[-1].nested and self.candidate.family == effect.family


def discriminability(best: Hypothesis, other: Hypothesis, effect: Candidate, rival: Candidate) -> float:
    """Nats by which the data tell an effect and its rival apart.

    The evidence also holds what a rival of one parameter more (a wave of free phase) pays for it; where the two fit
    alike, that is no measurement: such a rival counts by its fit alone. Larger ones fit anything and count in full.

    Args:
        best: the hypothesis with the effect.
        other: the one with its rival.
        effect: in place.
        rival: in place.

    Returns:
        Nats; negative where the rival fits better.
    """
    gap = best.log_posterior - other.log_posterior
    if len(rival.columns) > len(effect.columns) + 1:
        return gap
    return min(gap, max((other.rss - best.rss) / (2 * best.noise**2), 0.0))


def too_close(effect: Candidate, found: Sequence[Rival], apart: Sequence[float]) -> list[Candidate]:
    """Rivals beside which an effect's name is not sure: they fit as well, or what was free has not earned its name.

    A name out of a background paid nothing for being this one and no other of many; rows that took no part must
    exclude the others.

    Args:
        effect: that has the name.
        found: rivals, judged.
        apart: the `discriminability` of each, nats.

    Returns:
        What they are.
    """
    return [
        rival.candidate
        for rival, nats in zip(found, apart, strict=True)
        if rival.near
        and (
            nats - rival.spared < INDISTINGUISHABLE_NATS or (rival.excluded is False and rival.in_background_of(effect))
        )
    ]
