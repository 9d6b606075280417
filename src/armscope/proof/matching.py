"""Which of a verdict's effects is which concealed one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import linear_sum_assignment

from armscope.proof.answers import NamedEffect
from armscope.proof.definitions import Name, place
from armscope.proof.truth import Concealed
from armscope.verdict.effects import UNKNOWN

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


def outside_outcome(matches: Sequence[Match], left: Sequence[NamedEffect], said: bool) -> str:
    """How a world outside the library was answered, by a diagnosis that did not fail; see `definitions`.

    Args:
        matches: concealed effects, minor ones too, with the claims that stand for them.
        left: claims that stand for none.
        said: whether anything was said.

    Returns:
        The outcome's name.
    """
    where = {place(found.truth.location) for found in matches if not found.truth.minor}
    names = [claim for claim in left if claim.effect != UNKNOWN]
    if all(found.right for found in matches):
        if not names:
            return "located" if all(found.outcome == "named" for found in matches) else "acceptable"
        return "partly named" if {place(claim.location) for claim in names} <= where else "misnamed"
    if names:
        return "misnamed"
    return "elsewhere" if said else "missed"


def name_row(concealed: Sequence[Concealed], claim: NamedEffect, right: bool) -> dict[str, object]:
    """A claim as a case.

    Args:
        concealed: all of a world's effects.
        claim: a name given there.
        right: whether it stands for one of them.

    Returns:
        Its row in the table of names.
    """
    acceptable = {name for effect in concealed for name in (effect.name, *effect.alternatives)}
    return {
        "effect": claim.effect,
        "location": claim.location,
        "minor": claim.minor,
        "named_as": claim.named_as,
        "evidence_nats": claim.evidence_nats,
        "rms_mm": claim.rms_mm,
        "right": right,
        "effect_right": claim.effect in {effect for effect, _ in acceptable},
    }


def effect_row(found: Match, claims: Sequence[NamedEffect]) -> dict[str, object]:
    """A concealed effect as a case."""
    truth, claim = found.truth, found.claim
    return {
        "effect": truth.effect,
        "location": truth.location,
        "shape": truth.shape,
        "driver": truth.driver,
        "minor": truth.minor,
        "strength": truth.strength,
        "outcome": found.outcome,
        "right": found.right,
        "ambiguous": bool(truth.alternatives),
        "among_all": among_all(truth, claims),
        "said_effect": claim.effect if claim else "",
        "said_location": claim.location if claim else "",
        "said_driver": claim.driver if claim else "",
    }


def among_all(truth: Concealed, claims: Sequence[NamedEffect]) -> bool:
    """Whether the truth is among the effects, or among the alternatives that the verdict itself lists."""
    return any(truth.name == claim.name or truth.name in claim.alternatives for claim in claims)
