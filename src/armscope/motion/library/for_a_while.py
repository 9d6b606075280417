"""What is there for some of a run only: a load that is picked up or put down, a reading that jumps.

Whatever changes does so at moments, s of the run's own time; at the first of them it comes, unless it was there from
the start, at the next it goes, and so on.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.types import Array
from armscope.motion.library.causes import Moment
from armscope.robot.dynamics import MovingArm, moved_centre

OF_A_LOAD = ("mass", "mx", "my", "mz")
"""Numbers of a load anywhere on the last link, kg and kg m."""
INERTIA = tuple((name, "kg m^2") for name in ("Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz"))
"""Names and units of a body's inertia, in the order of Pinocchio's parameters."""


def there(time: Array, at_first: float, moments: Sequence[float]) -> Array:
    """When it is there.

    Args:
        time: (N,) s.
        at_first: 1 where it is there from the start, else 0.
        moments: s, ascending, at which it comes or goes.

    Returns:
        (N,) 1 where it is there, else 0.
    """
    return np.asarray((at_first + np.searchsorted(np.asarray(moments), time, side="right")) % 2, dtype=np.float64)


def of_a_load(arm: MovingArm, values: Array, stated: float = 0.0) -> Array:
    """Inertial parameters per kg and kg m of a load of such mass and moments, beside one at the tool point.

    Its inertia goes with the square of its place; about its own centre it is taken to have none. Without that, a load
    off the flange was told as a mass at the tool, moments of the last link and an inertia.

    Args:
        arm: the arm as stated.
        values: (4,) `OF_A_LOAD`.
        stated: kg at the tool point, besides.

    Returns:
        (10 n, 4).
    """
    before, found = stated * arm.point_load()[-10:-6], np.zeros((len(arm.inertial), 4))
    found[-10:-6] = np.eye(4)
    at, weight = np.polynomial.legendre.leggauss(8)
    for share, part in zip((at + 1) / 2, weight / 2, strict=True):  # the change is the mean slope, along with the load
        body = np.array([*(before + share * values), *np.zeros(6)])
        slope = moved_centre(body)[4:]
        found[-6:, 1:] += part * slope
        found[-6:, 0] -= part * slope @ body[1:4] / (2 * body[0])
    return found


def load_for_a_while(m: Moment, joints: tuple[int, ...], stated: float, *numbers: float) -> Array:
    """Torque of a load anywhere on the last link, per kg and kg m, while it is there.

    Args:
        m: N samples.
        joints: whose torque, from 0.
        stated: kg at the tool point, besides.
        numbers: (4,) of the load at which its inertia is right; a bit for each of `OF_A_LOAD` that counts; whether it
            is there from the start; when it comes or goes.

    Returns:
        (N, joints, c).
    """
    *values, which, at_first = numbers[:6]
    assert m.bodies is not None
    per_unit = of_a_load(m.bodies.arm, np.array(values), stated)
    counted = [number for number in range(len(OF_A_LOAD)) if int(which) >> number & 1]
    return _carried(m, joints, per_unit[:, counted], there(m.signals.time, at_first, numbers[6:]))


def tool_load_for_a_while(m: Moment, joints: tuple[int, ...], at_first: float, *moments: float) -> Array:
    """Torque per kg at the tool point, while it is there.

    Args:
        m: N samples.
        joints: whose torque, from 0.
        at_first: 1 where it is there from the start, else 0.
        moments: s, at which it comes or goes.

    Returns:
        (N, joints, 1) N m/kg.
    """
    assert m.bodies is not None
    return _carried(m, joints, m.bodies.arm.point_load()[:, None], there(m.signals.time, at_first, moments))


def offset_for_a_while(m: Moment, joints: tuple[int, ...], at_first: float, *moments: float) -> Array:
    """An offset of one while it is there.

    Args:
        m: N samples.
        joints: not looked at: of any joint.
        at_first: 1 where it is there from the start, else 0.
        moments: s, at which it comes or goes.

    Returns:
        (N,).
    """
    return there(m.signals.time, at_first, moments)


def _carried(m: Moment, joints: tuple[int, ...], per_unit: Array, while_there: Array) -> Array:
    assert m.bodies is not None
    found = np.zeros((len(while_there), len(joints), per_unit.shape[1]))
    which = np.flatnonzero(while_there)
    if len(which):
        regressor = m.bodies.arm.regressor(*(each[which] for each in m.motion))
        found[which] = regressor[:, list(joints)] @ per_unit
    return found
