"""Causes that work against each other, as one step: set one by one they make the error larger, together they pay."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from armscope.core.averages import rms
from armscope.core.types import Array
from armscope.core.words import enumerated, uncapitalised
from armscope.physics.backgrounds import GEOMETRIC
from armscope.verdict.calibrated import ENTERED
from armscope.verdict.constants import ORDER
from armscope.verdict.doubts import OPEN
from armscope.verdict.tasks import Task
from armscope.verdict.wording import places_in_words

Job = tuple[Task, Array]  # A task, and what the tool moves by what it cures
CALIBRATION = "calibration"  # What is changed where zeros and rows are fitted afresh, to new measurements
CALIBRATED_LAST = "In this order, and with what comes first already done when the arm is measured for the calibration."
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
        what=f"Only together: {'; '.join(uncapitalised(task.what) for task in tasks)}",
        place=places_in_words(list(dict.fromkeys(task.place for task in tasks))),
        change=f"{enumerated(list(dict.fromkeys(task.change for task in tasks if task.change)))} together".lstrip(),
        motion="; ".join(task.motion for task in tasks if task.motion),
        instruction=f"{TOGETHER} {' '.join(numbered)}",
        cure=" ".join(otherwise),
        confirm=" ".join(dict.fromkeys(task.confirm for task in tasks)),
        unless=" ".join(dict.fromkeys(task.unless for task in tasks if task.unless)),
        members=tuple(member for task in tasks for member in task.members),
    )


def found_by_calibration(task: Task) -> bool:
    """Whether zeros and D-H rows fitted afresh hold all that a task is of."""
    return bool(task.members) and all(member.partition(" at ")[0] in ENTERED for member in task.members)


def calibrated_last(jobs: Sequence[Job], before: Array) -> list[Job]:
    """A calibration with what is named after it as one step, in which the calibration comes last.

    By new measurements it takes up part of whatever is still there. What was then corrected by its first size was
    corrected twice: a wave of a gear left more than before. What is off in the geometry and no row holds (a bearing
    that wobbles, a bar) is mended at the arm, as a step of its own before it, if that alone pays.

    Args:
        before: (n, 3) mm, the error with none of them done.
    """
    at = next((n for n, (task, _) in enumerate(jobs) if task.change == CALIBRATION), len(jobs))
    after = [job for job in jobs[at + 1 :] if _can_be_done_before(job[0])]
    if not after:
        return list(jobs)
    others = [job for job in jobs[at + 1 :] if not _can_be_done_before(job[0])]
    repaired = [job for job in after if job[0].family == GEOMETRIC and rms(before - job[1]) < rms(before)]
    after = [job for job in after if not any(job is each for each in repaired)]
    one = jobs[at]
    if after:
        one = (_and_calibrated([task for task, _ in after], jobs[at][0]), moved_by([*after, jobs[at]]))
    return [*jobs[:at], *repaired, one, *others]


def _can_be_done_before(task: Task) -> bool:
    """Whether a step is of places, is not to be settled first, and does something by itself."""
    return bool(task.members) and not (task.unsettled or task.beside_scatter or task.requires)


def _and_calibrated(first: Sequence[Task], calibration: Task) -> Task:
    tasks = [*first, calibration]
    whats = [first[0].what, *(uncapitalised(task.what) for task in tasks[1:])]
    numbered = [f"({n}) {task.instruction}" for n, task in enumerate(tasks, start=1)]
    return replace(
        calibration,
        what=f"{'; '.join(whats[:-1])}; and {whats[-1]}",
        instruction=" ".join([CALIBRATED_LAST, *numbered]),
        cure=" ".join(f"({n}) {task.cure}" for n, task in enumerate(first, start=1) if task.cure),
        motion="; ".join(task.motion for task in first if task.motion),
        confirm=" ".join(dict.fromkeys(task.confirm for task in tasks)),
        unless=" ".join(dict.fromkeys(task.unless for task in first if task.unless)),
        members=tuple(member for task in tasks for member in task.members),
    )
