"""One card per effect: everything a person needs to believe it, check it and cure it."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from armscope.physics.registry import effect_named
from armscope.verdict.constants import WORDS
from armscope.verdict.effects import INDISTINGUISHABLE_NATS, INTERVAL, Alternative, FoundEffect, Parameter
from armscope.verdict.moments import since
from armscope.verdict.told_causes import of_what_calibration_leaves
from armscope.verdict.untold import absorbed, implausible
from armscope.verdict.wording import (
    Reading,
    capitalised,
    effect_in_words,
    evidence_in_words,
    millimetres,
    percent,
    plain,
    reach,
    read_parameter,
)

MOST_PARAMETERS = 8
UNKNOWN_MASSES = "compliance_times_moment"
HALF_A_PERIOD = {"phase": math.pi, "direction": math.pi / 2}
"""Where a wave is largest, and about which line an axis tilts, are open when their intervals hold every angle."""


@dataclass(frozen=True)
class ShownAlternative:
    """What else could stand in an effect's place, in words."""

    name: str
    gap: str
    too_close: bool


@dataclass(frozen=True)
class Card:
    """The texts of a card; `anchor` is its id in the page, `figure` the name of its curve's figure or ""."""

    anchor: str
    title: str
    what: str
    location: str
    share: str
    of_rest: str
    share_width: float
    size: str
    readings: tuple[Reading, ...]
    remark: str
    shape: str
    evidence: str
    evidence_words: str
    alternatives: tuple[ShownAlternative, ...]
    chosen: str
    how_specific: str
    physics: str
    confirm: str
    cure: str
    carries_over: str
    figure: str = ""


def card(effect: FoundEffect, number: int, figure: str = "", masses_stated: bool = False) -> Card:
    """The card of the ``number``-th effect.

    Args:
        effect: what was found.
        number: from 1.
        figure: path of its curve's picture; empty where it has none.
        masses_stated: whether the arm's description states its links' masses.

    Returns:
        What the template shows.
    """
    readings = [reading_of(p, effect) for p in told_parameters(effect)]
    shown = tuple(readings[:MOST_PARAMETERS])
    return Card(
        anchor=f"effect-{number}-{re.sub('[^a-z0-9]+', '-', f'{effect.effect} {effect.location}'.lower())}",
        title=capitalised(title_of(effect)),
        what=what_kind(effect),
        location=effect.location,
        share=percent(effect.share),
        of_rest=of_what_calibration_leaves(effect),
        share_width=min(100.0, max(0.0, 100 * effect.share)),
        size=millimetres(effect.rms_at_tool_mm),
        readings=shown,
        remark=_remark_on(effect, len(shown), masses_stated),
        shape=effect.curve.description if effect.curve else "",
        evidence=f"{effect.evidence_nats:.{0 if effect.evidence_nats >= 10 else 1}f} nats",
        evidence_words=evidence_in_words(effect.evidence_nats, effect.inclusion),
        alternatives=tuple(
            ShownAlternative(
                effect_in_words(other.effect, other.location) + _followed(other),
                gap_in_words(other),
                abs(other.discriminability_nats) < INDISTINGUISHABLE_NATS,
            )
            for other in effect.alternatives
        ),
        chosen=chosen_how_often(effect.inclusion),
        how_specific=how_specific(effect),
        physics=effect.physics,
        confirm=effect.confirm,
        cure=effect.cure.replace("`", ""),
        carries_over=effect.carries_over,
        figure=figure,
    )  # fmt: skip


def title_of(effect: FoundEffect) -> str:
    """The name at the level that the evidence allows; a free curve is told by what it follows."""
    if effect.nameless and effect.named_as == "effect" and effect.curve is not None:
        return f"{effect.location}: unexplained curve that follows the {effect.driver}"
    return (plain(effect.title) or effect_in_words(effect.effect, effect.location)) + since(effect)


def reading_of(parameter: Parameter, effect: FoundEffect) -> Reading:
    """A parameter as a card shows it; one that the poses leave open is not told with digits that mean nothing."""
    reading = read_parameter(parameter, effect.effect)
    known = effect_named(effect.effect)
    if known and known.departs and parameter.value > 0:
        also = f"+{reading.also}" if reading.also else ""
        reading = replace(reading, value=f"+{reading.value}", also=also)
    if implausible(parameter, effect):
        return Reading(reading.label, "undetermined", "larger than real arms show: it absorbs other errors")
    if parameter.name in HALF_A_PERIOD:
        if INTERVAL * parameter.stderr < HALF_A_PERIOD[parameter.name]:
            return reading
        return Reading(reading.label, "undetermined", "not determined by these poses")
    if not absorbed(parameter, effect):
        return reading
    return Reading(reading.label, "undetermined", "in these poses other parameters absorb it")


def what_kind(effect: FoundEffect) -> str:
    """What a title leaves open: the best single reading, and the kind of physics."""
    if effect.nameless:
        return "no known physics"
    name = effect_in_words(effect.effect, effect.location)
    return effect.family if title_of(effect).startswith(name) else f"{name} · {effect.family}"


def told_parameters(effect: FoundEffect) -> Sequence[Parameter]:
    """The parameters that say something by themselves.

    A free curve's coefficients don't, but how far it reaches does; nor do products with unknown mass moments.
    """
    if not effect.nameless or effect.curve is None:
        return [p for p in effect.parameters if not p.name.startswith(UNKNOWN_MASSES)]
    return [reach(effect.curve)]


def _remark_on(effect: FoundEffect, shown: int, masses_stated: bool = False) -> str:
    """What the listed numbers leave open, in a sentence or two."""
    names = [p.name for p in effect.parameters]
    if any(name.startswith(UNKNOWN_MASSES) for name in names):
        if "compliance" in names and masses_stated:
            return (
                "The stated masses do not fit what this joint does: its mass moments were fitted beside the compliance "
                "(model.yaml has them), whose scale the known payloads fix."
            )
        if "compliance" in names:
            return "The links' masses are not known; the known payloads fix the scale of the compliance."
        if masses_stated:
            return (
                "The stated masses do not fit what this joint does, or something hangs at the flange that nobody "
                "stated: only products of the compliance with mass moments were fitted (model.yaml has them)."
            )
        return (
            "The links' masses are not known, so only products of the compliance with mass moments are (model.yaml has "
            "them). Recordings with a known weight at the tool would give the compliance itself."
        )
    left_out = len(told_parameters(effect)) - shown
    return f"{left_out} further numbers are in model.yaml." if left_out > 0 else ""


def chosen_how_often(inclusion: float | None) -> str:
    """How stable the choice is when rows are drawn anew."""
    if inclusion is None:
        return "not tested"
    often = f"chosen in {100 * inclusion:.0f} % of the resampled data sets"
    if inclusion >= WORDS.reliable:
        return often
    return (
        f"{often}: in the others, other effects or small errors of the whole arm took its place. Take it as one "
        "possible description, not as the cause"
    )


def how_specific(effect: FoundEffect) -> str:
    """Why a name is not more specific than it is; empty for one that is as specific as it can be."""
    if effect.named_as == "effect":
        return ""
    shown = (
        "These recordings show the kind of physics and the region, not the exact part."
        if effect.named_as == "region"
        else "These recordings show the kind of physics, not where it is."
    )
    best = effect_in_words(effect.effect, effect.location)
    return f"{shown} The best single explanation is {best}; its rivals are listed below."


def gap_in_words(other: Alternative) -> str:
    """How much evidence it costs to name an alternative instead, and whether only its size does."""
    gap = other.evidence_gap_nats
    if gap <= -INDISTINGUISHABLE_NATS:
        return f"fits {-gap:.1f} nats better here, but was struck out: implausible, or not borne out elsewhere"
    if gap < 0:
        return "fits as well"
    alike = other.discriminability_nats < INDISTINGUISHABLE_NATS <= gap
    told = f"{gap:.1f} nats worse{', but only because of its prior' if alike else ''}"
    return f"{told}; held-out rows do not exclude it" if other.excluded is False else told


def _followed(other: Alternative) -> str:
    """A free curve says what it follows, since its name doesn't."""
    return f" (follows {other.driver})" if other.nameless and other.driver else ""
