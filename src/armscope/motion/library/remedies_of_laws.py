"""Cures that add a law to the model, written out with all its numbers.

A spring's rest, a gear's middle temperature, and the sign between two joints are numbers of the law, not of the fit:
the numbers on a card alone do not say what to add. What is added is torque of the motor, positive along the motion that
it drives; speeds, angles and accelerations are the joint's, SI.
"""

from __future__ import annotations

from collections.abc import Sequence

from armscope.motion.constants import LIBRARY
from armscope.motion.library.clauses import amount
from armscope.motion.library.linkage import length
from armscope.motion.library.power_law import nearest_ordinary
from armscope.motion.library.remedies import Fitted
from armscope.verdict.effects import INTERVAL, Parameter


def near_rest(fitted: Fitted) -> str:
    """Friction that falls from its value near rest, and how else it falls where the law alone is not enough."""
    extra, wider, speed = (fitted.numbers[name] for name in ("stribeck", "wider", "speed"))
    exponent = fitted.of_law[1] if len(fitted.of_law) > 2 else LIBRARY.falls[0]
    width = f"({speed.value:.4g} {speed.unit})"
    share = f"(speed / {width})²" if exponent == LIBRARY.falls[0] else f"|speed| / {width}"
    if abs(wider.value) > INTERVAL * wider.stderr:
        both = f"({amount(extra, sign=True)} {amount(wider, sign=True)} × {exponent:g} x) × exp(-x) × sign of the speed"
        return f"Add a term to the friction model: {both}, where x is {share}."
    falls = f"exp(-{share})"
    return f"Add a Stribeck term to the friction model: {amount(extra, sign=True)} × {falls} × sign of the speed."


def curve_of_speed(fitted: Fitted) -> str:
    """A power of the speed, less the ordinary friction that is nearest to it: the joint's line has that."""
    bent, power = fitted.numbers["bent"], fitted.numbers["power"].value
    off = fitted.numbers["viscous"].value if "viscous" in fitted.numbers else 0.0
    viscous, dry = -bent.value * nearest_ordinary(*fitted.of_law)
    grown = f"{_plain(bent.value)} × |speed|^{power:.4g} × sign of the speed"
    terms = ((viscous + off, "speed"), (dry, "sign of the speed"))
    told = " ".join([grown, *(f"{_plain(size)} × {what}" for size, what in terms if size)])
    return f"{fitted.in_general}: beside its dry and viscous friction {told}, in {bent.unit.partition(' s')[0]}, SI."


WARM_IS_NOT_AS_STATED = "To warm the arm up first helps only with friction that was fitted as warm."


def with_warmth(fitted: Fitted) -> str:
    """Friction that follows the temperature, or the time that the arm has run, from the middle of what was recorded."""
    slope, *constant = fitted.parameters
    dry = slope.name.startswith("dry")
    middle = fitted.of_law[1 if dry else 0]
    running = slope.name.endswith("minute")
    since = f"(minutes of running − {middle:.3g})" if running else f"(temperature − {middle:.4g} °C)"
    told = " ".join([f"{amount(slope, sign=True)} × {since}", *_signed(constant)])
    counted = " Minutes are counted over the runs as they stand in the table, without pauses between them." * running
    what, follows = ("dry", "sign of the speed") if dry else ("viscous", "speed")
    known = "stated" if constant else "fitted"
    law = f"{what} friction as {known} and {told}, times the {follows}"
    return f"{fitted.in_general}: {law}. {WARM_IS_NOT_AS_STATED}{counted}"


def rubbing(fitted: Fitted) -> str:
    """Friction between two joints."""
    dry, viscous = fitted.parameters
    law = f"{amount(dry, sign=True)} × sign of s {amount(viscous, sign=True)} × s"
    return f"Let the friction of both joints follow s, {_between(fitted, 'speed')}, too: {_acting(fitted, law)}."


def turning_along(fitted: Fitted) -> str:
    """Inertia between two joints."""
    law = f"{amount(fitted.first, sign=True)} × a"
    told = _acting(fitted, f"{law}, where a is {_between(fitted, 'acceleration')}")
    return f"{fitted.in_general}; or add inertia between them: {told}."


def _between(fitted: Fitted, of: str) -> str:
    """The sum or the difference that a law of two neighbours follows."""
    second, first = fitted.place.split(" from ")
    return f"the {of} of {first} {'plus' if fitted.of_law[0] > 0 else 'less'} that of {second}"


def _acting(fitted: Fitted, law: str) -> str:
    second, first = fitted.place.split(" from ")
    there = "as much" if fitted.of_law[0] > 0 else "as much the other way"
    return f"torque at {first}, and {there} at {second}, by {law}"


def spring(fitted: Fitted) -> str:
    """A spring, by the middle of the joint's range, or a counterweight."""
    if "force_lever" in fitted.numbers:
        return _between_links(fitted)
    if "stiffness" not in fitted.numbers:
        return waves(fitted)
    stiffness, torque = fitted.parameters
    (middle,) = fitted.of_law
    unit = stiffness.unit.rpartition("/")[2]
    away = f"(position {'+' if middle < 0 else '−'} {abs(middle):.4g} {unit})"
    return f"{fitted.in_general}: {amount(stiffness, sign=True)} × {away} {amount(torque, sign=True)}."


def _between_links(fitted: Fitted) -> str:
    """A spring between a point of one link and a point of the next, by the angle between these."""
    phase, ratio, middle = fitted.of_law
    force, growth = fitted.parameters[:2]
    half = float(length(middle + phase, ratio))
    size = f"({amount(force, sign=True)} {amount(growth, sign=True)} × (l − {half:.4g}))"
    return (
        f"{fitted.in_general}: {size} × sin(x) / l, "
        f"where x is position {'−' if phase < 0 else '+'} {abs(phase):.4g} rad, and l = "
        f"√({1 + ratio**2:.4g} − {2 * ratio:.4g} cos x)."
    )


def waves(fitted: Fitted) -> str:
    """Torque that repeats over the turn."""
    (count,) = fitted.of_law
    turned = "angle" if count == 1 else f"{count:.0f} × angle"
    sine, cosine = (amount(fitted.numbers[name], sign=True) for name in ("sine", "cosine"))
    return f"{fitted.in_general}: {sine} × sin({turned}) {cosine} × cos({turned})."


def _signed(parameters: Sequence[Parameter]) -> list[str]:
    return [amount(each, sign=True) for each in parameters]


def _plain(value: float) -> str:
    """Four digits with a sign: what is made of several numbers has no interval of its own."""
    return f"{'−' if value < 0 else '+'}{abs(value):.4g}"
