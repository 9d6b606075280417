"""A base whose stand gives way under the arm's own moment, and rings.

With the base turned by a small phi about x and y, phi'' + 2 d w phi' + w^2 phi = -w^2 C M: C is how far it turns per
moment at rest, M the moment that the stand must hold, less what it holds in the mean, by which it was levelled. The
joints feel the base's acceleration, its speed beside their own, and that gravity leans in its axes. The arm's inertia
counts as the stand's own: in its mean pose.
"""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.motion.library.causes import Moment
from armscope.robot.on_a_stand import OnAStand

ABOUT = ("about_x", "about_both", "about_y")
"""Compliances of a stand: about x, about each of both by the moment about the other, about y."""


def rocking(m: Moment, joints: tuple[int, ...], *numbers: float) -> Array:
    """Torque of joints on a base that rocks.

    Args:
        m: N samples.
        joints: from 0.
        numbers: moments about x and y in the mean, N m; damping, of the critical one; frequency, Hz.

    Returns:
        (N, joints, 3) N m per rad/(N m) of `ABOUT`.
    """
    assert m.bodies is not None
    *held, damping, hz = numbers
    return rocked(m.bodies.on_a_stand(*m.motion), np.array(held), m.signals.period, (damping, hz))[:, list(joints)]


def rocked(stand: OnAStand, held: Array, period: float, swing: tuple[float, float]) -> Array:
    """The same of all m joints.

    Args:
        stand: what a stand feels and does to the joints, at N samples.
        held: (2,) N m about both in the mean.
        period: s between samples.
        swing: damping, of the critical one; frequency, Hz.

    Returns:
        (N, m, 3).
    """
    ways = (stand.per_turn, stand.per_speed, stand.per_turning)
    swings = swung(held - stand.moment, period, swing)
    felt = sum(way[:, :, :, None] * by[:, None, None, :] for way, by in zip(ways, swings, strict=True))
    assert isinstance(felt, np.ndarray)  # (N, m, axis that turns, axis of the moment)
    return np.stack([felt[:, :, 0, 0], felt[:, :, 0, 1] + felt[:, :, 1, 0], felt[:, :, 1, 1]], axis=2)


def swung(pushed: Array, period: float, swing: tuple[float, float]) -> tuple[Array, Array, Array]:
    """What follows a push as a damped oscillator does that it moves by itself at rest, and its first two derivatives.

    Args:
        pushed: (N, c), at rest with the first of them; a straight line between samples.
        period: s between samples.
        swing: damping, of the critical one; frequency, Hz.

    Returns:
        (N, c) each.
    """
    from scipy.signal import cont2discrete, lfilter, lfilter_zi  # take long to import: most commands need none

    damping, omega = swing[0], 2 * np.pi * swing[1]
    below, found = np.array([1.0, 2 * damping * omega, omega**2]), []
    for above in ([omega**2], [omega**2, 0.0], [omega**2, 0.0, 0.0]):
        b, a, _ = cont2discrete((np.array(above), below), period, method="foh")
        b = np.ravel(b)
        found.append(lfilter(b, a, pushed, axis=0, zi=np.outer(lfilter_zi(b, a), pushed[0]))[0])
    return found[0], found[1], found[2]
