"""What an effect says of itself in a sentence: a template over the numbers that a verdict tells of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from armscope.core.location import Location
from armscope.core.words import size_of


@dataclass(frozen=True)
class Number:
    """A number in a sentence: `{compliance}` gives its size in the field's unit, `{offset:+}` its sign, too."""

    value: float
    unit: str
    stderr: float = 0.0

    def __format__(self, spec: str) -> str:
        return size_of(self.value, self.unit, sign=spec == "+")


@dataclass(frozen=True)
class Told:
    """What a verdict tells of one effect."""

    # effect, location, driver: in words
    effect: str
    location: str
    driver: str
    numbers: Mapping[str, Number]  # its parameters by name, units of the files; "reaches" for how far a curve goes

    def words(self) -> dict[str, object]:
        """What a template may name: {location}, {joint} (without what moves it), {source} (which does), the numbers."""
        place = Location.of(self.location)
        joint = f"{place.kind} {place.number}" if place.number else self.location
        source = f"{place.kind} {place.source}" if place.source else "another joint"
        return {
            "effect": self.effect.replace("_", " "),
            "location": self.location,
            "joint": joint,
            "source": source,
            "driver": self.driver,
            **self.numbers,
        }


Clause = str | Callable[[Told], str]
"""A template, or a function; one that needs a number that was not told raises KeyError."""

GENERAL: Clause = "{effect} at {joint}"


def swings(what: str) -> Clause:
    """A clause of a wave: what swings, by how much, how often per turn; what = "the angle of {location} swings"."""

    def clause(told: Told) -> str:
        count = told.numbers["per_turn"].value if "per_turn" in told.numbers else 1
        often = {1: "once per turn", 2: "twice per turn"}.get(round(count), f"{count:.0f} times per turn")
        return f"{what.format(location=told.location)} by ±{told.numbers['amplitude']} {often}"

    return clause


def below_zero(number: str, what: str) -> Clause:
    """A clause of a number that should not be negative and is; else it is not for use.

    Args:
        number: its name.
        what: a template, which tells its size.
    """

    def clause(told: Told) -> str:
        if told.numbers[number].value >= 0:
            raise KeyError(number)
        return what.format_map(told.words())

    return clause


CLEAR = 2.0
"""Standard errors from which one of several numbers is told in a sentence."""


def clear_ones(what: str, **places: str) -> Clause:
    """A clause of those of several sizes that stand out of their uncertainty; with none of them it is not for use.

    Args:
        what: a template of one field: "the base tilts {} under the arm's moment".
        places: by number, what stands behind it: "about its x".
    """

    def clause(told: Told) -> str:
        sizes = {place: told.numbers[name] for name, place in places.items() if name in told.numbers}
        clear = [f"by {size} {place}" for place, size in sizes.items() if abs(size.value) > CLEAR * size.stderr]
        if not clear:
            raise KeyError(*places)
        return what.format(" and ".join(clear), location=told.location)

    return clause


def waves_column(told: Told) -> str:
    """The atlas' column of a wave once or twice per turn."""
    count = round(told.numbers["per_turn"].value) if "per_turn" in told.numbers else 0
    return {1: "once per turn", 2: "twice per turn"}.get(count, "")


def say(clauses: Iterable[Clause], told: Told) -> str:
    """The first of an effect's clauses whose numbers are all told, else its name and place."""
    for clause in (*clauses, GENERAL):
        try:
            return clause.format_map(told.words()) if isinstance(clause, str) else clause(told)
        except KeyError:
            continue
    raise AssertionError("the general clause needs nothing")
