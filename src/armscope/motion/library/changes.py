"""What changes within a run, placed by what a scan found: the load, or what a joint's torque reads."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from armscope.core.types import Array
from armscope.motion.library.causes import PlacedCause, Seen
from armscope.motion.library.change_constants import CHANGE
from armscope.motion.library.changes_catalogue import LOAD_CHANGE, OFFSET_JUMP
from armscope.motion.library.for_a_while import OF_A_LOAD, of_a_load
from armscope.motion.library.laws import Law
from armscope.motion.library.masses import shown
from armscope.robot.dynamics import MovingArm

UNSURE = "unsure"


@dataclass(frozen=True, eq=False)
class Change:
    """A load that comes and goes in a run."""

    run: str  # its name
    at_first: bool  # whether the load is there from the start
    moments: tuple[float, ...]  # s of the run's own time, ascending, at which it comes or goes
    unsure: float  # s, by which the least known of these may be off
    load: Array  # (4,) `OF_A_LOAD`, kg and kg m
    tried: int  # moments that competed for each

    @property
    def otherwise(self) -> Change:
        """The same as a load that is there when this one is not."""
        return replace(self, at_first=not self.at_first, load=-self.load)

    @property
    def numbers(self) -> tuple[float, ...]:
        """As laws take them."""
        return (float(self.at_first), *self.moments)


def place_changes(seen: Seen, change: Change, stated: float) -> Iterator[PlacedCause]:
    """A load that comes and goes, at the tool point or anywhere on the last link, or gone when it was said to be there;
    and what reads alike: offsets of joints that jump at the same moments.

    Args:
        seen: of the table.
        change: what a scan found.
        stated: kg that are stated at the tool point in that run.

    Yields:
        The causes.
    """
    every = tuple(range(seen.arm.n_motors))
    for each in (change, change.otherwise):
        how = _how(each)
        names = tuple((name, "kg" if name == "mass" else "kg m") for name in OF_A_LOAD)
        about = np.maximum(np.abs(each.load), [CHANGE.least_load_kg, 0, 0, 0]) * np.where(each.load < 0, -1, 1)
        counted = shown(seen, of_a_load(seen.arm, about, stated))
        if 0 in counted:
            which = float(sum(1 << int(number) for number in counted))
            law = Law("load for a while", every, (stated, *map(float, about), which, *each.numbers))
            told = tuple(names[number] for number in counted)
            anywhere = how | {"variant": _named(each, "free")}
            yield PlacedCause(LOAD_CHANGE, "payload", "load", told, every, law, **anywhere)
        if len(shown(seen, seen.arm.point_load()[:, None])):
            law = Law("tool load for a while", every, each.numbers)
            yield PlacedCause(LOAD_CHANGE, "payload", "load", names[:1], every, law, **how)
    for j in np.flatnonzero(seen.moving):
        law = Law("offset for a while", (int(j),), change.numbers)
        names = (("jump", seen.torque(int(j))),)
        yield PlacedCause(OFFSET_JUMP, f"joint {j + 1}", "time", names, (int(j),), law, **_how(change))


def as_it_is_carried(placed: PlacedCause, arm: MovingArm, values: Array) -> PlacedCause:
    """A load anywhere on the last link, for a while, with the inertia that a body of its mass has at its place.

    Args:
        placed: of `LOAD_CHANGE`, with its mass and moments.
        arm: the arm as stated.
        values: (c,) its numbers, kg and kg m.

    Returns:
        It, with other columns; itself where no body has such a mass.
    """
    law = placed.columns
    if not isinstance(law, Law) or law.kind != "load for a while":
        return placed
    stated, about, more = law.numbers[0], np.zeros(len(OF_A_LOAD)), law.numbers[5:]
    for (name, _), value in zip(placed.parameters, values, strict=True):
        about[OF_A_LOAD.index(name)] = value
    if abs(about[0]) < CHANGE.least_load_kg:
        return placed
    return replace(placed, columns=replace(law, numbers=(stated, *map(float, about), *more)))


def gate_of(placed: PlacedCause) -> tuple[float, list[float]]:
    """When what changes is there: whether from the start, and at which moments, s, it comes or goes."""
    turns = [(name, at) for name, unit, at in placed.scanned if unit == "s" and name != UNSURE]
    return float(turns[0][0].startswith("until")), [at for _, at in turns]


def _named(change: Change, form: str) -> str:
    return f"{change.run} {form} {'until' if change.at_first else 'from'}".strip()


def _how(change: Change) -> dict[str, Any]:
    """What every form of a change has in common."""
    words = ("until", "from") if change.at_first else ("from", "until")
    turns = [f"{words[n % 2]}{'' if n < 2 else f'_{n // 2 + 1}'}" for n in range(len(change.moments))]
    scanned = [(name, "s", at) for name, at in zip(turns, change.moments, strict=True)]
    return {
        "runs": (change.run,),
        "variant": _named(change, "tool"),
        "multiplicity": change.tried ** len(change.moments),
        "scanned": (*scanned, (UNSURE, "s", change.unsure)),
    }
