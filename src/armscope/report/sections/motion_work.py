"""What is done about the torques of an arm in motion: per cause how to confirm and cure it, and the error after it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from armscope.report.html import significant
from armscope.report.motion_subject import MotionSubject
from armscope.report.sections.motion import friction_table, motion_card


@dataclass(frozen=True)
class MotionTask:
    """One cause's line: who does what, what to do, and the error of the torque once it and all before it are done."""

    said: str
    doubt: str
    rivals: tuple[str, ...]
    confirm: str
    cure: str
    expected: str


def motion_work_order(subject: MotionSubject) -> dict[str, Any]:
    """What the work order of a motion is filled with.

    Args:
        subject: the diagnosis.

    Returns:
        Tasks of the causes, largest share first; those worth little in a word each; friction and rotors of the joints.
    """
    verdict = subject.verdict
    after = {step.label: step.held_out for step in verdict.waterfall}
    tasks = []
    for number, cause in enumerate(subject.main, start=1):
        card = motion_card(cause, number)
        rivals = tuple(other.name for other in card.alternatives if other.too_close)
        expected = error_in_words(after.get(cause.title, math.nan))
        tasks.append(MotionTask(card.said, card.doubt, rivals, card.confirm, card.cure, expected))
    held_out = verdict.held_out
    return {
        "tasks": tasks,
        "minor": [cause.title for cause in subject.minor],
        "now": error_in_words(held_out.stated),
        "background": error_in_words(held_out.background),
        "model": error_in_words(held_out.model),
        **friction_table(subject),
    }


def error_in_words(share: float) -> str:
    """An error relative to the torque, in words."""
    return f"{significant(100 * share, 2)} %" if math.isfinite(share) else "–"
