"""Numbers as people in the field say them, and evidence in words."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from armscope.core.words import enumerated, rounded, shown_unit
from armscope.physics.registry import effect_named
from armscope.verdict.constants import WORDS
from armscope.verdict.effects import INTERVAL, Curve, FoundEffect, Parameter

LABELS = {
    "amplitude": "swing (± about the mean)",
    "direction": "about a direction in the joint's x-y plane at",
    "per_turn": "waves",
    "phase": "largest at",
    "reaches": "reaches",
    "time": "at time",
    "row": "at row with id",
}
"""What parameters of several effects are called; an effect has labels of its own (`armscope.physics.effect`)."""

SMALL = {
    "geometric": "small errors of geometry in all joints and links",
    "elastic": "a little give in all joints and links",
    "transmission": "small errors in all drives",
    "thermal": "links that grow a little with temperature",
    "drift": "a slow drift of the set-up",
}
"""What every arm and set-up has a little of, by family."""
KINDS = {
    "geometric": "geometry",
    "elastic": "stiffness",
    "transmission": "drives",
    "thermal": "growth with temperature",
}
SPREAD = {
    "geometric": "small errors of geometry in all joints and links",
    "elastic": "all joints and links give way",
    "transmission": "small errors in all drives",
    "thermal": "all links grow with temperature",
    "drift": "a slow drift of base and instrument",
}
"""Causes of which no member stands out."""
IN_ALL = {
    "geometric": "the geometry is off in all joints and links",
    "elastic": "all joints and links give way",
    "transmission": "all drives are off",
    "thermal": "all links grow with temperature",
    "drift": "base and instrument drift",
}
"""The same where one stands out, but most of the error is everywhere."""
GROWS = "{} grows and shrinks slowly in the course of the recording, as a link that warms up does"
"""What is told in the place of a drift where most of it is one link's."""
BESIDE = {"transmission": "all drives a little", "drift": "a slow drift"}
"""Small errors of a family beside one that stands out; of others: "all others a little"."""

_ALSO = {
    "geometric": "also off",
    "elastic": "also giving way",
    "transmission": "also off",
    "thermal": "also with temperature",
    "drift": "also moving",
}
"""What the places of a cause do that stand beside the first, by family."""


@dataclass(frozen=True)
class Reading:
    """A parameter as it stands on a card: its name, value, 95 % interval, and the same number said otherwise."""

    label: str
    value: str
    interval: str
    also: str = ""


def read_parameter(parameter: Parameter, effect: str = "") -> Reading:
    """A parameter (of an effect) in the field's units, with as many digits as its uncertainty leaves meaning."""
    definition = effect_named(effect)
    labels = {**LABELS, **(definition.labels if definition else {})}
    label = labels.get(parameter.name, parameter.name.replace("_", " "))
    parameter = _in_degrees(parameter)
    factor, unit = shown_unit(parameter.unit, abs(parameter.value))
    known = 0 < parameter.stderr < math.inf
    low, high = (factor * edge for edge in parameter.interval)
    decimals = 0 if parameter.name == "row" else decimals_for(factor * parameter.stderr) if known else None
    value = f"{_number(factor * parameter.value, decimals)} {unit}".strip().replace(" °", "°")
    interval = f"{_number(low, decimals)} … {_number(high, decimals)} {unit}" if known else "found by trying values"
    return Reading(label, value, interval.replace(" °", "°"), _said_otherwise(parameter))


def half_interval(parameter: Parameter) -> str:
    """ " (± 0.21)": half of a parameter's 95 % interval, in the unit in which it is read; "" where it is not known."""
    parameter = _in_degrees(parameter)
    if not 0 < parameter.stderr < math.inf:
        return ""
    error = shown_unit(parameter.unit, abs(parameter.value))[0] * parameter.stderr
    return f" (± {_number(INTERVAL * error, decimals_for(error))})"


def _in_degrees(parameter: Parameter) -> Parameter:
    in_degrees = Parameter(parameter.name, "deg", math.degrees(parameter.value), math.degrees(parameter.stderr))
    return in_degrees if parameter.name in ("phase", "direction") else parameter


def spelled(count: int) -> str:
    """Small numbers as words."""
    words = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve")
    return words[count] if count < len(words) else str(count)


def also_out(family: str, told: FoundEffect, members: Sequence[FoundEffect]) -> list[str]:
    """Where else a cause is, for brackets behind its first member: "also off: joints 3, 4 and link 2".

    Args:
        family: of the cause.
        told: the member that stands before the brackets.
        members: all of them.

    Returns:
        One clause, or none where there is no other member on which one can rely.
    """
    others = [effect for effect in members if effect is not told and not effect.rarely_chosen]
    places = list(dict.fromkeys(effect.location for effect in others if effect.location != told.location))
    if not places:
        return [f"{spelled(len(others))} more at the same place"] if others else []
    if len(places) > WORDS.places:
        return [f"{_ALSO.get(family, 'also')}: {spelled(len(places))} more places"]
    kinds: dict[str, list[str]] = {"": []}  # "has play (also off: joint 4)" would be read as play of joint 4
    for effect in (each for each in others if each.location in places):
        alone = _needs_no_kind(effect)
        kind = "" if alone or effect.effect == told.effect else f"{plain(effect.effect)} at "
        kinds.setdefault(kind, []).append(alone or effect.location)
    told_places = ((kind, places_in_words(list(dict.fromkeys(those)))) for kind, those in kinds.items() if those)
    return [f"{_ALSO.get(family, 'also')}: {enumerated([kind + where for kind, where in told_places])}"]


def _needs_no_kind(effect: FoundEffect) -> str:
    """ "joint 3", "link 2", "base": what gives way there is the place itself; "payload error"; "" of anything else."""
    kind = effect.location.partition(" ")[0]
    if not effect.effect.startswith(f"{kind}_"):
        return ""
    if effect.family == "elastic" and kind != "payload":
        return effect.location
    return plain(effect.effect) if kind == effect.location else ""


def places_in_words(places: Sequence[str]) -> str:
    """Places in one phrase, numbered ones of a kind together and in order: "joints 3 and 4, link 2 and base"."""
    kinds: dict[str, list[str]] = {}
    for place in places:
        kind, _, number = place.rpartition(" ")
        kinds.setdefault(kind if number.isdigit() else place, []).append(number if number.isdigit() else "")
    phrases = []
    for kind, numbers in kinds.items():
        which = enumerated([number for number in sorted(numbers, key=lambda each: int(each or 0)) if number])
        phrases.append(f"{kind}{'s' * (len(numbers) > 1)} {which}".strip())
    return enumerated(phrases)


def capitalised(text: str) -> str:
    """With a capital first letter, the rest untouched."""
    return text[:1].upper() + text[1:]


def decimals_for(uncertainty: float) -> int:
    """Decimals that keep two digits of the uncertainty."""
    if not (math.isfinite(uncertainty) and uncertainty > 0):
        return 3
    return max(0, 1 - math.floor(math.log10(uncertainty)))


def _number(value: float, decimals: int | None) -> str:
    if not math.isfinite(value):
        return "–"
    if decimals is None:
        return f"{value:.4g}"
    text = f"{value:.{min(decimals, 6)}f}"
    return text.removeprefix("-") if float(text) == 0 else text.replace("-", "−")


def _said_otherwise(parameter: Parameter) -> str:
    """The reciprocal of a compliance is a stiffness; angles also come in degrees."""
    other: dict[str, Callable[[Parameter], str]] = {
        "rad/(N m)": lambda p: _reciprocal("stiffness", p, "N m/rad"),
        "1/(N m^2)": lambda p: _reciprocal("bending stiffness E·I", p, "N m²"),
        "rad": lambda p: f"{math.degrees(p.value):.4f}°".replace("-", "−"),
    }
    return other[parameter.unit](parameter) if parameter.unit in other and parameter.value != 0 else ""


def _reciprocal(name: str, parameter: Parameter, unit: str) -> str:
    if parameter.value < 0:  # a tilt across the load, which is no stiffness
        return ""
    low, high = parameter.interval
    value = f"{name} {with_prefix(1 / parameter.value, unit)}"
    if not math.isfinite(parameter.stderr) or low * high <= 0:
        return value
    ends = sorted((1 / low, 1 / high), key=abs)
    return f"{value} (95 %: {with_prefix(ends[0], unit)} … {with_prefix(ends[1], unit)})"


def evidence_in_words(nats: float, inclusion: float | None = None) -> str:
    """What a difference in log evidence means, after Kass & Raftery (1995), whose scale is twice the nats.

    Where less than nearly all tables of rows drawn anew choose it, too (``inclusion``), that decides.
    """
    if nats < 1:
        return "hardly worth a mention"
    odds = f"odds {'of about ' if nats < WORDS.countable_odds else ''}{odds_in_words(nats)}"
    strength = "some" if nats < 3 else "strong" if nats < 5 else "very strong" if nats < 15 else "overwhelming"
    if inclusion is not None and inclusion < WORDS.nearly_always:
        strength, odds = "some", f"{odds} on these rows, but not whenever rows are drawn anew"
    return f"{strength} evidence: {odds}"


def percent(share: float) -> str:
    """A share as a percentage without false digits."""
    if not math.isfinite(share):
        return "–"
    value = 100 * share
    if share > WORDS.more_than_all:
        return "over 100 %"  # it and another nearly cancel: the number itself says nothing
    if 99.5 <= value < 100:
        return f"{min(value, 99.9):.1f} %"  # beside what remains, "100 %" would be read as all of it
    if abs(value) < 0.05:
        return "< 0.1 %"
    text = f"{min(value, 100):.0f} %" if abs(value) >= 9.5 else f"{value:.1f} %"
    return text.replace("-", "−")


def millimetres(value: float | None) -> str:
    """A length in mm with three significant digits; a dash where there is none."""
    if value is None or not math.isfinite(value):
        return "–"
    return f"{value:.0f} mm" if abs(value) >= 1000 else f"{value:.3g} mm"


def reach(curve: Curve) -> Parameter:
    """How far a curve goes where it is known to go farthest; elsewhere a wide band may reach higher."""
    sure = np.abs(curve.value) - INTERVAL * curve.stderr
    at = int(np.argmax(sure))
    return Parameter("reaches", curve.value_unit, float(curve.value[at]), float(curve.stderr[at]))


def plain(text: str) -> str:
    """The files' names in a text as words: "gear_mesh (per_turn 9)" becomes "gear mesh (waves per turn 9)"."""
    words = text.replace("per_turn", "waves per turn").replace("_", " ")
    return words.replace("unknown at", "an unexplained curve at")


def effect_in_words(effect: str, location: str) -> str:
    """ "joint_compliance" at "joint 2" as "joint compliance at joint 2"; "base_shift" at "base" as "base shift"."""
    return plain(effect if effect.startswith(location) else f"{effect} at {location}")


def main_and_minor(effects: Sequence[FoundEffect]) -> tuple[list[FoundEffect], list[FoundEffect]]:
    """The effects of the story and those worth little, the largest share first."""
    ordered = sorted(effects, key=lambda effect: -effect.share)
    return [e for e in ordered if not e.minor], [e for e in ordered if e.minor]


def times(factor: float) -> str:
    """A factor before the word "times"; one beyond counting says that alone: what is left then is noise."""
    return "more than a thousand" if factor > WORDS.countable_times else rounded(factor)


def odds_in_words(nats: float) -> str:
    """Odds as a number to 1, of two digits; of what is beyond all doubt its size alone."""
    if nats >= WORDS.countable_odds:
        return "far beyond a thousand to 1"
    return f"{float(f'{math.exp(nats):.2g}'):.0f} to 1"


def with_prefix(value: float, unit: str) -> str:
    """Three significant digits and k, M or G before the unit."""
    for size, prefix in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if abs(value) >= size:
            return f"{value / size:.3g} {prefix}{unit}"
    return f"{value:.3g} {unit}"
