"""Band-limited motions: Fourier series per joint that begin and end at rest (Swevers et al. 1997, Eq. 6)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from armscope.core.types import Array

FINENESS = 8  # Samples per wave of the highest harmonic at which extremes are looked for


@dataclass(frozen=True, eq=False)
class Limits:
    """(m, 2) angles, rad; (m,) largest speed, rad/s, and acceleration, rad/s^2; infinite where there is none."""

    angle: Array
    speed: Array
    acceleration: Array


@dataclass(frozen=True, eq=False)
class FourierPath:
    """q_j(t) = centre_j + sum_k sine_jk sin(k w t) + cosine_jk cos(k w t), w = 2 pi / period."""

    centre: Array  # (m,) rad
    # sine, cosine: (m, K) rad
    sine: Array
    cosine: Array
    period: float  # s

    @property
    def harmonics(self) -> int:
        """K: the highest frequency is K / period."""
        return int(self.sine.shape[1])

    def at(self, time: Array) -> tuple[Array, Array, Array]:
        """(N, m) angle, rad, speed, rad/s, and acceleration, rad/s^2, at times (N,) s."""
        rate = 2 * np.pi / self.period * np.arange(1, self.harmonics + 1)
        phase = np.asarray(time)[:, None] * rate
        sin, cos = np.sin(phase), np.cos(phase)
        angle = self.centre + sin @ self.sine.T + cos @ self.cosine.T
        speed = (cos * rate) @ self.sine.T - (sin * rate) @ self.cosine.T
        acceleration = -(sin * rate**2) @ self.sine.T - (cos * rate**2) @ self.cosine.T
        return angle, speed, acceleration

    def over_period(self, finer: int = 1) -> tuple[Array, Array, Array]:
        """As `at`, over one period, fine enough to see its extremes, or so many times as fine."""
        count = FINENESS * self.harmonics * 2 * finer
        return self.at(np.arange(count) * self.period / count)

    def resting(self) -> FourierPath:
        """The nearest series whose speed and acceleration are zero at its beginning and end."""
        order = np.arange(1.0, self.harmonics + 1)
        return replace(self, sine=_without(self.sine, order), cosine=_without(self.cosine, order**2))

    def fitted(self, limits: Limits, use: float = 1.0, most: float = np.inf) -> FourierPath:
        """The same shape, its waves made as large, and its centre moved as little, as the limits allow.

        Args:
            limits: of angle, speed and acceleration.
            use: which share of them may be used.
            most: times as large as they are that waves may be made.

        Returns:
            The path within the limits.
        """
        angle, speed, acceleration = self.over_period()
        waves = angle - self.centre
        low, high = waves.min(axis=0), waves.max(axis=0)
        room = np.ptp(limits.angle, axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            factors = [
                room / (high - low),
                limits.speed / np.abs(speed).max(axis=0),
                limits.acceleration / np.abs(acceleration).max(axis=0),
            ]
        factor = np.minimum(use * np.nanmin(factors, axis=0), most)
        factor = np.where(np.isfinite(factor), factor, 1.0)
        margin = (1 - use) / 2 * np.where(np.isfinite(room), room, 0.0)
        lowest, highest = limits.angle[:, 0] + margin - factor * low, limits.angle[:, 1] - margin - factor * high
        middle = np.clip(self.centre, lowest, np.maximum(lowest, highest))
        return replace(self, centre=middle, sine=self.sine * factor[:, None], cosine=self.cosine * factor[:, None])


def random_path(limits: Limits, harmonics: int, period: float, rng: np.random.Generator) -> FourierPath:
    """A random series that uses nine tenths of the limits and rests at its ends.

    Args:
        limits: of angle (finite), speed and acceleration.
        harmonics: K.
        period: s.
        rng: of the coefficients.

    Returns:
        The path.
    """
    count = len(limits.angle)
    falling = 1 / np.arange(1, harmonics + 1)
    sine, cosine = rng.normal(size=(2, count, harmonics)) * falling
    low, high = limits.angle.T
    centre = low + rng.uniform(0.3, 0.7, count) * (high - low)
    return FourierPath(centre, sine, cosine, period).resting().fitted(limits, use=0.9)


def _without(coefficients: Array, direction: Array) -> Array:
    """Coefficients (m, K) without their part along a direction (K,)."""
    return coefficients - np.outer(coefficients @ direction, direction) / (direction @ direction)
