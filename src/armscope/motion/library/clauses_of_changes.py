"""Clauses and cures of what changes within a run: when, by how much, and what to record."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.words import rounded
from armscope.motion.library.change_constants import CHANGE
from armscope.motion.library.clauses import Numbers, amount, rms_of
from armscope.motion.library.remedies import Fitted
from armscope.motion.verdict import FoundCause
from armscope.verdict.effects import Parameter


def load_clause(cause: FoundCause, numbers: Numbers) -> str:
    """A load that comes and goes."""
    mass = numbers.get("mass")
    size = rms_of(cause) if mass is None else f"{amount(mass)} {'more' if mass.value > 0 else 'less'} than stated"
    return f"{when(cause.parameters)} the arm carries {size}"


def jump_clause(cause: FoundCause, numbers: Numbers) -> str:
    """A reading that jumps."""
    jump = numbers["jump"]
    side = "high" if jump.value > 0 else "low"
    return f"{when(cause.parameters)} the recorded torque of {cause.location} reads {amount(jump)} too {side}"


def in_every_row(fitted: Fitted) -> str:
    """What to record of a load, and where it sits."""
    mass = fitted.numbers.get("mass")
    if mass is None:
        return fitted.cure
    what = f"{fitted.in_general}: stated {amount(mass, sign=True)} {when(fitted.parameters)}, as stated at other times."
    return f"{what} {where}" if (where := _where_it_sits(fitted)) else what


def _where_it_sits(fitted: Fitted) -> str:
    """That a load off the tool point must be stated where it is; nothing where that is not known, or one is there."""
    moments = [fitted.numbers.get(f"m{axis}") for axis in "xyz"]
    if fitted.of_law[:1] != (0.0,) or any(each is None for each in moments):
        return ""
    centre = np.array([each.value for each in moments if each]) / fitted.numbers["mass"].value
    told = ", ".join(f"{round(float(at))}" for at in fitted.arm.in_tool_frame(centre))
    return f"`payload_kg` acts at the tool point, and this load sits elsewhere: state `tool_mm: [{told}]` with it."


def off_while_there(fitted: Fitted) -> str:
    """What to take off a reading that jumps."""
    return f"Take {amount(fitted.first, sign=True)} from the recorded torque {when(fitted.parameters)}."


def when(parameters: tuple[Parameter, ...]) -> str:
    """From when to when something is there, by the run's own time, as in "from 2.10 s until 4.00 s and from 7.5 s on".

    Args:
        parameters: of the cause, its moments among them as "from" and "until", one after the other.

    Returns:
        The words.
    """
    return spells([(each.name, each.unit, each.value) for each in parameters])


def spells(scanned: Sequence[tuple[str, str, float]]) -> str:
    """The same of names, units and values."""
    unsure = next((value for name, _, value in scanned if name == "unsure"), 0.0)
    moments = [(name.partition("_")[0], value) for name, unit, value in scanned if unit == "s" and name != "unsure"]
    told = [f"{word} {at:.{2 if unsure < CHANGE.coarse_s else 1}f} s" for word, at in moments]
    if moments[-1][0] == "from":
        told[-1] += " on"
    start = int(moments[0][0] == "until")
    found = [*told[:start], *(" ".join(told[n : n + 2]) for n in range(start, len(told), 2))]
    if len(found) > CHANGE.told:
        found = [*found[: CHANGE.told - 1], f"{len(found) - CHANGE.told + 1} more times"]
    words = " and ".join([", ".join(found[:-1]), found[-1]]) if len(found) > 1 else found[0]
    return f"{words} (± {rounded(unsure)} s)" if unsure >= CHANGE.coarse_s else words
