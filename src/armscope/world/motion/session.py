"""The motions of a moving world: runs for training, another for the test, on a grid finer than what is recorded."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from armscope.core.types import Array, Indices
from armscope.design.fourier import Limits, random_path
from armscope.robot.description import RobotDescription

GRID_HZ = 500  # Motions are simulated at this rate; what is recorded is every second, fourth or fifth sample of it
COLD_C, WARMING_C, WARMING_S = 20.0, 18.0, 25.0
"""Gears start at 20 C and warm by up to 18 C: faster than real ones (an hour), so that a short session shows it."""
HARMONICS = 6
ONE_WAY_SHARE = 0.7
"""A joint that only moves one way runs over this share of its range; its waves take up to half of its speed."""
NARROW_SHARE = 0.06  # A joint that hardly moves uses this share of its range

PathRule = Literal["free", "one_way", "narrow"]


@dataclass(frozen=True, eq=False)
class Session:
    """A motion at T samples of n joints."""

    time: Array  # (T,) s, from the start of each run
    run: NDArray[np.str_]  # (T,) name of the run
    # angle, speed, acceleration: (T, n) rad, rad/s, rad/s^2
    angle: Array
    speed: Array
    acceleration: Array
    temperature: Array  # (T,) C
    test: NDArray[np.bool_]  # (T,) belongs to the test path

    def __len__(self) -> int:
        return len(self.time)

    def runs(self) -> list[slice]:
        """Where each run stands."""
        starts = [0, *(np.flatnonzero(self.run[1:] != self.run[:-1]) + 1), len(self)]
        return [slice(a, b) for a, b in pairwise(starts)]

    def differentiated(self, values: Array) -> Array:
        """Time derivative of (T, ...) values, run by run."""
        found = np.empty_like(values)
        for run in self.runs():
            found[run] = np.gradient(values[run], 1 / GRID_HZ, axis=0)
        return found

    def moved(self, shift: Array) -> Session:
        """With joints turned by (T, n) rad more, speed and acceleration to suit."""
        speed, acceleration = np.empty_like(shift), np.empty_like(shift)
        for run in self.runs():
            path = make_interp_spline(self.time[run], shift[run], k=5)
            speed[run], acceleration[run] = (path.derivative(order)(self.time[run]) for order in (1, 2))
        return replace(
            self, angle=self.angle + shift, speed=self.speed + speed, acceleration=self.acceleration + acceleration
        )

    def taken(self, rows: Indices | slice) -> Session:
        """Some of the samples."""
        return Session(**{name: values[rows] for name, values in vars(self).items()})


def limits_of(description: RobotDescription) -> Limits:
    """Of an arm whose robot.yaml states all of them."""
    assert description.drives is not None
    assert description.joint_limits_deg is not None
    return Limits(
        np.radians(description.joint_limits_deg),
        np.radians(np.array([drive.speed_deg_s for drive in description.drives], dtype=float)),
        np.radians(np.array([drive.acceleration_deg_s2 for drive in description.drives], dtype=float)),
    )


def make_session(
    description: RobotDescription,
    durations: tuple[float, ...],
    rule: PathRule,
    joint: int | None,
    rng: np.random.Generator,
    paces: tuple[float, ...] | None = None,
) -> Session:
    """Random Fourier motions, each another one; the last is the test.

    Args:
        description: the arm with its limits.
        durations: s, of each run.
        rule: ``free``; or one joint moves one way only, or hardly at all, in the training runs.
        joint: (0-based) that the rule is about.
        rng: of the paths.
        paces: how fast each run goes, over what the limits allow; None: all as fast as that.

    Returns:
        The session.
    """
    limits = limits_of(description)
    parts = []
    for number, (duration, pace) in enumerate(zip(durations, paces or (1.0,) * len(durations), strict=True)):
        test = number == len(durations) - 1
        time = np.arange(round(duration * GRID_HZ)) / GRID_HZ
        path = random_path(limits, HARMONICS, duration, rng).at(pace * time)
        motion = tuple(values * pace**order for order, values in enumerate(path))
        if joint is not None and not test:
            motion = _ruled(motion, rule, joint, limits, time)
        parts.append((time, np.full(len(time), "test" if test else f"run{number + 1}"), motion, test))
    time, run = (np.concatenate([part[k] for part in parts]) for k in (0, 1))
    angle, speed, acceleration = (np.concatenate([part[2][k] for part in parts]) for k in range(3))
    so_far = np.arange(len(time)) / GRID_HZ
    temperature = COLD_C + WARMING_C * (1 - np.exp(-so_far / WARMING_S))
    test_rows = np.concatenate([np.full(len(part[0]), part[3]) for part in parts])
    return Session(time, run, angle, speed, acceleration, temperature, test_rows)


def _ruled(
    motion: tuple[Array, ...], rule: PathRule, joint: int, limits: Limits, time: Array
) -> tuple[Array, Array, Array]:
    angle, speed, acceleration = (np.array(each) for each in motion)
    low, high = limits.angle[joint]
    middle = (low + high) / 2
    if rule == "narrow":
        share = NARROW_SHARE * (high - low) / np.ptp(angle[:, joint])
        angle[:, joint] = middle + share * (angle[:, joint] - angle[:, joint].mean())
        speed[:, joint] *= share
        acceleration[:, joint] *= share
    if rule == "one_way":
        steady = min(ONE_WAY_SHARE * (high - low) / time[-1], limits.speed[joint] / 2)
        share = 0.5 * steady / np.abs(speed[:, joint]).max()
        waves = share * (angle[:, joint] - angle[:, joint].mean())
        angle[:, joint] = middle + steady * (time - time[-1] / 2) + waves
        speed[:, joint] = steady + share * speed[:, joint]
        acceleration[:, joint] *= share
    return angle, speed, acceleration
