"""One line of a work order: what is done about a cause, where, by how much, with signs."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.location import Location
from armscope.physics.cure import INSTRUCTION_WORDS
from armscope.physics.effect import Effect
from armscope.physics.elastic import UNKNOWN_MASSES
from armscope.physics.geometric import LINK_GEOMETRY
from armscope.physics.registry import effect_named
from armscope.physics.scene import Scene
from armscope.robot import Arm
from armscope.verdict.constants import ORDER
from armscope.verdict.contributions import Repair
from armscope.verdict.corrections import bars_set_right, corrected_origin, place_and_angles
from armscope.verdict.doubts import OPEN, Doubt, alike_in_words, doubt_of, unless_confirmed
from armscope.verdict.effects import FoundEffect, Parameter
from armscope.verdict.entries import angle, length
from armscope.verdict.filenames import CURVES
from armscope.verdict.motion_in_words import correction_in_words, motion_in_words
from armscope.verdict.payload_place import instruction_of
from armscope.verdict.sentences import exact_phrase, phrase
from armscope.verdict.untold import untold
from armscope.verdict.wording import capitalised, half_interval, read_parameter

FIND_OUT = "to be found out"  # What is changed about what scatters: nothing before it is known what it follows


@dataclass(frozen=True)
class Task:
    """One line of a work order, in words."""

    what: str  # who does what, by how much
    # place, change: where, and what is changed there, in two words
    place: str
    change: str
    motion: str  # how far and which way it goes in these recordings: mm, mrad and degrees, with signs
    # instruction, cure: what to do; and the rule by which it is commanded away
    instruction: str
    cure: str
    confirm: str  # how to confirm it first
    unless: str = ""  # what it could be if that does not confirm it; "" where nothing else is left
    alike: str = ""  # what it may be as well without any other cure; "" where there is nothing such
    # alone_mm, then_mm: RMS per axis on the recorded rows once this alone, or this and all before it, is cured
    alone_mm: float = math.nan
    then_mm: float = math.nan
    only_after: bool = False  # it pays only once all before it is done: alone it would make the error larger
    instead: bool = False  # it stands in place of all before it, and holds them
    members: tuple[str, ...] = ()  # "effect at location" of what it cures; none for what is everywhere
    family: str = ""  # of what it cures
    # the family without whose correction it does nothing: a payload's data act through what gives way
    requires: str = ""
    needs: str = ""  # what has to be done first for that, in words
    beside_scatter: bool = False  # why its joint scatters is to be settled first

    def headed(self, between: str) -> str:
        """Where and what is changed there, apart by ``between``; once where one says the other ("payload data")."""
        said = self.change.lower().startswith(self.place.lower())
        return capitalised(self.change if said else between.join(filter(None, (self.place, self.change))))

    @property
    def finds_out(self) -> bool:
        """Whether it finds out what a cause is, and lowers no error by itself."""
        return self.change == FIND_OUT

    @property
    def unsettled(self) -> bool:
        """Whether it is to be found out first what the cause is."""
        return self.change == OPEN


def task_of(scene: Scene, cause: Repair, effect: FoundEffect, asked: bool = False) -> Task:
    """What is done about a cause; what it is worth stands open.

    Args:
        scene: the fitted model's, of the recorded rows.
        cause: with its parts of the fitted model.
        effect: the effect that it is cured as.
        asked: whether further measurements that the verdict asks for settle it.

    Returns:
        The task.
    """
    # what scatters has no curve to correct by
    known = None if effect.scatters else _definition(cause, effect)
    words = dict.fromkeys(INSTRUCTION_WORDS, "–") | {"location": effect.location, "size": ""}
    words["jump"] = _jump(effect)
    words["row"] = "; ".join(_row(effect)) or "these poses do not separate its errors"
    in_urdf = effect.effect == LINK_GEOMETRY.name and scene.arm.description.dh is None
    if in_urdf:
        words["location"], words["row"] = _origin(scene.arm, effect)
    words["bars"] = bars_set_right(effect.parameters)
    words["correction"] = correction_in_words(scene, cause.parts)
    told = {p.name: p for p in effect.parameters if not untold(p, effect)}
    if "offset" in told:
        stands = angle(told["offset"].value, told["offset"].stderr)
        words["zero"] = f"where the controller shows 0°, the joint stands at {stands}"
    if "compliance" in told:
        size = read_parameter(told["compliance"], effect.effect)
        words["size"] = f" (minus {size.value} × load)"
    if "soft_turn" in told:
        words["soft_turn"] = read_parameter(told["soft_turn"], effect.effect).value
    if "coupling" in told:
        value = read_parameter(told["coupling"], effect.effect).value
        words["coefficient"] = value.removeprefix("−") if value.startswith("−") else f"−{value}"
    if "ratio" in told:
        words["ratio"] = f"{1 / (1 + told['ratio'].value):.6f}"
    correction_told = known is not None and "{correction}" in known.cure.instruction
    row_told = effect.effect == LINK_GEOMETRY.name and bool(told)
    said_already = "offset" in told or words["jump"] or correction_told or row_told or in_urdf
    instruction = instruction_of(effect, scene.arm, known.cure.instruction.format(**words)) if known else ""
    rule = (known.cure.rule if known else effect.cure).replace("`", "")
    task = Task(
        what=capitalised(exact_phrase(effect) if effect.same_cure else phrase(effect)),
        place=effect.location,
        change="joint origin" if in_urdf else known.cure.change if known else "",
        motion=""
        if said_already
        else motion_in_words(scene, cause.parts, zero=cause.zero if effect.nameless else None),
        instruction=instruction,
        cure=f"{with_numbers(rule, told.values(), effect.effect)}{_where_its_curve_is(cause, effect, rule)}"
        + _beyond_the_rule(scene.arm, cause, told),
        confirm=effect.confirm,
        unless=unless_confirmed(effect),
        alike=alike_in_words(effect) if effect.same_cure or effect.named_as == "effect" else "",
        members=(effect.as_member,),
        family=effect.family,
        requires=known.requires if known else "",
        needs=known.cure.needs if known else "",
    )
    doubt = doubt_of(effect, asked)
    return task if doubt is None else _in_doubt(task, doubt)


def _in_doubt(task: Task, doubt: Doubt) -> Task:
    return replace(
        task,
        what=capitalised(doubt.what),
        place=doubt.place,
        change=OPEN,
        motion="",
        instruction=doubt.instruction + task.instruction,
        cure=doubt.meanwhile,
        confirm=doubt.confirm,
    )


def _definition(cause: Repair, effect: FoundEffect) -> Effect | None:
    """What defines an effect: as it was placed, since a variant may have a cure of its own."""
    key = (effect.effect, effect.location)
    own = (part for part in cause.parts if (part.placed.name, part.placed.location) == key)
    return next((part.placed.effect.told_as(float(part.values[0])) for part in own), effect_named(effect.effect))


def _origin(arm: Arm, effect: FoundEffect) -> tuple[str, str]:
    """Which origin of a URDF is put right for a link's geometry, and what it becomes, as the file writes it.

    The file writes an origin along its parent's axes, and its error is told along the joint's, which may be turned.
    """
    joint = Location.of(effect.location).number
    xyz, rpy = place_and_angles(corrected_origin(arm, effect, joint))
    numbers = (" ".join(f"{value:.6f}" for value in np.round(each, 6) + 0.0) for each in (xyz, rpy))
    where = f"{effect.location}, joint {arm.joint_names[joint - 1]}'s origin,"
    return where, '<origin xyz="{}" rpy="{}"/>'.format(*numbers) + AXES_OF_ORIGIN


AXES_OF_ORIGIN = " (along its parent link's axes; what is told along x, y and z is along the joint's own)"
FORMULA = re.compile(r"(?:commanded|length|mass|turn) = (.*)", re.DOTALL)
"""What a rule's numbers are named in; a row's and a zero's stand in their instructions."""
BEYOND_THE_RULE = (
    " The mass moments behind this number were fitted, too, and stand in no rule: the error expected is that of the "
    "stated masses, and only armscope compensate takes out the rest."
)
LOAD_NOT_KNOWN = (
    " No masses are stated, so this load cannot be calculated from the robot's file: the mass moments were fitted, "
    "too. Leave it for last: measure and diagnose again after the other steps, and take commands from armscope "
    "compensate, which has these moments."
)
NO_NUMBER = "These recordings do not determine its number: let armscope compensate compute the commands."
"""Without masses, what gives way is known by the product with them, which the model file has."""


def with_numbers(rule: str, parameters: Iterable[Parameter], effect: str) -> str:
    """A rule, and behind it the numbers that its formula names: "Here offset = −0.1778° (−3.103 mrad).".

    Args:
        rule: of an effect's cure.
        parameters: of the effect, those that are told.
        effect: its name.

    Returns:
        The rule; it says so where nobody knows the number that it needs.
    """
    formula = _formula(rule)
    words = dict.fromkeys(re.findall(r"\w+", formula))
    known = {p.name: p for p in parameters}
    centre = [name for name in known if name.startswith("com_")] if "com" in words else []
    named = [known[name] for name in (*words, *centre) if name in known]
    if named:
        numbers = (f"{p.name.replace('com_', 'com ')} = {_number(p, effect)}" for p in named)
        return f"{rule} Here {', '.join(numbers)}."
    return f"{rule} {NO_NUMBER}" if "compliance" in formula else rule


def _where_its_curve_is(cause: Repair, effect: FoundEffect, rule: str) -> str:
    """Behind a rule that subtracts a curve: where its numbers are, and what of them is constant.

    Over a joint's own angle that is its zero; over its load it is the mean of what follows the load, too.
    """
    if not _formula(rule).startswith("wanted - curve"):
        return ""
    if effect.curve is None:
        return " Its numbers are in model.yaml alone: let armscope compensate compute the commands."
    there = f" The curve is in {CURVES} ({effect.effect}, {effect.location}, {effect.driver}): value over at."
    if not cause.zero:
        return there
    own = angle(cause.zero) if effect.curve.value_unit == "rad" else length(1e3 * cause.zero)
    constant = "a constant part" if effect.driver.startswith("load") else "the joint's own zero"
    return f"{there} It holds {constant}, {own}, too, which no other step sets."


def _beyond_the_rule(arm: Arm, cause: Repair, told: Mapping[str, Parameter]) -> str:
    """Behind a compliance that is not all that was fitted: what its formula leaves, or that nobody can calculate it."""
    if cause.unsaid is not None:
        return BEYOND_THE_RULE
    free = any(part.placed.variant == UNKNOWN_MASSES for part in cause.parts)
    return LOAD_NOT_KNOWN if free and "compliance" in told and not arm.has_masses else ""


def _formula(rule: str) -> str:
    found = FORMULA.search(rule)
    return found[1] if found else ""


def _number(parameter: Parameter, effect: str) -> str:
    if parameter.name == "per_turn":
        return f"{parameter.value:g}"
    if parameter.unit == "rad" and parameter.name != "phase":
        return angle(parameter.value, parameter.stderr)
    return f"{read_parameter(parameter, effect).value}{half_interval(parameter)}"


def _jump(effect: FoundEffect) -> str:
    """How far and which way: of a joint, or in the axes of what jumped."""
    zero = next((p for p in effect.parameters if p.name == "jump"), None)
    if zero is not None:
        how_far = f"it jumped by {angle(zero.value, zero.stderr)}"
        return f" ({'by how much, these poses leave open' if untold(zero, effect) else how_far})"
    named = {"rx": "about x", "ry": "about y", "rz": "about z"}
    told = [
        f"{named[p.name]} {angle(p.value, p.stderr)}" if p.name in named else f"{p.name} {length(p.value, p.stderr)}"
        for p in effect.parameters
        if p.name in ("x", "y", "z") or (p.name in named and abs(p.value) > ORDER.least_turn_rad)
    ]
    axes = "the last D-H frame" if effect.location == "tool" else "the base frame"
    return f" (it jumped by {', '.join(told)} in {axes})" if told else ""


def _row(effect: FoundEffect) -> Iterator[str]:
    for p in effect.parameters:
        if untold(p, effect):
            continue
        size = length(p.value, p.stderr) if p.unit == "mm" else angle(p.value, p.stderr)
        yield f"{p.name} = stated {p.name} {size if size[0] in '+−' else f'+{size}'}"
