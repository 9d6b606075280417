"""What may be the instrument's own error: commands that took it out would move a good arm wrongly."""

from __future__ import annotations

from dataclasses import replace

from armscope.verdict.doubts import MAY_BE_READ_SO, MEANWHILE, NOT_THE_ARMS
from armscope.verdict.schema import Verdict
from armscope.verdict.tasks import Task

SETTLE_FIRST = (
    "An error of the instrument or set-up is not settled, and other causes may be a part of it: commands from armscope "
    "compensate would then move a good arm wrongly. Check the instrument first (a scale bar, a second place to measure "
    "from), measure and diagnose again."
)


def instrument_is_open(verdict: Verdict) -> bool:
    """Whether an error of instrument or set-up was found that has no sure name."""
    return any(effect.family in NOT_THE_ARMS and effect.named_as != "effect" for effect in verdict.effects)


def beside_the_instrument(task: Task, verdict: Verdict) -> Task:
    """A task as it is done where the instrument itself is named, or is not settled: what is open may be its error."""
    named = any(effect.location == "instrument" for effect in verdict.effects)
    if not (named or instrument_is_open(verdict)):
        return task
    return replace(task, cure=task.cure.replace(MEANWHILE, MAY_BE_READ_SO))
