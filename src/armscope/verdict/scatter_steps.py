"""What a work order says of joints that scatter: to find out what that follows is a step.

A scatter is in no model, so nothing can be set by it, and no error is lower for a step that finds it out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from armscope.core.words import enumerated
from armscope.physics.backgrounds import TRANSMISSION
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.tasks import FIND_OUT, Task

SETTLE_SCATTER = (
    "Settle first why {} scatters (below): play whose side was not recorded goes with the angle, too. Until then "
    "change nothing here."
)
LOWERS_NOTHING = "to know it changes nothing yet: what it is says the cure"
"""In place of what a step leaves that only finds out."""


def beside_scatter(task: Task, verdict: Diagnosis) -> Task:
    """A drive's task where its joint scatters as play does: the side of approach goes with the angle at most poses.

    What follows the angle there may be no more than that.
    """
    loose = {each.location for each in verdict.effects if each.scatters}
    places = [member.partition(" at ")[2] for member in task.members]
    if task.family != TRANSMISSION or not loose.intersection(places):
        return task
    unless = f"{SETTLE_SCATTER.format(enumerated(places))} {task.unless}".rstrip()
    return replace(task, unless=unless, beside_scatter=True)


def finding_out(tasks: Sequence[Task], verdict: Diagnosis, left_mm: float) -> list[Task]:
    """Of tasks that lower nothing those of scatter, each as a step that finds out what it follows.

    Args:
        tasks: of a work order.
        verdict: that it is of.
        left_mm: RMS per axis when they are done: as before.

    Returns:
        The steps.
    """
    loose = {each.as_member for each in verdict.effects if each.scatters}
    return [
        replace(
            task,
            change=FIND_OUT,
            instruction=task.cure,
            cure="",
            needs=LOWERS_NOTHING,
            alone_mm=left_mm,
            then_mm=left_mm,
        )
        for task in tasks
        if loose.intersection(task.members)
    ]
