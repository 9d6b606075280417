"""What is wrong, in a few causes: family first, then place, then effect, as deep as the evidence goes.

The effects of one family, and the small errors of that family that were allowed for everywhere, are one cause: who
mends it does one thing, a geometric calibration or an elastic model in the controller, however many names it has.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from armscope.core.location import Location
from armscope.diagnosis.held_out_worth import held_out_gains, without_members
from armscope.diagnosis.state import DiagnosisState
from armscope.inference.search import Search
from armscope.physics.backgrounds import FAMILIES, MENDED
from armscope.verdict.effects import Cause, CauseLevel, FoundEffect
from armscope.verdict.family_cures import cure_of_family, mended_together
from armscope.verdict.schema import Background
from armscope.verdict.sentences import cause_in_words

EVERYWHERE = "arm"
"""The place of what is so in all joints and links."""


def causes(
    state: DiagnosisState,
    search: Search,
    named: Mapping[int, FoundEffect],
    others: Sequence[FoundEffect],
    background: Sequence[Background],
) -> tuple[Cause, ...]:
    """The causes, largest share first.

    Args:
        state: the finished selection.
        search: its search.
        named: effects by candidate.
        others: effects that are no candidates: scatter.
        background: what is small everywhere, by family.

    Returns:
        One cause per family that has effects or a background, and per kind of what its calibration does not mend.
    """
    members: dict[str, list[FoundEffect]] = {}
    candidates: dict[str, list[int]] = {}
    for candidate, effect in named.items():
        members.setdefault(mended_together(effect), []).append(effect)
        candidates.setdefault(mended_together(effect), []).append(candidate)
    for effect in others:
        members.setdefault(mended_together(effect), []).append(effect)
    everywhere = {family.family: family for family in background if family.present and family.family in MENDED}
    families = [*members, *(family for family in everywhere if family not in members)]
    readings = [
        without_members(
            search,
            state.best,
            candidates.get(family, []),
            [FAMILIES.index(member) for member in MENDED[family]] if family in everywhere else [],
        )
        for family in families
    ]
    gains = held_out_gains(state.problem, state.blocks, state.best, readings)
    found = [
        _cause(state, family, members.get(family, []), everywhere.get(family), float(gain))
        for family, gain in zip(families, gains, strict=True)
    ]
    return tuple(sorted(found, key=lambda cause: -cause.share))


def _cause(
    state: DiagnosisState, family: str, members: Sequence[FoundEffect], small: Background | None, gain: float
) -> Cause:
    ordered = sorted(members, key=lambda effect: -effect.share)
    level, place = _level(ordered, small is not None)
    squared = state.best.noise**2 * gain / max(state.problem.n, 1.0)
    left = state.fit.noise
    return Cause(
        family=ordered[0].family if ordered else family,
        level=level,
        place=place,
        members=tuple(effect.as_member for effect in ordered),
        everywhere=small is not None,
        minor=all(effect.minor for effect in ordered) and small is None,
        share=sum(effect.share for effect in ordered) + (small.share if small else 0.0),
        held_out_gain_mm=float(np.sqrt(max(left**2 + squared, 0.0)) - left),
        text=cause_in_words(family, ordered, small),
        cure=cure_of_family(family, ordered, small is not None, small.worst if small else ""),
    )


def _level(members: Sequence[FoundEffect], everywhere: bool) -> tuple[CauseLevel, str]:
    """How deep the evidence goes, and the place at that depth."""
    places = {effect.location for effect in members}
    if everywhere or not members:
        return "family", EVERYWHERE
    if len(members) == 1:
        return ("effect" if members[0].named_as == "effect" else "place"), members[0].location
    regions = {Location.of(place).region for place in places}
    return ("place", members[0].location) if len(regions) == 1 else ("family", EVERYWHERE)
