"""Laws of torque as data: which function of the samples, of which joints, with which numbers; model.yaml holds them.

A law's columns are torque, N m (N of a sliding joint), per unit of the cause's parameters.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from armscope.core.types import Array
from armscope.motion.constants import LIBRARY
from armscope.motion.library.causes import Moment
from armscope.motion.library.clinging import smooth_torque, taken_along
from armscope.motion.library.for_a_while import load_for_a_while, offset_for_a_while, tool_load_for_a_while
from armscope.motion.library.linkage import spring_between_links
from armscope.motion.library.power_law import nearest_ordinary, power_of_speed
from armscope.motion.library.read_late import delayed
from armscope.motion.library.rocking import rocking
from armscope.motion.library.sides import side
from armscope.motion.library.warmth import RUNNING, warm, warmth, while_running
from armscope.motion.library.waves import wave
from armscope.motion.samples.low_pass import without_lag


@dataclass(frozen=True)
class Law:
    """A function of the samples."""

    kind: str  # one of `LAWS`
    joints: tuple[int, ...]  # whose torque it is, from 0
    numbers: tuple[float, ...] = ()  # what the function takes after the samples and the joints

    def __call__(self, moment: Moment) -> Array:
        """(N, joints, c) columns at the samples."""
        values = np.asarray(LAWS[self.kind](moment, self.joints, *self.numbers))
        return values if values.ndim == 3 else values.reshape(len(values), 1, -1)


def _speed(m: Moment, joints: tuple[int, ...]) -> Array:
    return m.signals.dq[:, joints[0]]


def _side(m: Moment, joints: tuple[int, ...], width: float) -> Array:
    own = list(joints[:1])
    return side(replace(m.signals, dq=m.signals.dq[:, own], ddq=m.signals.ddq[:, own]), np.array([width]))[:, 0]


def _stribeck(m: Moment, joints: tuple[int, ...], width: float, *fall: float) -> Array:
    """The law, and its change with the logarithm of its speed: a scanned speed is never quite the true one.

    The fall is a speed, of Gauss' bell, or an exponent before it: both forms are in use, exp(-|v/w|^2) and exp(-|v/w|)
    (Armstrong-Helouvry, Dupont, Canudas de Wit 1994), and a bell that is fitted to the other is half as high.
    """
    *exponents, speed = fall
    exponent = exponents[0] if exponents else LIBRARY.falls[0]
    share = np.abs(_speed(m, joints) / speed) ** exponent
    fallen = _side(m, joints, width) * np.exp(-share)
    return np.column_stack([fallen, exponent * share * fallen])


def _load_side(m: Moment, joints: tuple[int, ...], width: float) -> Array:
    return np.asarray(np.abs(m.rigid[:, joints[0]]) * _side(m, joints, width))


def _power(
    m: Moment, joints: tuple[int, ...], width: float, power: float, viscous: float, dry: float, *speeds: float
) -> Array:
    """A power of the speed, less the viscous and dry friction that are nearest to it.

    So dry and viscous friction that are fitted stay what a fit without the curve would say. Where viscous friction is
    stated, what it is off is a second column: a curve is another one than the straight line that was stated.
    """
    speed, turned = _speed(m, joints), _side(m, joints, width)
    nearest = nearest_ordinary(width, power, viscous, dry, *speeds)
    bent = turned * power_of_speed(speed, width, power) - np.column_stack([speed, turned]) @ nearest
    return bent if viscous else np.column_stack([bent, speed])


def _over_time(of: Callable[..., Array], changes: Callable[..., Array]) -> Callable[..., Array]:
    """Friction of one kind that changes with the temperature, or while the arm runs."""

    def columns(m: Moment, joints: tuple[int, ...], *numbers: float) -> Array:
        own, others = (numbers[:1], numbers[1:]) if of is _side else ((), numbers)
        return changes(m, joints[0], of(m, joints, *own), *others)

    return columns


def _spring(m: Moment, joints: tuple[int, ...], middle: float) -> Array:
    """Its stiffness, and its pull in the middle of the range: where it rests is not known."""
    turned = m.signals.q[:, joints[0]] - middle
    return np.column_stack([turned, np.ones_like(turned)])


def _clinging_over_torques(m: Moment, joints: tuple[int, ...], cutoff: float, *widths: float) -> Array:
    return taken_along(smooth_torque(m, joints[0], cutoff), widths)


def _powers_of_torque(m: Moment, joints: tuple[int, ...], usual: float) -> Array:
    torque = (m.predicted if m.bare is None else m.bare)[:, joints[0]]
    return np.column_stack([_read(m, joints), higher_powers(torque, usual)])


def higher_powers(torque: Array, usual: float) -> Array:
    """(N, 2) square and cube of a torque (N,), with its sign, in units of the usual one."""
    share = torque / usual
    return np.column_stack([torque * np.abs(share), torque * share**2])


def _read(m: Moment, joints: tuple[int, ...]) -> Array:
    """What a gain is of."""
    return (m.predicted if m.read is None else m.read)[:, joints[0]]


def _behind(m: Moment, joints: tuple[int, ...], cutoff: float, compliance: float = 0.0) -> Array:
    """What a drive changes that gives way under its link's torque, per unit of compliance, in all joints' torques.

    The link is where its motor is, less compliance x torque of the links there (Spong 1987): exactly to second order
    at the compliance given, along the slope for none. That torque is low-passed where the motion ends, for it holds two
    derivatives of the position, and is derived twice; or, where that is lower, where the link swings on its drive:
    beyond, it does not follow its motor, and each step towards it would only make noise of the positions larger.
    """
    at, every = joints[0], list(joints)
    if compliance == 0:
        by_motion = zip(m.slopes, derived(m, m.rigid[:, at], cutoff), strict=True)
        return np.asarray(-sum(slope[:, every, at] * lag[:, None] for slope, lag in by_motion))[:, :, None]
    assert m.bodies is not None
    torque, cutoff = m.rigid, min(cutoff, _swing_hz(m, at, compliance))
    for _ in range(2):
        behind = [values.copy() for values in m.motion]
        for values, lag in zip(behind, derived(m, torque[:, at], cutoff), strict=True):
            values[:, at] -= compliance * lag
        torque = m.bodies.torques(*behind)
    return np.asarray((torque - m.bodies.torques(*m.motion))[:, every, None] / compliance)


def _swing_hz(m: Moment, joint: int, compliance: float) -> float:
    """At which frequency a link swings on its drive, motor held, in its heaviest pose."""
    assert m.bodies is not None
    few = slice(None, None, max(len(m.rigid) // LIBRARY.swing_poses, 1))
    q = m.motion[0][few]
    still, turning = np.zeros_like(q), np.zeros_like(q)
    turning[:, joint] = 1.0
    bodies = m.bodies.among(few)
    inertia = (bodies.torques(q, still, turning) - bodies.torques(q, still, still))[:, joint]
    return float(1 / (2 * np.pi * np.sqrt(max(abs(compliance) * float(inertia.max()), 1e-300))))


def derived(m: Moment, torque: Array, cutoff: float) -> tuple[Array, Array, Array]:
    """A torque, or what follows one, through a low-pass without lag, with its first two derivatives.

    Args:
        m: N samples.
        torque: (N,) of them.
        cutoff: Hz.

    Returns:
        (N,) each.
    """
    smooth, time = without_lag(torque, cutoff, m.rate, int(np.ceil(m.rate / cutoff))), m.signals.time
    path = make_interp_spline(time, smooth, k=5)
    return smooth, path.derivative(1)(time), path.derivative(2)(time)


def _wave(m: Moment, joints: tuple[int, ...], count: float) -> Array:
    return wave(m.signals, joints[0], count)


def _uneven_side(m: Moment, joints: tuple[int, ...], width: float) -> Array:
    """Dry friction that goes up and down once per turn."""
    return _side(m, joints, width)[:, None] * _wave(m, joints, 1)


CLINGING = ("clinging over torques", "clinging over smooth torques")
FOLLOWS_MODEL = frozenset({"load friction", "powers of torque", "delayed torque", "leaning gravity", *CLINGING})
"""Laws of what the model says so far; the others depend on the motion, or on what is stated, alone."""
OF_A_GAIN = ("torque", "powers of torque")
"""Laws that scale a joint's torque, by one more than their first number."""


def is_of_a_gain(columns: object) -> bool:
    """Whether columns are of the torque as it is recorded; all others are true torque."""
    return isinstance(columns, Law) and columns.kind in OF_A_GAIN


def follows_motion(columns: object, joints: tuple[int, ...]) -> bool:
    """Whether columns are a law of one joint's own motion, which nothing of the model changes."""
    of_motion = isinstance(columns, Law) and columns.kind not in FOLLOWS_MODEL and not is_of_a_gain(columns)
    return of_motion and len(joints) == 1


DRIVERS: dict[str, Callable[[Moment, int], Array]] = {
    "joint angle": lambda m, j: m.signals.q[:, j],
    "speed": lambda m, j: m.signals.dq[:, j],
    "load": lambda m, j: m.load[:, j],
    "time": lambda m, j: m.signals.time - m.signals.began,
    "temperature": warmth,
}
"""What a free curve may follow."""


def _curve(driver: str) -> Callable[..., Array]:
    """A cubic spline with evenly spaced knots; beyond its limits it goes on as it was there."""

    def columns(m: Moment, joints: tuple[int, ...], low: float, high: float, count: float) -> Array:
        knots = np.r_[[low] * 3, np.linspace(low, high, int(count) - 2), [high] * 3]
        values = np.clip(DRIVERS[driver](m, joints[0]), low, high)
        return np.asarray(BSpline.design_matrix(values, knots, 3).toarray())

    return columns


def _rubbing(m: Moment, joints: tuple[int, ...], sign: float, width: float) -> Array:
    j, k = joints
    speed, turning = (values[:, j] + sign * values[:, k] for values in (m.signals.dq, m.signals.ddq))
    turned = side(replace(m.signals, dq=speed[:, None], ddq=turning[:, None]), np.array([width]))
    both = np.column_stack([turned, speed])
    return np.stack([both, sign * both], axis=1)


def _inert(m: Moment, joints: tuple[int, ...], sign: float) -> Array:
    j, k = joints
    acceleration = m.signals.ddq[:, j] + sign * m.signals.ddq[:, k]
    return np.stack([acceleration, sign * acceleration], axis=1)[:, :, None]


def _lean(m: Moment, joints: tuple[int, ...], *leans: float) -> Array:
    """What is carried leans along, and beside masses that are off, a lean is off as they are."""
    assert m.bodies is not None
    return np.stack([m.bodies.held(m.motion[0], way) for way in np.array(leans).reshape(-1, 3)], axis=2)


def _wound_up(m: Moment, joints: tuple[int, ...]) -> Array:
    """A link lags behind the motor that drives it, in proportion to the torque between them."""
    return -m.rigid[:, joints[0]]


def _played(m: Moment, joints: tuple[int, ...], width: float) -> Array:
    """A link lies at one end of its play or at the other, as torque pushes it; within a width of torque it changes."""
    return np.asarray(-np.tanh(m.rigid[:, joints[0]] / width))


OF_TWIST: dict[str, Callable[..., Array]] = {
    "constant": lambda m, joints: np.ones(len(m.rigid)),
    "wound up": _wound_up,
    "at either end": _played,
    "share of the turn": lambda m, joints, middle: m.signals.q[:, joints[0]] - middle,
    "read later": lambda m, joints: -m.signals.dq[:, joints[0]],
}
"""Laws of where a link lies beside its motor: columns are rad (m of a sliding joint)."""
LAWS: dict[str, Callable[..., Array]] = {
    **OF_TWIST,
    "absolute speed": lambda m, joints: np.abs(_speed(m, joints)),
    "stribeck": _stribeck,
    "load friction": _load_side,
    "power of speed": _power,
    "warm speed": _over_time(_speed, warm),
    "warm side": _over_time(_side, warm),
    RUNNING[0]: _over_time(_speed, while_running),
    RUNNING[1]: _over_time(_side, while_running),
    "torque": _read,
    "delayed torque": delayed,
    "powers of torque": _powers_of_torque,
    "clinging over ways": lambda m, joints, *ways: taken_along(m.signals.q[:, joints[0]], ways),
    "clinging over torques": lambda m, joints, *widths: taken_along(m.predicted[:, joints[0]], widths),
    "clinging over smooth torques": _clinging_over_torques,
    "behind a drive": _behind,
    "spring": _spring,
    "spring between links": spring_between_links,
    "wave": _wave,
    "uneven friction": _uneven_side,
    "rubbing of two": _rubbing,
    "inertia of two": _inert,
    "leaning gravity": _lean,
    "rocking base": rocking,
    "load for a while": load_for_a_while,
    "tool load for a while": tool_load_for_a_while,
    "offset for a while": offset_for_a_while,
    **{f"curve over {driver}": _curve(driver) for driver in DRIVERS},
}
"""Every law by its name in a model file: a function of the samples, the joints and the law's numbers."""
