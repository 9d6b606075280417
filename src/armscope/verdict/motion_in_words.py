"""What turns and shifts by how much over the recorded rows, in words with signs."""

from __future__ import annotations

import math

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.physics.effect import Part
from armscope.physics.scene import Scene
from armscope.verdict.constants import WORDS
from armscope.verdict.entries import with_sign


def correction_in_words(scene: Scene, parts: tuple[Part, ...]) -> str:
    """By how much a motor's command is corrected over the recorded rows: its signs are opposite to what they show."""
    moved = {d: a for d, a in scene.amounts(parts).items() if Location.of(d.location).kind == "motor"}
    if not moved:
        return "compensate for it in the command"
    direction, amount = max(moved.items(), key=lambda pair: float(np.abs(pair[1]).max()))
    number = Location.of(direction.location).number
    return f"correct the command of joint {number} by {_range(-np.asarray(amount), turning=True)}"


def motion_in_words(scene: Scene, parts: tuple[Part, ...], zero: float | None = None) -> str:
    """The largest turn and shift of parts over the recorded rows, in words, with signs.

    Args:
        scene: the rows.
        parts: that move.
        zero: what stands in the place of the mean, as in a curve's table; None for the motion as it is.

    Returns:
        Which place moves how, from ... to.
    """
    amounts: dict[str, list[tuple[str, Array]]] = {"turns": [], "moves": []}
    places = {part.placed.location for part in parts}
    where = min(places) if len(places) == 1 and min(places).startswith(("link ", "tool")) else ""
    for direction, amount in scene.amounts(parts).items():
        place = Location.of(direction.location)
        if place.kind in ("instrument", "payload"):
            continue
        turning = direction.axis == "turn" or direction.axis.startswith("r")
        about = "" if direction.axis == "turn" else f" {'about' if turning else 'along'} {direction.axis[1:]}"
        # a modified row's a and alpha act in the frame of the row before, its d in the joint's: neither is its number
        name = f"joint {place.number}" if place.kind == "motor" else where or direction.location
        if place.kind == "base" and where == "tool":
            about += " of the base"
        amounts["turns" if turning else "moves"].append((f"{name}{about}", np.asarray(amount)))
    told = []
    for verb, found in amounts.items():
        if found:
            name, amount = max(found, key=lambda pair: float(np.abs(pair[1]).max()))
            amount = amount if zero is None else amount - amount.mean() + zero
            if np.abs(amount).max() > 0:
                told.append(f"{name} {verb} by {_range(amount, verb == 'turns')}")
    return "; ".join(told)


def _range(amount: Array, turning: bool) -> str:
    low, high = float(amount.min()), float(amount.max())
    if high - low < WORDS.steady * max(abs(low), abs(high)):
        low = high = float(amount.mean())
    ends = [low] if low == high else [low, high]

    small = " … ".join(with_sign(1e3 * end, 3) for end in ends)
    if not turning:
        return f"{small} mm"
    degrees = " … ".join(with_sign(math.degrees(end), 4) for end in ends)
    return f"{small} mrad ({degrees}°)"
