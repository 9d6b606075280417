"""Laws of torque as data: which function of the samples, of which joints, with which numbers; model.yaml holds them.

A law's columns are torque, N m (N of a sliding joint), per unit of the cause's parameters.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import BSpline

from armscope.core.types import Array
from armscope.motion.causes import Moment, side


@dataclass(frozen=True)
class Law:
    """A function of the samples.

    Attributes:
        kind: one of `LAWS`.
        joints: whose torque it is, from 0.
        numbers: what the function takes after the samples and the joints.
    """

    kind: str
    joints: tuple[int, ...]
    numbers: tuple[float, ...] = ()

    def __call__(self, moment: Moment) -> Array:
        """(N, joints, c) columns at the samples."""
        values = np.asarray(LAWS[self.kind](moment, self.joints, *self.numbers))
        return values if values.ndim == 3 else values.reshape(len(values), 1, -1)


def _speed(m: Moment, joints: tuple[int, ...]) -> Array:
    return m.signals.dq[:, joints[0]]


def _side(m: Moment, joints: tuple[int, ...], width: float) -> Array:
    own = list(joints[:1])
    return side(replace(m.signals, dq=m.signals.dq[:, own], ddq=m.signals.ddq[:, own]), np.array([width]))[:, 0]


def _stribeck(m: Moment, joints: tuple[int, ...], width: float, speed: float) -> Array:
    return np.asarray(_side(m, joints, width) * np.exp(-((_speed(m, joints) / speed) ** 2)))


def _load_side(m: Moment, joints: tuple[int, ...], width: float) -> Array:
    return np.asarray(np.abs(m.rigid[:, joints[0]]) * _side(m, joints, width))


def _powers(m: Moment, joints: tuple[int, ...]) -> Array:
    speed = _speed(m, joints)
    return np.column_stack([speed * np.abs(speed), speed**3])


def warmth(m: Moment, joint: int) -> Array:
    """(N,) deg C of a joint; whoever uses a law of it has made sure that it is recorded."""
    assert m.signals.temperature is not None
    return m.signals.temperature[:, joint]


def _warm_speed(m: Moment, joints: tuple[int, ...], middle: float) -> Array:
    return (warmth(m, joints[0]) - middle) * _speed(m, joints)


def _warm_side(m: Moment, joints: tuple[int, ...], width: float, middle: float) -> Array:
    return (warmth(m, joints[0]) - middle) * _side(m, joints, width)


def _wave(m: Moment, joints: tuple[int, ...], count: float) -> Array:
    turned = count * m.signals.q[:, joints[0]]
    return np.column_stack([np.sin(turned), np.cos(turned)])


DRIVERS: dict[str, Callable[[Moment, int], Array]] = {
    "joint angle": lambda m, j: m.signals.q[:, j],
    "speed": lambda m, j: m.signals.dq[:, j],
    "load": lambda m, j: m.rigid[:, j],
    "time": lambda m, j: m.signals.time,
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
    assert m.gravity is not None
    return np.asarray(m.gravity @ np.array(leans).reshape(-1, 3).T)


LAWS: dict[str, Callable[..., Array]] = {
    "absolute speed": lambda m, joints: np.abs(_speed(m, joints)),
    "stribeck": _stribeck,
    "load friction": _load_side,
    "powers of speed": _powers,
    "warm speed": _warm_speed,
    "warm side": _warm_side,
    "torque": lambda m, joints: m.predicted[:, joints[0]],
    "delayed torque": lambda m, joints: -np.gradient(m.predicted[:, joints[0]], 1 / m.rate),
    "spring": lambda m, joints, middle: m.signals.q[:, joints[0]] - middle,
    "wave": _wave,
    "rubbing of two": _rubbing,
    "inertia of two": _inert,
    "leaning gravity": _lean,
    **{f"curve over {driver}": _curve(driver) for driver in DRIVERS},
}
"""Every law by its name in a model file: a function of the samples, the joints and the law's numbers."""
