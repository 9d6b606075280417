"""Causes of a moving arm as clauses of a sentence: who does what, by how much.

Whose clause it is, `armscope.motion.library.catalogue` says.

Signs: torque is the motor's, positive along the motion that it drives; a parameter is what the recorded torque has
beyond the stated model.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from armscope.core.words import rounded, shown_unit, size_of
from armscope.motion.verdict import FoundCause
from armscope.verdict.effects import INTERVAL, Parameter
from armscope.verdict.wording import decimals_for

Numbers = dict[str, Parameter]
Clause = Callable[[FoundCause, Numbers], str]
SCALE = "torque"
"""What a sensor that bends follows."""
ALL_JOINTS = "all joints"
"""Where something is that all joints have in common, by one number: the clock or the filter of what reads torques."""


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


def rms_of(cause: FoundCause) -> str:
    """Its size, as the joint where it is largest has it: of a torque, or of a link's place beside its motor."""
    if cause.unit in ("rad", "m"):
        return f"{size_of(cause.rms, cause.unit)} RMS"
    return f"{rounded(cause.rms)} {cause.unit} RMS"


def holds_zero(parameter: Parameter) -> bool:
    """Whether a parameter's sign is open."""
    low, high = parameter.interval
    return low <= 0 <= high


def than_stated(what: str, more: str, less: str) -> Clause:
    """More or less of something than stated.

    Args:
        what: the subject and its verb, with {} for the place.
        more: said of a positive number.
        less: said of a negative one.

    Returns:
        The clause's function.
    """

    def say(cause: FoundCause, numbers: Numbers) -> str:
        (parameter,) = cause.parameters[:1]
        return f"{what.format(cause.location)} {amount(parameter)} {more if parameter.value > 0 else less} than stated"

    return say


def at_place(words: str) -> Clause:
    """Words with {} for the place, and the size of the torque."""
    return lambda cause, numbers: f"{words.format(cause.location)} ({rms_of(cause)})"


def warming_clause(cause: FoundCause, numbers: Numbers) -> str:
    """Friction that changes as gears warm up, by a temperature or unrecorded."""
    slope, when = cause.parameters[0], "with temperature" if cause.driver == "temperature" else "while the arm runs"
    which, way = "dry" if slope.name.startswith("dry") else "viscous", "falls" if slope.value < 0 else "grows"
    return f"{which} friction of {cause.location} {way} {when} ({rms_of(cause)})"


def between_joints(words: str) -> Clause:
    """Words with {} for two joints, and the size of the torque."""

    def say(cause: FoundCause, numbers: Numbers) -> str:
        joints = " and ".join(sorted(re.findall(r"\d+", cause.location), key=int))
        return f"{words.format(f'joints {joints}')} ({rms_of(cause)})"

    return say


def asymmetric_clause(cause: FoundCause, numbers: Numbers) -> str:
    """Friction that differs by direction."""
    difference = numbers["viscous_difference"]
    forward, backward = ("higher", "lower") if difference.value > 0 else ("lower", "higher")
    size = amount(difference)
    told = f"viscous friction of {cause.location} is {size} {forward} forward than its mean"
    return f"{told}, as much {backward} backward"


def power_clause(cause: FoundCause, numbers: Numbers) -> str:
    """Friction that grows with a power of the speed."""
    power = f"as its speed to the power of {numbers['power'].value:.2g}"
    return f"friction of {cause.location} grows {power}, not in proportion to it ({rms_of(cause)})"


def delay_clause(cause: FoundCause, numbers: Numbers) -> str:
    """Torque recorded late, or early."""
    delay = numbers["delay"]
    side = "late" if delay.value > 0 else "early"
    read = f"the torque of {cause.location} was recorded {amount(delay)} too {side}"
    return f"{read}: one clock or one filter" if cause.location == ALL_JOINTS else read


def open_delay_clause(cause: FoundCause, numbers: Numbers) -> str:
    """What a delay is whose sign or size is open: all that it moves is when friction changes sides."""
    farthest = max(map(abs, numbers["delay"].interval))
    if cause.location == ALL_JOINTS:
        return (
            "where joints reverse, friction does not change sides as the model's does, or all torques are recorded up "
            f"to {rounded(1e3 * farthest)} ms early or late: this motion does not tell which"
        )
    return (
        f"where {cause.location} reverses, its friction does not change sides as the model's does, or its torque is "
        f"recorded up to {rounded(1e3 * farthest)} ms early or late: this motion does not tell which"
    )


def compliance_clause(cause: FoundCause, numbers: Numbers) -> str:
    """A drive that gives way."""
    return f"the drive of {cause.location} gives way under its link's torque, by {amount(numbers['compliance'])}"


def balance_clause(cause: FoundCause, numbers: Numbers) -> str:
    """A spring or a counterweight, as far as its stiffness is known."""
    stiffness = numbers.get("stiffness")
    if "force_lever" in numbers:
        return f"a gas spring or balancer between two links acts on {cause.location} ({rms_of(cause)})"
    if stiffness is None:
        return f"a counterweight or spring acts on {cause.location} ({rms_of(cause)})"
    if holds_zero(stiffness):
        return f"something pulls {cause.location} to one side ({rms_of(cause)})"
    verb = "back to one position" if stiffness.value > 0 else "away from one position"
    return f"a spring pulls {cause.location} {verb}, by {amount(stiffness)}"


def payload_clause(cause: FoundCause, numbers: Numbers) -> str:
    """A load that is heavier or lighter than stated, or sits elsewhere."""
    mass = numbers.get("mass")
    if mass is not None and not holds_zero(mass):
        placed = any(name.startswith("m") and name != "mass" for name in numbers)
        where = "" if placed else ", taken to sit at the tool point"
        return f"the arm carries {amount(mass)} {'more' if mass.value > 0 else 'less'} than stated{where}"
    off = rms_of(cause) if mass is None else f"its mass as stated {amount(mass).partition(' ')[2]}"
    return f"the load sits elsewhere than stated ({off})"


def body_clause(cause: FoundCause, numbers: Numbers) -> str:
    """A body of the model that is missing, or there more than once."""
    times = numbers["times"]
    if times.interval[1] < -0.5:
        whole = times.interval[0] <= -1 <= times.interval[1]
        missing = "" if whole else f": {amount(times)} times what it weighs is missing"
        return f"the model's {cause.location} is not on the arm{missing}"
    if times.interval[0] > 0.5:
        return f"the model's {cause.location} is there more than once: {amount(times)} times besides"
    return f"the model's {cause.location} is not as stated: {amount(times, sign=True)} times itself"


def moment_clause(cause: FoundCause, numbers: Numbers) -> str:
    """A centre of mass that lies elsewhere."""
    size = rounded(math.hypot(*(parameter.value for parameter in cause.parameters)))
    return f"{cause.location} has its centre of mass elsewhere than stated: its first moment is {size} kg m off"


def tilt_clause(cause: FoundCause, numbers: Numbers) -> str:
    """A base that is tilted."""
    size = math.hypot(*(parameter.value for parameter in cause.parameters))
    return f"the base is tilted by {rounded(math.degrees(size))}° ({rounded(1e3 * size)} mrad)"


def ripple_clause(cause: FoundCause, numbers: Numbers) -> str:
    """Waves of torque."""
    size = math.hypot(*(numbers[name].value for name in ("sine", "cosine")))
    count = numbers["per_turn"].value
    return f"the torque of {cause.location} ripples {count:.0f} times per turn, by ± {rounded(size)} {cause.unit}"


def nameless_clause(cause: FoundCause, numbers: Numbers) -> str:
    """What follows something by no known law."""
    if cause.driver == SCALE:
        return f"the torque of {cause.location} is not in proportion to the model's, by no known law ({rms_of(cause)})"
    return f"the torque of {cause.location} follows the {cause.driver} by no known law ({rms_of(cause)})"


def grows_clause(cause: FoundCause, numbers: Numbers) -> str:
    """Friction that grows with the load."""
    per = amount(numbers["per_load"])
    return f"dry friction of {cause.location} grows with the load, by {per} {cause.unit} per {cause.unit}"


def stribeck_clause(cause: FoundCause, numbers: Numbers) -> str:
    """Friction near rest."""
    extra, wider = numbers["stribeck"], numbers["wider"]
    later = math.exp(-2) * (extra.value + 2 * wider.value)  # where a bell as wide has gone
    if later * extra.value > extra.value**2 or abs(extra.value) < INTERVAL * extra.stderr:
        return f"friction of {cause.location} near rest is not what it is farther from it ({rms_of(cause)})"
    return f"friction of {cause.location} is {amount(extra)} {'higher' if extra.value > 0 else 'lower'} near rest"


def offset_clause(cause: FoundCause, numbers: Numbers) -> str:
    """A reading that is off."""
    offset = numbers["offset"]
    side = "high" if offset.value > 0 else "low"
    return f"the recorded torque of {cause.location} reads {amount(offset)} too {side}"


def elasticity_clause(cause: FoundCause, numbers: Numbers) -> str:
    """A drive that winds up between two encoders."""
    return f"the drive of {cause.location} winds up under its torque, with {amount(numbers['stiffness'])}"


def play_clause(cause: FoundCause, numbers: Numbers) -> str:
    """A link that lies at either end of a play."""
    return f"the drive of {cause.location} has play: its link lies {amount(numbers['half'])} to either side"


def ratio_clause(cause: FoundCause, numbers: Numbers) -> str:
    """A reduction that is off."""
    share = numbers["share"]
    shown = Parameter("share", "%", 100 * share.value, 100 * share.stderr)
    return f"the link of {cause.location} turns {amount(shown)} {'more' if share.value > 0 else 'less'} than its motor"


def wave_clause(cause: FoundCause, numbers: Numbers) -> str:
    """An error that comes back every turn."""
    size = size_of(math.hypot(*(numbers[name].value for name in ("sine", "cosine"))), cause.unit)
    often = {1: "once", 2: "twice"}.get(round(numbers["per_turn"].value), "several times")
    return f"link and motor of {cause.location} differ by a wave that comes {often} per turn, by ± {size}"


def lag_clause(cause: FoundCause, numbers: Numbers) -> str:
    """Encoders that are read at different times."""
    lag = numbers["lag"]
    side = "late" if lag.value > 0 else "early"
    return f"the link of {cause.location} was recorded {amount(lag)} too {side} beside its motor"


def nameless_twist(cause: FoundCause, numbers: Numbers) -> str:
    """A link that lies elsewhere by no known law."""
    return f"the link of {cause.location} lies beside its motor as the {cause.driver} says ({rms_of(cause)})"


def run_in_words(name: str) -> str:
    """A run in a sentence, where many call theirs "run 1", others "Run 1" or "1".

    Args:
        name: as the table has it.

    Returns:
        It, after the word "run".
    """
    return f"run {name[4:] if name.lower().startswith('run ') else name}"
