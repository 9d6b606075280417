"""Which of a verdict's effects is which concealed one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import linear_sum_assignment

from armscope.proof.answers import NamedEffect
from armscope.proof.definitions import Name, place
from armscope.proof.truth import Concealed

UNKNOWN = "unknown"
_OWN, _ALTERNATIVE, _BACKGROUND, _NEVER = 0.0, 1.0, 2.0, 1e6


@dataclass(frozen=True)
class Match:
    """A concealed effect, the claim that stands for it, and how: see the outcomes in `definitions`."""

    truth: Concealed
    claim: NamedEffect | None
    outcome: str

    @property
    def right(self) -> bool:
        """Whether an acceptable name was given."""
        return self.outcome in ("named", "acceptable")


def distinct(claims: Sequence[NamedEffect]) -> list[NamedEffect]:
    """One claim per name: the largest; minor only if all of that name are."""
    by_name: dict[Name, NamedEffect] = {}
    for claim in sorted(claims, key=lambda claim: -claim.rms_mm):
        first = by_name.setdefault(claim.name, claim)
        if first.minor and not claim.minor:
            by_name[claim.name] = replace(first, minor=False)
    return list(by_name.values())


def match(concealed: Sequence[Concealed], claims: Sequence[NamedEffect]) -> tuple[list[Match], list[NamedEffect]]:
    """Concealed effects with the claims that stand for them, and the claims left over.

    As many as possible in all; among those, own names before alternatives, and the story before the background.

    Args:
        concealed: all of a world's effects.
        claims: distinct claims.
    """
    pairs: dict[int, int] = {}
    if concealed and claims:
        price = np.array([[_price(truth, claim) for claim in claims] for truth in concealed])
        rows, columns = linear_sum_assignment(price)
        pairs = {int(r): int(c) for r, c in zip(rows, columns, strict=True) if price[r, c] < _NEVER}
    left = [claim for number, claim in enumerate(claims) if number not in pairs.values()]
    matches = []
    for number, truth in enumerate(concealed):
        if number in pairs:
            claim = claims[pairs[number]]
            matches.append(Match(truth, claim, "named" if claim.name == truth.name else "acceptable"))
        else:
            matches.append(_unmatched(truth, claims, left))
    return matches, left


def _price(truth: Concealed, claim: NamedEffect) -> float:
    if claim.name == truth.name:
        return _BACKGROUND if truth.minor else _OWN
    return _ALTERNATIVE if claim.name in truth.alternatives else _NEVER


def _unmatched(truth: Concealed, claims: Sequence[NamedEffect], left: Sequence[NamedEffect]) -> Match:
    listing = next((claim for claim in claims if truth.name in claim.alternatives), None)
    if listing is not None:
        return Match(truth, listing, "listed")
    there = [claim for claim in left if place(claim.location) == place(truth.location)]
    return Match(truth, there[0], "located") if there else Match(truth, None, "missed")


def among_all(truth: Concealed, claims: Sequence[NamedEffect]) -> bool:
    """Whether the truth is among the effects, or among the alternatives that the verdict itself lists."""
    return any(truth.name == claim.name or truth.name in claim.alternatives for claim in claims)
