"""A cause of a moving arm in words: a clause for the headline, and its cure with sign and number.

Signs: torque is the motor's, positive along the motion that it drives; a parameter is what the recorded torque has
beyond the stated model, so a cure that changes the model adds it, and one that changes the recording takes it away.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence

import numpy as np

from armscope.core.numerals import shown_unit
from armscope.motion.catalogue import SCALE
from armscope.motion.causes import PlacedCause
from armscope.motion.laws import Law
from armscope.motion.verdict import FoundCause
from armscope.robot.dynamics import MovingArm
from armscope.verdict.effects import INTERVAL, Parameter
from armscope.verdict.wording import decimals_for


def amount(parameter: Parameter, sign: bool = False) -> str:
    """A number with half its 95 % interval, in the unit of texts; its size, or with its sign.

    Args:
        parameter: in a unit of the files.
        sign: whether its sign is said, too.

    Returns:
        As in "39.6 ± 2.7 N s/m".
    """
    factor, unit = shown_unit(parameter.unit, abs(parameter.value))
    half = factor * INTERVAL * parameter.stderr
    known = math.isfinite(half) and half > 0
    decimals = decimals_for(half) if known else 3
    size = f"{factor * abs(parameter.value):.{decimals}f}"
    plus = ("−" if parameter.value < 0 else "+") if sign else ""
    return f"{plus}{size}{f' ± {half:.{decimals}f}' if known else ''} {unit}".strip()


def clause(cause: FoundCause) -> str:
    """Who does what, by how much: one cause in a sentence.

    Args:
        cause: with its parameters.

    Returns:
        The clause, small first letter.
    """
    numbers = {parameter.name: parameter for parameter in cause.parameters}
    say = _CLAUSES.get(cause.effect)
    told = say(cause, numbers) if say else f"{cause.title} ({_rms(cause)})"
    _, _, run = cause.title.partition(" in run ")
    return f"in run {run} {told}" if run else told


Numbers = dict[str, Parameter]


def _rms(cause: FoundCause) -> str:
    return f"{cause.rms:.2g} {cause.unit} RMS"


def _open(parameter: Parameter) -> bool:
    """Whether its sign is open."""
    low, high = parameter.interval
    return low <= 0 <= high


def _than_stated(what: str, more: str, less: str) -> Callable[[FoundCause, Numbers], str]:
    def say(cause: FoundCause, numbers: Numbers) -> str:
        (parameter,) = cause.parameters[:1]
        return f"{what.format(cause.location)} {amount(parameter)} {more if parameter.value > 0 else less} than stated"

    return say


def _asymmetric(cause: FoundCause, numbers: Numbers) -> str:
    difference = numbers["viscous_difference"]
    forward, backward = ("higher", "lower") if difference.value > 0 else ("lower", "higher")
    size = amount(difference)
    told = f"viscous friction of {cause.location} is {size} {forward} forward than its mean"
    return f"{told}, as much {backward} backward"


def _delay(cause: FoundCause, numbers: Numbers) -> str:
    delay = numbers["delay"]
    side = "late" if delay.value > 0 else "early"
    return f"the torque of {cause.location} was recorded {amount(delay)} too {side}"


def _gain(cause: FoundCause, numbers: Numbers) -> str:
    gain = numbers["gain"]
    shown = Parameter("gain", "%", 100 * gain.value, 100 * gain.stderr)
    side = "large" if gain.value > 0 else "small"
    return f"the recorded torque of {cause.location} is {amount(shown)} too {side}"


def _balance(cause: FoundCause, numbers: Numbers) -> str:
    stiffness = numbers.get("stiffness")
    if stiffness is None:
        return f"a counterweight or spring acts on {cause.location} ({_rms(cause)})"
    if _open(stiffness):
        return f"something pulls {cause.location} to one side ({_rms(cause)})"
    verb = "back to one position" if stiffness.value > 0 else "away from one position"
    return f"a spring pulls {cause.location} {verb}, by {amount(stiffness)}"


def _payload(cause: FoundCause, numbers: Numbers) -> str:
    mass = numbers.get("mass")
    if mass is not None and not _open(mass):
        return f"the arm carries {amount(mass)} {'more' if mass.value > 0 else 'less'} than stated"
    off = _rms(cause) if mass is None else f"its mass {amount(mass, sign=True)}"
    return f"the load sits elsewhere than stated ({off})"


def _body(cause: FoundCause, numbers: Numbers) -> str:
    times = numbers["times"]
    if times.interval[1] < -0.5:
        whole = times.interval[0] <= -1 <= times.interval[1]
        missing = "" if whole else f": {amount(times)} times what it weighs is missing"
        return f"the model's {cause.location} is not on the arm{missing}"
    if times.interval[0] > 0.5:
        return f"the model's {cause.location} is there more than once: {amount(times)} times besides"
    return f"the model's {cause.location} is not as stated: {amount(times, sign=True)} times itself"


def _moment(cause: FoundCause, numbers: Numbers) -> str:
    size = math.hypot(*(parameter.value for parameter in cause.parameters))
    return f"{cause.location} has its centre of mass elsewhere than stated: its first moment is {size:.2g} kg m off"


def _tilt(cause: FoundCause, numbers: Numbers) -> str:
    size = math.hypot(*(parameter.value for parameter in cause.parameters))
    return f"the base is tilted by {math.degrees(size):.2g}° ({1e3 * size:.2g} mrad)"


def _ripple(cause: FoundCause, numbers: Numbers) -> str:
    size = math.hypot(*(numbers[name].value for name in ("sine", "cosine")))
    count = numbers["per_turn"].value
    return f"the torque of {cause.location} ripples {count:.0f} times per turn, by ± {size:.2g} {cause.unit}"


def _unknown(cause: FoundCause, numbers: Numbers) -> str:
    if cause.driver == SCALE:
        return f"the torque of {cause.location} is not in proportion to the model's, by no known law ({_rms(cause)})"
    return f"the torque of {cause.location} follows the {cause.driver} by no known law ({_rms(cause)})"


def _grows(cause: FoundCause, numbers: Numbers) -> str:
    per = amount(numbers["per_load"])
    return f"dry friction of {cause.location} grows with the load, by {per} {cause.unit} per {cause.unit}"


def _stribeck(cause: FoundCause, numbers: Numbers) -> str:
    extra = numbers["stribeck"]
    return f"friction of {cause.location} is {amount(extra)} {'higher' if extra.value > 0 else 'lower'} near rest"


def _as(words: str) -> Callable[[FoundCause, Numbers], str]:
    return lambda cause, numbers: f"{words.format(cause.location)} ({_rms(cause)})"


def _between(words: str) -> Callable[[FoundCause, Numbers], str]:
    def say(cause: FoundCause, numbers: Numbers) -> str:
        joints = " and ".join(sorted(re.findall(r"\d+", cause.location), key=int))
        return f"{words.format(f'joints {joints}')} ({_rms(cause)})"

    return say


def _offset(cause: FoundCause, numbers: Numbers) -> str:
    offset = numbers["offset"]
    side = "high" if offset.value > 0 else "low"
    return f"the recorded torque of {cause.location} reads {amount(offset)} too {side}"


_CLAUSES: dict[str, Callable[[FoundCause, Numbers], str]] = {
    "coulomb_friction": _than_stated("dry friction of {} is", "more", "less"),
    "viscous_friction": _than_stated("viscous friction of {} is", "more", "less"),
    "rotor_inertia": _than_stated("the rotor inertia of {} is", "more", "less"),
    "link_mass": _than_stated("{} is", "heavier", "lighter"),
    "torque_offset": _offset,
    "asymmetric_friction": _asymmetric,
    "stribeck_friction": _stribeck,
    "load_friction": _grows,
    "viscous_curve": _as("friction of {} is not in proportion to speed"),
    "thermal_friction": _as("friction of {} changes with temperature"),
    "coupled_friction": _between("something rubs between {}"),
    "coupled_inertia": _between("something heavy turns between {}"),
    "motor_constant": _gain,
    "torque_delay": _delay,
    "gravity_balance": _balance,
    "torque_ripple": _ripple,
    "cable_torque": _as("cables or hoses pull at {}"),
    "link_first_moment": _moment,
    "link_inertia": _as("the inertia of {} is not as stated"),
    "payload_error": _payload,
    "attached_body": _body,
    "gravity_direction": _tilt,
    "unknown": _unknown,
}


def cure(placed: PlacedCause, parameters: Sequence[Parameter], arm: MovingArm) -> str:
    """What to change, with sign and number where the cause has one number, or few.

    Args:
        placed: the cause at its place.
        parameters: as fitted.
        arm: as stated.

    Returns:
        A sentence or two; the cause's own words where it is a curve or a wave, which model.yaml holds.
    """
    numbers = {parameter.name: parameter for parameter in parameters}
    first, name = parameters[0], placed.cause.name
    plus, minus = amount(first, sign=True), amount(_negative(first), sign=True)
    if name in _STATED:
        return f"{placed.cause.cure.removesuffix('.')}: stated {plus}."
    if name == "asymmetric_friction":
        return f"{placed.cause.cure.removesuffix('.')}: the joint's viscous friction {plus} forward, {minus} backward."
    if name == "motor_constant" and first.value > -1:
        factor = 1 / (1 + first.value)
        return f"Multiply the joint's torque constant, and so the recorded torque, by {factor:.3f}."
    if name == "torque_offset":
        return f"Take the offset, {plus}, from the recorded torque."
    if name == "torque_delay":
        side = "earlier" if first.value > 0 else "later"
        return f"Shift the recorded torque {amount(first)} {side}, or simulate that."
    if name == "load_friction":
        return f"{placed.cause.cure.removesuffix('.')}: {amount(first)} × |torque| × sign of the speed."
    if name == "payload_error":
        told = ", ".join(f"{_SAID.get(key, key)} {amount(value, sign=True)}" for key, value in numbers.items())
        where = " in the last link's frame" if len(numbers) > 1 else ""
        return f"{placed.cause.cure.removesuffix('.')}: as stated and {told}{where}."
    if name == "gravity_direction" and isinstance(placed.columns, Law):
        leans = np.array(placed.columns.numbers).reshape(-1, 3)
        found = arm.model.gravity.linear + np.array([each.value for each in parameters]) @ leans
        return f"Set gravity_m_s2 to [{', '.join(f'{each:.3f}' for each in found)}], or level the base."
    return placed.cause.cure


_STATED = ("coulomb_friction", "viscous_friction", "rotor_inertia", "link_mass")
_SAID = {"mx": "mass × x", "my": "mass × y", "mz": "mass × z"}


def _negative(parameter: Parameter) -> Parameter:
    return Parameter(parameter.name, parameter.unit, -parameter.value, parameter.stderr)
