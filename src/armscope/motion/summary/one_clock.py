"""Delays of all joints that are one: torque was recorded by another clock than the motion, and no drive is late."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armscope.motion.library import catalogue
from armscope.motion.library.clauses import amount
from armscope.motion.summary.constants import NAMING
from armscope.motion.summary.doubts import determined
from armscope.motion.verdict import FoundCause
from armscope.verdict.effects import Parameter
from armscope.verdict.schema import Notice

PLACE = "all joints (one clock)"
ONE_CLOCK = f"torque delay of {PLACE}"


def joints_in_motion(still: NDArray[np.bool_]) -> int:
    """How many joints move in rows (K, m) of which is known whether each stands."""
    return int((~still).any(axis=0).sum())


def of_one_clock(causes: Sequence[FoundCause], moving: int) -> list[FoundCause]:
    """The delays of all joints, where their intervals hold one number in common; none where that is not so.

    Args:
        causes: of a verdict.
        moving: how many joints move.

    Returns:
        The delays, in the order of the causes.
    """
    late = [cause for cause in causes if cause.effect == catalogue.DELAY.name and determined(cause.parameters)]
    joints = {cause.location for cause in late}
    if len(late) < NAMING.joints_of_a_clock or not len(late) == len(joints) == moving:
        return []
    common = _common(late)
    agree = all(low <= common.value <= high for low, high in (cause.parameters[0].interval for cause in late))
    return late if agree else []


def _common(late: Sequence[FoundCause]) -> Parameter:
    """The delay of all, weighted by what each knows; known no better than where it is known best: they share noise."""
    told = [cause.parameters[0] for cause in late]
    weights = [1 / max(each.stderr, 1e-12) ** 2 for each in told]
    value = sum(weight * each.value for weight, each in zip(weights, told, strict=True)) / sum(weights)
    return Parameter(told[0].name, told[0].unit, value, min(each.stderr for each in told))


def clock_together(causes: Sequence[FoundCause], moving: int) -> list[FoundCause]:
    """Causes, largest share first; delays of one clock stand together, by the share that they have in all.

    Args:
        causes: of a verdict.
        moving: how many joints move.

    Returns:
        The same causes.
    """
    late = of_one_clock(causes, moving)
    whole = sum(cause.share for cause in late)
    return sorted(
        causes, key=lambda cause: (-(whole if cause in late else cause.share), cause not in late, -cause.share)
    )


def as_one(causes: Sequence[FoundCause], moving: int) -> list[FoundCause]:
    """Causes with delays of one clock told as one.

    Args:
        causes: of a verdict.
        moving: how many joints move.

    Returns:
        The causes, in their order.
    """
    late = of_one_clock(causes, moving)
    if not late:
        return list(causes)
    common, first = _common(late), min(causes.index(cause) for cause in late)
    side = "earlier" if common.value > 0 else "later"
    one = replace(
        late[0],
        location=PLACE,
        title=ONE_CLOCK,
        minor=False,
        parameters=(common,),
        share=sum(cause.share for cause in late),
        alternatives=(),
        confirm="See whether torque and position come with one time stamp, by one bus.",
        cure=f"Shift the recorded torque of all joints {amount(common)} {side}, or simulate that.",
        doubt=late[0].doubt if all(cause.doubt for cause in late) else "",
    )
    told: list[FoundCause] = [cause for cause in causes if cause not in late]
    told.insert(first, one)
    return told


def told_of_one_clock(causes: Sequence[FoundCause], moving: int) -> list[Notice]:
    """A notice that the delays are one."""
    late = of_one_clock(causes, moving)
    if not late:
        return []
    common = _common(late)
    side = "late" if common.value > 0 else "early"
    text = (
        f"Torque is recorded {amount(common)} {side} at all {len(late)} joints alike: that is one clock, and no drive. "
        "Shift it as a whole; the causes list it joint by joint."
    )
    return [Notice("one clock", text)]
