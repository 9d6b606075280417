"""What a service engineer does about a verdict: per cause the place, the direction, the change and its worth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from armscope.core.averages import rms
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.core.words import enumerated, uncapitalised
from armscope.physics.backgrounds import DRIFT, ELASTIC, GEOMETRIC, THERMAL, TRANSMISSION
from armscope.verdict.constants import ORDER, REPAIRS
from armscope.verdict.contributions import Contributions, Repair
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.doubts import OPEN
from armscope.verdict.effects import Cause, FoundEffect
from armscope.verdict.entered_together import (
    CALIBRATION,
    Job,
    calibrated_last,
    found_by_calibration,
    in_one_step,
    moved_by,
    pays_together,
)
from armscope.verdict.family_cures import cure_of_family, growth_in_words, warms
from armscope.verdict.importance import minor_and_told
from armscope.verdict.instruments_own import SETTLE_FIRST, beside_the_instrument, instrument_is_open
from armscope.verdict.out_of_reach import out_of_reach
from armscope.verdict.scatter_steps import beside_scatter, finding_out
from armscope.verdict.tasks import Task, task_of
from armscope.verdict.wording import GROWS, SMALL, capitalised, places_in_words

ALL_AT_ONCE = {GEOMETRIC: CALIBRATION, ELASTIC: "elastic model", TRANSMISSION: "correction table", DRIFT: "fastening",
               THERMAL: "temperature"}  # fmt: skip
"""What is changed for the small errors of a family in all joints and links."""
OWN_FIT = (
    " The expected error is that of the model fitted here; armscope calibrate fits zeros and rows afresh, and reports "
    "its own error on held-out rows."
)
"""On two public sets, by 70 % of the rows: 0.24 mm expected and 0.17 mm on the rest by `armscope calibrate`; 0.69 and
1.05 mm, where it leaves what no zero and no row can say."""
COMPENSATE = "armscope compensate"
NOT_ON_TOP = (
    "Commands from armscope compensate take out all that was found, other steps included: use them in place of those, "
    "never on top. Once anything is changed at the arm or in its controller, measure and diagnose again first."
)
"""The model file holds the arm as it was recorded: a zero set anew and commanded away is off by as much again."""
NO_GAIN = "Curing it does not lower the error at this point: confirm it before you change anything."
AFTER_REPAIRS = "Diagnose again after the repairs above: this is for what they leave."
ON_OTHERS = "Predict other poses (armscope predict) and measure a few of them."
"""In its place where there is nothing to repair first."""
DOES_NOTHING = "by itself it changes nothing: payload data act only where what gives way is corrected, by {}"
"""In place of what a payload's correction alone would leave."""


@dataclass(frozen=True)
class WorkOrder:
    """What to do, and what was found besides."""

    # in the order in which they pay: repairs, then what takes out small errors everywhere, then what pays only after
    # that (minor effects, too, where it is much), what pays only together as one step, and corrected commands for what
    # is left
    tasks: tuple[Task, ...]
    besides: tuple[str, ...]  # in words, causes that leave the error as it is in their turn, and what to do about them
    instrument_first: bool = False  # whether the instrument is to be settled before commands are corrected
    out_of_reach: str = ""  # what no command takes out, in words

    @property
    def caution(self) -> str:
        """What must not be done together, and what no command takes out; "" where neither is to be said."""
        by_model = any(COMPENSATE in f"{task.instruction} {task.cure}" for task in self.tasks)
        if by_model and self.instrument_first:
            return SETTLE_FIRST
        cautions = (NOT_ON_TOP if by_model and len(self.tasks) > 1 else "", self.out_of_reach)
        return " ".join(each for each in cautions if each)

    @property
    def by_calibration(self) -> str:
        """The step that fits zeros and rows afresh, as a number in a table tells it; "" where there is none."""
        steps = (n for n, task in enumerate(self.tasks, start=1) if task.change == CALIBRATION)
        return next((f"by the calibration of step {n}, not besides" for n in steps), "")

    def step_of(self, *asked: str) -> str:
        """Where a number that stands in a table belongs, in words: an entry by itself may make the error larger.

        Args:
            asked: "effect at location"; of several, the first that is in a step.

        Returns:
            The step and what it must not be done without.
        """
        for number, task in enumerate(self.tasks, start=1):
            member = next((each for each in asked if each in task.members), None)
            if member is None:
                continue
            if task.change == CALIBRATION:
                return self.by_calibration
            if len(task.members) > 1:
                others = places_in_words([each.partition(" at ")[2] for each in task.members if each != member])
                return f"step {number}, only together with {others}"
            return f"step {number}{', not before the steps above it' if task.only_after else ''}"
        return "no step: alone it does not lower the error"


def work_order(verdict: Diagnosis, worth: Contributions) -> WorkOrder:
    """The work order of a verdict: tasks for effects that pay in their turn, and for small errors of a cause."""
    rows = spread_evenly(len(verdict.recordings), REPAIRS.motion_rows)
    scene = verdict.model.posture(verdict.model.scene(verdict.recordings.rows(rows))).scene

    def asked(effect: FoundEffect) -> bool:
        poses = verdict.next_poses
        return poses is not None and poses.settle and poses.ask_about(effect)

    def jobs(some: Sequence[Repair]) -> list[Job]:
        tasks = [task_of(scene, each, each.effects[0], asked(each.effects[0])) for each in some]
        return [(beside_the_instrument(task, verdict), each.moved) for task, each in zip(tasks, some, strict=True)]

    told, single = _told_together(verdict, worth.single)
    together = [_as_one(cause, members, jobs(members)) for cause, members in told]
    major = jobs([*worth.causes, *(each for each in single if not each.effects[0].minor)])
    minor = jobs([each for each in single if each.effects[0].minor])
    repairs = [*major, *together]
    worst = {each.family: each.worst for each in verdict.background_families if each.present and each.family in SMALL}
    growth = growth_in_words(verdict.model.background)
    small = [(_everywhere(each, worst[each], growth), moved) for each, moved in worth.small.items() if each in worst]
    before = rms(worth.before)
    alone = {id(task): rms(worth.before - moved) for task, moved in (*repairs, *minor, *small)}
    each_pays = [job for job in repairs if alone[id(job[0])] < before]
    not_yet = [job for job in repairs if not _among(job, each_pays)]
    first, left, _ = _by_gain([job for job in each_pays if not _awaits(job, not_yet)], worth.before)
    entered = [job for job in (*major, *minor, *together) if found_by_calibration(job[0])]
    geometric = [job for job in entered if not _among(job, first)]
    small = [_calibrating(job, geometric) if job[0].change == CALIBRATION else job for job in small]
    alone |= {id(task): rms(worth.before - moved) for task, moved in small}
    then, left, _ = _by_gain([job for job in small if alone[id(job[0])] < before], left)
    done_so_far = [*first, *then, *geometric]
    last, left, unpaid = _by_gain([job for job in (*repairs, *small) if not _among(job, done_so_far)], left)
    if not any(task.change == CALIBRATION for task, _ in (*then, *last)):  # none puts their geometry right
        by_themselves = [job for job in repairs if _among(job, geometric)]
        more, left, waiting = _by_gain(by_themselves, left)
        last, unpaid, geometric = [*last, *more], [*unpaid, *waiting], []
    smaller, left, _ = _by_gain([job for job in minor if not _among(job, geometric)], left, ORDER.worth_of_minor)
    unpaid = [job for job in unpaid if any(job[0] is task for task, _ in repairs)]
    joint: list[Job] = []
    if against := pays_together(unpaid, left):  # each alone makes it worse: one step of all, and what pays after it
        joint = [(in_one_step(against), moved_by(against))]
        waiting = [job for job in unpaid if not _among(job, against)]
        more, left, unpaid = _by_gain([*joint, *waiting], left)
        smaller = [*smaller, *more]
    moved = {id(task): moved for task, moved in (*repairs, *minor, *small, *joint)}
    jobs_in_turn = [(beside_scatter(task, verdict), moved[id(task)]) for task, _ in (*first, *then, *last, *smaller)]
    done = _in_turn(calibrated_last(jobs_in_turn, worth.before), worth.before)
    done = [_after_what_it_needs(task, done[:n]) for n, task in enumerate(done)]
    done[:1] = [replace(task, confirm=task.confirm.replace(AFTER_REPAIRS, ON_OTHERS)) for task in done[:1]]
    moving = [task.what for task, moved in unpaid if rms(moved) > 0]
    unmoved = [task for task, moved in unpaid if rms(moved) == 0]
    to_find = finding_out(unmoved, verdict, done[-1].then_mm if done else before)
    besides = [task for task in unmoved if not any(task.members == each.members for each in to_find)]
    if rms(worth.left) < (1 - ORDER.worth_together) * rms(left):
        names = [uncapitalised(what) for what in moving]
        to_find.append(_together(names, rms(worth.left), instead=bool(done)))
        moving = []
    lost = [f"{what}. {NO_GAIN}" for what in moving]
    waiting_on = (f"{task.what}. {task.cure}" for task in besides)
    return WorkOrder((*done, *to_find), (*lost, *waiting_on), instrument_is_open(verdict), out_of_reach(verdict, worth))


def _told_together(
    verdict: Diagnosis, single: Sequence[Repair]
) -> tuple[list[tuple[Cause, list[Repair]]], list[Repair]]:
    """Causes of minor members alone that the headline tells all the same, with their repairs; and all other repairs."""
    told = []
    for cause in minor_and_told(verdict.causes):
        those = [each for each in single if each.effects[0].as_member in cause.members]
        told += [(cause, those)] if those else []
    taken = {id(each) for _, those in told for each in those}
    return told, [each for each in single if id(each) not in taken]


def _as_one(cause: Cause, members: Sequence[Repair], jobs: Sequence[Job]) -> Job:
    """The task of several minor effects that only together are worth telling, and what they move together."""
    moved = sum((each.moved for each in members[1:]), members[0].moved)
    tasks = [task for task, _ in jobs]
    if len(tasks) == 1:
        return tasks[0], moved
    changes = dict.fromkeys(task.change for task in tasks if task.change)
    task = Task(
        what=capitalised(cause.text),
        place=places_in_words(list(dict.fromkeys(each.effects[0].location for each in members))),
        change=OPEN if OPEN in changes else enumerated(list(changes)),
        motion="; ".join(task.motion for task in tasks if task.motion),
        instruction=cause.cure.replace("`", ""),
        cure=" ".join(f"{capitalised(task.place)}: {task.cure}" for task in tasks),
        confirm=" ".join(dict.fromkeys(task.confirm for task in tasks)),
        members=tuple(member for task in tasks for member in task.members),
    )
    return task, moved


def _together(names: Sequence[str], left_mm: float, instead: bool) -> Task:
    """What pays only with all the rest: causes that work against each other, and those too small for a repair."""
    compensate = f"ompensate for the whole fitted model in the commands ({COMPENSATE})."
    of_it = f" Cured one by one, these do not pay: {'; '.join(names)}." if names else ""
    return Task(
        what="All of it, with what is left: causes that work against each other, or are small",
        place="whole arm",
        change="corrected commands",
        motion="",
        instruction=f"{'In place of the steps above, c' if instead else 'C'}{compensate}{of_it}",
        cure="",
        confirm="Measure a few poses under corrected commands.",
        alone_mm=left_mm,
        then_mm=left_mm,
        instead=instead,
    )


def _by_gain(
    waiting: Sequence[Job], left: Array, least: float = ORDER.least_gain
) -> tuple[list[tuple[Task, float]], Array, list[Job]]:
    """Tasks in the order in which they pay, with the error after each; what is left then; and those that don't pay."""
    done, waiting = [], list(waiting)
    while waiting:
        ready = [job for job in waiting if not _awaits(job, waiting)]
        if not ready:
            break
        best = min(ready, key=lambda job: rms(left - job[1]))
        if rms(left - best[1]) > (1 - least) * rms(left):
            break
        left = left - best[1]
        done.append((best[0], rms(left)))
        waiting = [job for job in waiting if job is not best]
    return done, left, waiting


def _in_turn(jobs: Sequence[Job], before: Array) -> list[Task]:
    """Tasks with the error that each leaves alone, and after all before it."""
    done, left = [], before
    for task, moved in jobs:
        left, alone = left - moved, rms(before - moved)
        done.append(replace(task, alone_mm=alone, then_mm=rms(left), only_after=alone >= rms(before)))
    return done


def _awaits(job: Job, others: Sequence[Job]) -> bool:
    """Whether one of the others has to be done before a task has any effect."""
    needed = (task for task, _ in others if task.members and not task.requires)
    return bool(job[0].requires) and any(task.family == job[0].requires for task in needed)


def _after_what_it_needs(task: Task, before: Sequence[Task]) -> Task:
    """A task that does nothing by itself, with the steps that it needs; any other as it is."""
    if not task.requires:
        return task
    steps = [str(n) for n, each in enumerate(before, start=1) if each.family == task.requires and not each.requires]
    which = f"step{'s' * (len(steps) > 1)} {enumerated(steps)}" if steps else COMPENSATE
    return replace(task, needs=DOES_NOTHING.format(which), only_after=False)


def _among(job: Job, others: Sequence[tuple[Task, object]]) -> bool:
    return any(job[0] is task for task, _ in others)


def _calibrating(calibration: Job, geometric: Sequence[Job]) -> Job:
    """A calibration with what else is off in the geometry by then: it fits zeros and rows afresh, so it mends that too.

    Put right once more after it, a row was off by as much again.
    """
    task, moved = calibration
    if not geometric:
        return calibration
    names = places_in_words(list(dict.fromkeys(other.place for other, _ in geometric)))
    instruction = f"{task.instruction} This puts right {names}, too: change nothing there besides."
    members = tuple(member for other, _ in geometric for member in other.members)
    return replace(task, instruction=instruction, members=members), sum((each for _, each in geometric), moved)


def _everywhere(family: str, worst: str, growth: str) -> Task:
    """What takes out the small errors of a family in all joints and links at once."""
    cure = cure_of_family(family, (), True, worst, growth).replace("`", "")
    warming, usual = warms(family, worst), "in any session" if family == DRIFT else "any arm has"
    return Task(
        what=capitalised(GROWS.format(worst) if warming else f"{SMALL[family]}, as {usual}"),
        place=worst if warming else "set-up" if family == DRIFT else "whole arm",
        change="warm-up" if warming else ALL_AT_ONCE[family],
        motion="",
        instruction=cure + (OWN_FIT if family == GEOMETRIC else ""),
        cure="",
        confirm=AFTER_REPAIRS,
        family=family,
    )
