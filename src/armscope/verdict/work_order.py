"""What a service engineer does about a verdict: per cause the place, the direction, the change and its worth."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.averages import rms
from armscope.core.location import Location
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.physics.backgrounds import DRIFT, ELASTIC, GEOMETRIC, TRANSMISSION
from armscope.physics.registry import effect_named
from armscope.physics.scene import Part, Scene
from armscope.physics.soft_start import TURNED
from armscope.verdict.contributions import Contributions, Repair
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.effects import FoundEffect
from armscope.verdict.family_cures import cure_of_family
from armscope.verdict.sentences import exact_phrase, phrase
from armscope.verdict.wording import SMALL, capitalised, effect_in_words, enumerated, implausible, plain, read_parameter

ALL_AT_ONCE = {
    GEOMETRIC: "calibration", ELASTIC: "elastic model", TRANSMISSION: "correction table", DRIFT: "fastening"
}  # fmt: skip
"""What is changed for the small errors of a family in all joints and links."""
OWN_FIT = (
    " The expected error is that of the model fitted here; armscope calibrate fits zeros and rows afresh, and reports "
    "its own error on held-out rows."
)
"""On two public sets, by 70 % of the rows: 0.24 mm expected and 0.17 mm on the rest by `armscope calibrate`; 0.69 and
1.05 mm, where it leaves what no zero and no row can say."""
LEAST_GAIN = 0.03
"""Share of the error that a task must take away in its turn."""
WORTH_TOGETHER = 0.1
"""Share of the error from which all that is left in the fitted model is commanded away together."""
WORTH_OF_MINOR = 0.25
"""The same from which a minor effect is a task of its own in its turn: judgement, with two real arms in view."""
NO_GAIN = "Curing it does not lower the error at this point: confirm it before you change anything."
RIVALS = 2
"""What else a cause could be, as told in a task: the nearest."""
LEAST_TURN = 5e-5
"""Smaller turns of a jump (rad) are not told: at a metre they are less than what jumps are measured by."""
STEADY = 0.02
"""A motion whose range is below this share of its size is told as one number."""


@dataclass(frozen=True)
class Task:
    """One line of a work order, in words.

    Attributes:
        what: who does what, by how much.
        place, change: where, and what is changed there, in two words.
        motion: how far and which way it goes in these recordings: mm, mrad and degrees, with signs.
        instruction, cure: what to do; and the rule by which it is commanded away.
        confirm: how to confirm it first.
        alone_mm, then_mm: RMS per axis on the recorded rows once this alone, or this and all before it, is cured.
        only_after: it pays only once all before it is done: alone it would make the error larger.
    """

    what: str
    place: str
    change: str
    motion: str
    instruction: str
    cure: str
    confirm: str
    alone_mm: float = math.nan
    then_mm: float = math.nan
    only_after: bool = False


MOST_ROWS = 20_000
"""In which a repair's motion is looked for: all frames of a million rows would take four gigabytes."""


@dataclass(frozen=True)
class WorkOrder:
    """What to do, and what was found besides.

    Attributes:
        tasks: in the order in which they pay: repairs, then what takes out small errors everywhere, then what pays
            only after that (minor effects, too, where it is much), and corrected commands for what pays together.
        besides: in words, causes that leave the error as it is in their turn, and what to do about them.
    """

    tasks: tuple[Task, ...]
    besides: tuple[str, ...]


def work_order(verdict: Diagnosis, worth: Contributions) -> WorkOrder:
    """The work order of a verdict: tasks for effects that pay in their turn, and for small errors of a cause."""
    rows = spread_evenly(len(verdict.recordings), MOST_ROWS)
    scene = verdict.model.posture(verdict.model.scene(verdict.recordings.rows(rows))).scene
    asked = verdict.next_poses is not None

    def jobs(some: Sequence[Repair]) -> list[Job]:
        return [(task_of(scene, each, each.effects[0], asked), each.moved) for each in some]

    repairs, minor = jobs(worth.causes), jobs(worth.single)
    present = {family.family for family in verdict.background_families if family.present and family.family in SMALL}
    small = [(_everywhere(family), moved) for family, moved in worth.small.items() if family in present]
    before = rms(worth.before)
    alone = {id(task): rms(worth.before - moved) for task, moved in (*repairs, *minor, *small)}
    first, left, _ = _by_gain([job for job in repairs if alone[id(job[0])] < before], worth.before)
    then, left, _ = _by_gain([job for job in small if alone[id(job[0])] < before], left)
    done_so_far = {id(task) for task, _ in (*first, *then)}
    last, left, unpaid = _by_gain([job for job in (*repairs, *small) if id(job[0]) not in done_so_far], left)
    smaller, left, _ = _by_gain(minor, left, WORTH_OF_MINOR)
    unpaid = [job for job in unpaid if any(job[0] is task for task, _ in repairs)]
    done = [
        replace(task, alone_mm=alone[id(task)], then_mm=then_mm, only_after=alone[id(task)] >= before)
        for task, then_mm in (*first, *then, *last, *smaller)
    ]
    moving = [task.what for task, moved in unpaid if rms(moved) > 0]
    if rms(worth.left) < (1 - WORTH_TOGETHER) * rms(left):
        done.append(_together([what[:1].lower() + what[1:] for what in moving], rms(worth.left)))
        moving = []
    lost = [f"{what}. {NO_GAIN}" for what in moving]
    return WorkOrder(tuple(done), (*lost, *(f"{task.what}. {task.cure}" for task, moved in unpaid if rms(moved) == 0)))


def _together(names: Sequence[str], left_mm: float) -> Task:
    """What pays only with all the rest: causes that work against each other, and those too small for a repair."""
    of_it = f" Cured one by one, these do not pay: {'; '.join(names)}." if names else ""
    return Task(
        what="What is left: causes that work against each other, or are small",
        place="whole arm",
        change="corrected commands",
        motion="",
        instruction=f"Compensate for the whole fitted model in the commands (armscope compensate).{of_it}",
        cure="",
        confirm="Measure a few poses under corrected commands.",
        alone_mm=left_mm,
        then_mm=left_mm,
    )


Job = tuple[Task, Array]
"""A task, and what the tool moves by what it cures."""


def _by_gain(
    waiting: Sequence[Job], left: Array, least: float = LEAST_GAIN
) -> tuple[list[tuple[Task, float]], Array, list[Job]]:
    """Tasks in the order in which they pay, with the error after each; what is left then; and those that don't pay."""
    done, waiting = [], list(waiting)
    while waiting:
        best = min(waiting, key=lambda job: rms(left - job[1]))
        if rms(left - best[1]) > (1 - least) * rms(left):
            break
        left = left - best[1]
        done.append((best[0], rms(left)))
        waiting = [job for job in waiting if job is not best]
    return done, left, waiting


def _everywhere(family: str) -> Task:
    """What takes out the small errors of a family in all joints and links at once."""
    return Task(
        what=f"{capitalised(SMALL[family])}, as {'in any session' if family == DRIFT else 'any arm has'}",
        place="set-up" if family == DRIFT else "whole arm",
        change=ALL_AT_ONCE[family],
        motion="",
        instruction=cure_of_family(family, (), True).replace("`", "") + (OWN_FIT if family == GEOMETRIC else ""),
        cure="",
        confirm="Diagnose again after the repairs above: this is for what they leave.",
    )


def task_of(scene: Scene, cause: Repair, effect: FoundEffect, asked: bool = False) -> Task:
    """What is done about a cause; what it is worth stands open.

    Args:
        scene: the fitted model's, of the recorded rows.
        cause: with its parts of the fitted model.
        effect: the effect that it is cured as.
        asked: whether the verdict asks for further measurements.

    Returns:
        The task.
    """
    # what scatters has no curve to correct by
    known = None if any(p.name == "scatter" for p in effect.parameters) else effect_named(effect.effect)
    words = {"location": effect.location, "zero": "–", "ratio": "–", "size": "", "jump": _jump(effect)}
    words["row"] = "; ".join(_row(effect)) or "these poses do not separate its errors"
    words["opposite"] = _motion(scene, cause.parts, -1) or "its opposite"
    told = {p.name: p for p in effect.parameters if not implausible(p, effect)}
    if "offset" in told:
        words["zero"] = f"where the controller shows 0°, the joint stands at {angle(told['offset'].value)}"
    if "compliance" in told:
        size = read_parameter(told["compliance"], effect.effect)
        words["size"] = f" (minus {size.value} × load)"
    if "soft_turn" in told:
        size = read_parameter(told["soft_turn"], effect.effect)
        words["size"] = f" (minus {size.value} × {TURNED.replace(' x ', ' × ')})"
    if "ratio" in told:
        words["ratio"] = f"{1 / (1 + told['ratio'].value):.6f}"
    return Task(
        what=capitalised(phrase(effect)),
        place=effect.location,
        change=known.cure.change if known else "",
        motion="" if "offset" in told or words["jump"] else _motion(scene, cause.parts),  # the instruction has it
        instruction=_settled(effect, asked) + (known.cure.instruction.format(**words) if known else ""),
        cure=(known.cure.rule if known else effect.cure).replace("`", ""),
        confirm=effect.confirm,
    )


def _jump(effect: FoundEffect) -> str:
    """How far and which way, in the axes of what jumped."""
    named = {"rx": "about x", "ry": "about y", "rz": "about z"}
    told = [
        f"{named[p.name]} {angle(p.value)}" if p.name in named else f"{p.name} {_signed(p.value, 3)} mm"
        for p in effect.parameters
        if p.name in ("x", "y", "z") or (p.name in named and abs(p.value) > LEAST_TURN)
    ]
    axes = "the last D-H frame" if effect.location == "tool" else "the base frame"
    return f" (it jumped by {', '.join(told)} in {axes})" if told else ""


def _settled(effect: FoundEffect, asked: bool) -> str:
    """What comes before the cure of a cause that these rows don't tell from others."""
    if effect.named_as == "effect":
        return ""
    which = plain(effect.title)
    if " or " not in which:  # kind and region: what they stand for is the best reading and the rivals nearest to it
        near = [effect_in_words(each.effect, each.location) for each in effect.alternatives[:RIVALS]]
        which = enumerated([effect_in_words(effect.effect, effect.location), *near], "or")
    how = " (see What to measure next)" if asked else ""
    return f"First find out which it is: {which}{how}. If {exact_phrase(effect)}: "


def angle(radians: float) -> str:
    """An angle with its sign, in degrees and mrad."""
    return f"{_signed(math.degrees(radians), 4)}° ({_signed(1e3 * radians, 3)} mrad)"


def _row(effect: FoundEffect) -> Iterator[str]:
    for p in effect.parameters:
        if implausible(p, effect):
            continue
        size = f"{_signed(p.value, 3)} mm" if p.unit == "mm" else angle(p.value)
        yield f"{p.name} = stated {p.name} {size}"


def _motion(scene: Scene, parts: tuple[Part, ...], sign: int = 1) -> str:
    """The largest turn and shift of parts over the recorded rows, in words, with signs; sign -1: to undo them."""
    amounts: dict[str, list[tuple[str, Array]]] = {"turns": [], "moves": []}
    for direction, amount in scene.amounts(parts).items():
        place = Location.of(direction.location)
        if place.kind in ("instrument", "payload"):
            continue
        turning = direction.axis == "turn" or direction.axis.startswith("r")
        about = "" if direction.axis == "turn" else f" {'about' if turning else 'along'} {direction.axis[1:]}"
        name = f"joint {place.number}" if place.kind == "motor" else direction.location
        amounts["turns" if turning else "moves"].append((f"{name}{about}", sign * np.asarray(amount)))
    told = []
    for verb, found in amounts.items():
        if found:
            name, amount = max(found, key=lambda pair: float(np.abs(pair[1]).max()))
            if np.abs(amount).max() > 0:
                told.append(f"{name} {verb} by {_range(amount, verb == 'turns')}")
    return "; ".join(told)


def _range(amount: Array, turning: bool) -> str:
    low, high = float(amount.min()), float(amount.max())
    if high - low < STEADY * max(abs(low), abs(high)):
        low = high = float(amount.mean())
    ends = [low] if low == high else [low, high]

    small = " … ".join(_signed(1e3 * end, 3) for end in ends)
    if not turning:
        return f"{small} mm"
    degrees = " … ".join(_signed(math.degrees(end), 4) for end in ends)
    return f"{small} mrad ({degrees}°)"


def _signed(value: float, decimals: int) -> str:
    text = f"{value:+.{decimals}f}"
    return (text if float(text) else text[1:]).replace("-", "−")
