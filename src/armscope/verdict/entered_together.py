"""Causes that work against each other, as one step: set one by one they make the error larger, together they pay."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from armscope.core.averages import rms
from armscope.core.types import Array
from armscope.verdict.constants import ORDER
from armscope.verdict.doubts import OPEN
from armscope.verdict.tasks import Task
from armscope.verdict.wording import enumerated, places_in_words

Job = tuple[Task, Array]
"""A task, and what the tool moves by what it cures."""
TOGETHER = "Enter all of these before anything is measured or moved by them; one without the others makes it worse."


def pays_together(unpaid: Sequence[Job], left: Array) -> list[Job]:
    """The fewest of tasks that pay only together, at least two, which leave as little as any set of them.

    Args:
        unpaid: tasks none of which pays in its turn; those that are to be settled first take no part.
        left: (n, 3) mm, what is left before them.

    Returns:
        The tasks of the set; none where no set leaves less than is left now.
    """
    sure = sorted((job for job in unpaid if job[0].change != OPEN and rms(job[1]) > 0), key=lambda job: -rms(job[1]))
    tried = sure[: ORDER.tried_together]
    sets = [s for size in range(2, len(tried) + 1) for s in itertools.combinations(tried, size)]
    if not sets:
        return []
    leaves = [rms(left - moved_by(each)) for each in sets]
    best = min(leaves)
    if best > (1 - ORDER.as_good) * rms(left):
        return []
    return list(next(each for each, mm in zip(sets, leaves, strict=True) if mm <= (1 + ORDER.as_good) * best))


def moved_by(jobs: Iterable[Job]) -> Array:
    """(n, 3) mm what the tool moves by all of them."""
    total: Array = np.sum([moved for _, moved in jobs], axis=0)
    return total


def in_one_step(jobs: Sequence[Job]) -> Task:
    """One step of several tasks; what it is worth stands open."""
    tasks = [task for task, _ in jobs]
    numbered = [f"({n}) {task.instruction}" for n, task in enumerate(tasks, start=1)]
    otherwise = [f"({n}) {task.cure}" for n, task in enumerate(tasks, start=1) if task.cure]
    return replace(
        tasks[0],
        what=f"Only together: {'; '.join(task.what[:1].lower() + task.what[1:] for task in tasks)}",
        place=places_in_words(list(dict.fromkeys(task.place for task in tasks))),
        change=f"{enumerated(list(dict.fromkeys(task.change for task in tasks)))} together",
        motion="; ".join(task.motion for task in tasks if task.motion),
        instruction=f"{TOGETHER} {' '.join(numbered)}",
        cure=" ".join(otherwise),
        confirm=" ".join(dict.fromkeys(task.confirm for task in tasks)),
        unless=" ".join(dict.fromkeys(task.unless for task in tasks if task.unless)),
        members=tuple(member for task in tasks for member in task.members),
    )
