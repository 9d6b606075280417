"""Dry friction over time: how and when it changes sides, now and some milliseconds ago."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from armscope.core.types import Array
from armscope.motion.library.sides import sharp_width, side
from armscope.motion.samples.preparation import Signals, without_lag
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


@dataclass(frozen=True, eq=False)
class DryFriction:
    """Of m joints.

    Attributes:
        torque: (m,) N m (N).
        width: (m,) rad/s (m/s) within which it changes sides.
        turning: (m,) s by which it changes sides later than the speed.
    """

    torque: Array
    width: Array
    turning: Array

    @classmethod
    def of(cls, arm: MovingArm, torque: Array, turning: Array | float = 0.0, width: Array | None = None) -> DryFriction:
        """As sharp as fits take it to be, or within a width.

        Args:
            arm: the arm.
            torque: (m,) N m (N).
            turning: (m,) s by which it changes sides later than the speed.
            width: (m,) rad/s (m/s) within which it changes sides.

        Returns:
            It.
        """
        width = sharp_width(arm) if width is None else width
        return cls(torque, width, np.broadcast_to(np.asarray(turning, dtype=float), torque.shape))

    def side(self, signals: Signals, joint: int) -> Array:
        """(N,) side of a joint's friction, -1 ... 1."""
        before = motion_before(signals, self.turning)
        own = replace(before, dq=before.dq[:, [joint]], ddq=before.ddq[:, [joint]])
        return side(own, self.width[[joint]])[:, 0]

    def without(self, signals: Signals, torque: Array) -> Array:
        """(N, m) torques without their dry friction: what is smooth of them.

        Args:
            signals: N samples.
            torque: (N, m) with dry friction.

        Returns:
            Torque, N m (N).
        """
        return np.asarray(torque - self.torque * side(motion_before(signals, self.turning), self.width))

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


def own_columns(arm: MovingArm, signals: Signals, turning: Array | float = 0.0, width: Array | None = None) -> Array:
    """What every joint has, per unit of each.

    Args:
        arm: the arm.
        signals: N samples.
        turning: (m,) s by which friction changes sides later than the speed.
        width: (m,) rad/s (m/s) within which it changes sides; as sharp as fits take it to be where not given.

    Returns:
        (N, m, 6) of `layout.OWN_NAMES`.
    """
    width = sharp_width(arm) if width is None else width
    turned = side(motion_before(signals, np.broadcast_to(np.asarray(turning, dtype=float), (arm.n_motors,))), width)
    slope = np.gradient(turned, signals.period, axis=0)
    rounder = np.gradient(slope, signals.period, axis=0)
    return np.stack([np.ones_like(signals.q), turned, signals.dq, signals.ddq, rounder, -slope], axis=2)


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
