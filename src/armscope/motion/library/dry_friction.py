"""Dry friction over time: how and when it changes sides, now and some milliseconds ago."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from armscope.core.types import Array, Indices
from armscope.motion.library.sides import blunt_width, sharp_width, side
from armscope.motion.samples.constants import FILTER
from armscope.motion.samples.low_pass import without_lag
from armscope.motion.samples.preparation import Signals
from armscope.robot.dynamics import MovingArm


def seen_later(time: Array, path: BSpline, joint: int, delay: float) -> Array:
    """What a joint has as it was some time ago, by a cubic spline.

    A straight line between samples blurs what is between them: of a wave of five samples it loses a fifth half way,
    and friction that changes sides more softly than it does asks for another law near rest.

    Args:
        time: (N,) s, even.
        path: of all joints at these times.
        joint: from 0.
        delay: s.

    Returns:
        (N,) of ``delay`` earlier; before the first sample, and after the last one, as it is.
    """
    own = BSpline.construct_fast(path.t, np.ascontiguousarray(path.c[:, joint]), path.k)
    return np.asarray(own(np.clip(time - delay, time[0], time[-1])))


LATE_BY_ORDER = {1: 1.0, 2: 2.0**0.5}
"""By how much a Butterworth low-pass of an order makes what is slow late, in units of one over its angular cut-off."""


@dataclass(frozen=True, eq=False)
class ChangeOfSides:
    """How dry friction of m joints changes sides."""

    width: Array  # (m,) rad/s (m/s) within which it does
    late: Array  # (m,) s by which it does later than the speed
    order: Indices  # (m,) of a low-pass that makes it so; 0: it is shifted as it is
    blunt: Array  # (m,) rad/s (m/s) up to which width the shape of the change is free

    @classmethod
    def of(
        cls, arm: MovingArm, late: Array | float = 0.0, width: Array | None = None, order: Indices | None = None
    ) -> ChangeOfSides:
        """As sharp as fits take it to be, in time and unfiltered, where nothing else is given.

        Args:
            arm: the arm.
            late, width, order: as they are here.

        Returns:
            It.
        """
        late = np.broadcast_to(np.asarray(late, dtype=float), (arm.n_motors,))
        order = np.zeros(arm.n_motors, dtype=np.intp) if order is None else order
        width = sharp_width(arm) if width is None else width
        return cls(width, late, order, blunt_width(arm, width))

    def wide(self, arm: MovingArm) -> Array | None:
        """(m,) widths; None where all are as sharp as fits take them to be."""
        return self.width if np.any(self.width > sharp_width(arm)) else None

    def sides(self, signals: Signals) -> Array:
        """(N, m) sides of friction, -1 ... 1."""
        known = zip(self.order, self.late, strict=True)
        filtered = np.array([is_shown(int(order), late, signals.period) for order, late in known])
        sides = side(motion_before(signals, np.where(filtered, 0.0, self.late)), self.width)
        for j in np.flatnonzero(filtered):
            sides[:, j] = passed(sides[:, j], int(self.order[j]), float(self.late[j]), 1 / signals.period)
        return sides


def is_shown(order: int, late: float, period: float) -> bool:
    """Whether samples show a low-pass; what is later or sooner otherwise is shifted.

    Args:
        order: of it, 0 for none.
        late: s by which it makes what is slow late.
        period: s, between samples.

    Returns:
        Whether its cut-off lies below where samples end.
    """
    return order > 0 and LATE_BY_ORDER[order] * period < np.pi * FILTER.nyquist * late


def passed(values: Array, order: int, late: float, rate: float) -> Array:
    """Samples behind a causal low-pass (Butterworth), at rest with the first of them.

    Args:
        values: (N,).
        order: 1 or 2.
        late: s by which it makes what is slow late.
        rate: samples per second.

    Returns:
        (N,).
    """
    from scipy.signal import butter, lfilter, lfilter_zi  # take long to import: most commands need none

    b, a = butter(order, LATE_BY_ORDER[order] / late, fs=2 * np.pi * rate)
    return np.asarray(lfilter(b, a, values, zi=lfilter_zi(b, a) * values[0])[0])


@dataclass(frozen=True, eq=False)
class DryFriction:
    """Of m joints: its torque (m,), N m (N), and how it changes sides."""

    torque: Array
    turning: ChangeOfSides

    def of_joint(self, signals: Signals, joint: int) -> Array:
        """(N,) N m (N) of a joint."""
        return np.asarray(self.torque[joint] * self.turning.sides(signals)[:, joint])

    def without(self, signals: Signals, torque: Array) -> Array:
        """(N, m) torques without their dry friction: what is smooth of them.

        Args:
            signals: N samples.
            torque: (N, m) with dry friction.

        Returns:
            Torque, N m (N).
        """
        return np.asarray(torque - self.torque * self.turning.sides(signals))

    def rounded(self, signals: Signals, torque: Array, delay: Array, cutoff: float) -> Array:
        """(N, m) second derivative of torques, N m/s^2: what drives' filters and rounding take part of.

        Not of dry friction: over which way it changes sides is each joint's own. Presliding of all joints would be
        taken for a filter of their drives, and a soft drive was named that took it back from the torque of the masses.
        Nor of what is faster than the motion: noise of the positions is noise of this, and by some of it, taken off
        again, any model would fit better.

        Args:
            signals: N samples.
            torque: (N, m) in time with the motion.
            delay: (m,) s by which each is recorded late: so is what a filter takes of it.
            cutoff: Hz, where the motion ends.

        Returns:
            It.
        """
        rate, late = 1 / signals.period, np.flatnonzero(delay)
        smooth = without_lag(self.without(signals, torque), cutoff, rate, int(np.ceil(rate / cutoff)))
        if len(late):
            path = make_interp_spline(signals.time, smooth, k=3)
            for j in map(int, late):
                smooth[:, j] = seen_later(signals.time, path, j, delay[j])
        return np.asarray(np.gradient(np.gradient(smooth, 1 / rate, axis=0), 1 / rate, axis=0))


def motion_before(signals: Signals, ago: Array) -> Signals:
    """Samples with velocities and accelerations of some time ago, (m,) s.

    Friction that was seen later changes sides between samples where that motion did: a straight line, or a spline,
    between sides that are already means over samples blurs the moment.
    """
    late = np.flatnonzero(ago)
    if not len(late):
        return signals
    dq, ddq = signals.dq.copy(), signals.ddq.copy()
    for j in map(int, late):
        dq[:, j], ddq[:, j] = signals.some_time_ago(j, ago[j])
    return replace(signals, dq=dq, ddq=ddq)


def own_columns(signals: Signals, turning: ChangeOfSides) -> Array:
    """(N, m, 7) what every joint has, per unit of each: `layout.OWN_NAMES`."""
    turned = turning.sides(signals)
    blunter = replace(turning, width=turning.blunt).sides(signals) - turned
    slope = np.gradient(turned, signals.period, axis=0)
    rounder = np.gradient(slope, signals.period, axis=0)
    return np.stack([np.ones_like(signals.q), turned, signals.dq, signals.ddq, blunter, rounder, -slope], axis=2)


def rounded_off(sides: Array, over: Array, period: float) -> Array:
    """(N, m) sides that each joint's friction changes over some time, (m,) s: as a standard deviation, normal.

    Args:
        sides: (N, m), sharp.
        over: (m,) s; 0 leaves them sharp.
        period: between samples, s.

    Returns:
        The sides.
    """
    from scipy.ndimage import gaussian_filter1d  # takes long to import

    found = sides.copy()
    for j in np.flatnonzero(over):
        found[:, j] = gaussian_filter1d(sides[:, j], over[j] / period, mode="nearest")
    return found
