"""A recorded torque that is too large or small, has the other sign, or another unit, as a clause of a sentence."""

from __future__ import annotations

from armscope.motion.constants import LIBRARY
from armscope.motion.library.clauses import Numbers, amount, holds_zero
from armscope.motion.verdict import FoundCause
from armscope.verdict.effects import Parameter

UNITS_OF_TORQUE = {"kgf m": 1 / 9.80665, "lbf in": 8.850746}
"""Per N m, as defined; an lbf ft is near enough to a gain that is off by a quarter."""


def gain_clause(cause: FoundCause, numbers: Numbers) -> str:
    """A torque constant that is off, or a torque whose sign is turned."""
    gain = numbers["gain"]
    if is_turned(gain):
        size = turned_size(gain)
        off = "" if holds_zero(size) else f", and its size {amount(size)} too {'large' if size.value > 0 else 'small'}"
        return f"the sign of the recorded torque of {cause.location} is turned{off}"
    shown = Parameter("gain", "%", 100 * gain.value, 100 * gain.stderr)
    side, unit = "large" if gain.value > 0 else "small", other_unit(gain)
    return f"the recorded torque of {cause.location} is {amount(shown)} too {side}{f': as in {unit}' if unit else ''}"


def other_unit(gain: Parameter) -> str:
    """Another unit of torque that recorded numbers are in by a gain; empty where none fits."""
    alike = (name for name, per_nm in UNITS_OF_TORQUE.items() if abs((1 + gain.value) / per_nm - 1) < LIBRARY.same_unit)
    return next(alike, "")


def is_turned(gain: Parameter) -> bool:
    """Whether a gain's error is more than all of the torque: what is recorded has the other sign."""
    return gain.interval[1] < -1


def turned_size(gain: Parameter) -> Parameter:
    """By how many percent a torque is too large or small once its sign is turned back."""
    return Parameter("size", "%", 100 * (-2 - gain.value), 100 * gain.stderr)
