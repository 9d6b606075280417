"""A cause of a moving arm in words: a clause for the headline, and its cure with sign and number."""

from __future__ import annotations

from collections.abc import Sequence

from armscope.motion.library.catalogue import cause_named
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.clauses import rms_of
from armscope.motion.library.laws import Law
from armscope.motion.library.remedies import Fitted
from armscope.motion.summary.doubts import determined
from armscope.motion.verdict import FoundCause
from armscope.robot.dynamics import MovingArm
from armscope.verdict.effects import Parameter


def clause(cause: FoundCause) -> str:
    """Who does what, by how much: one cause in a sentence; without the number where it is not determined.

    Args:
        cause: with its parameters.

    Returns:
        The clause, small first letter.
    """
    known = cause_named(cause.effect)
    say = known.clause if known else None
    numbers = {parameter.name: parameter for parameter in cause.parameters}
    if not (cause.nameless or determined(cause.parameters)):
        unsure = known.open_clause if known else None
        return unsure(cause, numbers) if unsure else f"{cause.title}, whose size is not determined"
    told = say(cause, numbers) if say else f"{cause.title} ({rms_of(cause)})"
    _, _, run = cause.title.partition(" in run ")
    return f"in run {run} {told}" if run else told


def cure(placed: PlacedCause, parameters: Sequence[Parameter], arm: MovingArm, currents: bool = False) -> str:
    """What to change, with sign and number where the cause has one number, or few.

    Args:
        placed: the cause at its place.
        parameters: as fitted.
        arm: as stated.
        currents: whether currents were recorded, and not torques.

    Returns:
        A sentence or two; the cause's own words where its numbers are not determined.
    """
    say, own = placed.cause.remedy, placed.cause.cures.get(placed.variant, placed.cause.cure)
    of_law = placed.columns.numbers if isinstance(placed.columns, Law) else ()
    sure = say if determined(parameters) else None
    unsure = "" if determined(parameters) else placed.cause.open_cure
    run = placed.runs[0] if placed.runs else ""
    fitted = Fitted(own, tuple(parameters), arm, of_law, placed.location, run, placed.driver, currents)
    return sure(fitted) if sure else unsure or own
