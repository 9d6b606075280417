"""Channels of torque that can't be those of their joints: friction that drives, and noise in the place of a torque."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from armscope.check.motion_constants import MOTION
from armscope.check.motion_readings import Samples, left_along
from armscope.check.suspicion import Suspicion
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.motion.check import channels
from armscope.motion.samples.standing import still_span
from armscope.recordings.motions import Motions
from armscope.robot.dynamics import MovingArm
from armscope.verdict.wording import percent, times

SIGN = "has the sign opposite"  # What is said of every torque whose sign is turned, after its name
OF_MASSES = "what moves the stated masses"  # Opposite to which it is, where it is masses that say so


@dataclass(frozen=True)
class Channels:
    """Columns of torque or current, by joint."""

    names: tuple[str, ...]
    gains: tuple[float, ...]  # N m (N) per unit of each joint's column
    currents: bool = False  # whether they are amperes

    @classmethod
    def of(cls, motions: Motions, arm: MovingArm) -> Channels:
        """Of a table, as it stands."""
        currents = motions.kind == "current"
        gains = np.where(np.isnan(arm.gains), 1.0, arm.gains) if currents else np.ones(motions.n_motors)
        return cls(tuple(channels(motions)), tuple(gains.tolist()), currents)

    def reordered(self, order: tuple[int, ...]) -> Channels:
        """With columns in another order; a gain stays its joint's."""
        return replace(self, names=tuple(self.names[j] for j in order)) if order else self


def odd_channels(samples: Samples, arm: MovingArm, of: Channels, told: Iterator[Suspicion]) -> Iterator[Suspicion]:
    """Torques or currents that no joint has that moves so.

    Friction takes power from every motor, whatever its masses: a torque that goes against the speed where friction
    would go with it has the other sign. That is seen at a wrist, too, which carries too little for its masses to show
    it. And where the stated masses ask for much more than is recorded, a channel of which neither they nor friction
    nor acceleration explain anything was not connected.

    Args:
        samples: differenced over a twentieth of a second.
        arm: as stated.
        of: the columns.
        told: what was found of their sign and size.

    Yields:
        What is found in this way first of all.
    """
    known = list(told)
    yield from known
    if len(samples.q) < MOTION.reading_samples or not np.any(arm.inertial):
        return
    few, along = samples.rows(spread_evenly(len(samples.q), MOTION.rows)), left_along(samples, arm)
    asked = arm.torques(few.q, few.dq, few.ddq, arm.inertial)
    for j, name in enumerate(of.names):
        moves = np.ptp(few.q[:, j]) > still_span(arm.sliding)[j]
        if not moves or np.ptp(few.effort[:, j]) == 0 or any(each.statement.startswith(f"{name} ") for each in known):
            continue
        effort = few.effort[:, j] * of.gains[j]
        as_it_is, turned = along[:, j].tolist()
        if (noise := _noise_alone(effort, asked[:, j], few, j)) is not None:
            statement = f"{name} shows noise alone: {noise}"
            yield Suspicion("problem", statement, f"Is the channel of joint {j + 1} connected?")
        elif _friction_drives(effort, asked[:, j], few, j):
            statement = f"{name} {SIGN} to the motion: friction of joint {j + 1} would drive it"
            yield Suspicion("problem", statement, turn(of.currents))
        elif MOTION.clearly * turned < as_it_is and 1 - turned > MOTION.explained:
            shares = f"explain {percent(1 - turned)} of it with its sign turned, {percent(1 - as_it_is)} as it is"
            statement = f"{name} {SIGN} to {OF_MASSES}: they, a rotor and friction of joint {j + 1} {shares}"
            yield Suspicion("problem", statement, turn(of.currents))


def turn(currents: bool) -> str:
    """The cure of a turned sign."""
    if currents:
        return "Turn its sign, or that of its gain_nm_per_a: the motor's torque is positive along the motion it drives."
    return "Turn its sign: torque is the motor's, positive along the motion it drives."


def _noise_alone(effort: Array, asked: Array, samples: Samples, j: int) -> str | None:
    """What a torque lacks of all that a joint's torque follows; None where it follows any of it."""
    everything = np.column_stack([_friction(samples, j), asked, samples.ddq[:, j]])
    share = 1 - _left(effort, everything) / max(float(np.var(effort)) * len(effort), 1e-300)
    more = float(np.std(asked)) / max(float(np.std(effort)), 1e-300)
    if share > MOTION.of_noise or more < MOTION.other_size:
        return None
    return (
        f"the stated masses ask for {times(more)} times as much, and neither they nor friction and acceleration of "
        f"joint {j + 1} explain more than {percent(share)} of it"
    )


def _friction_drives(effort: Array, asked: Array, samples: Samples, j: int) -> bool:
    """Whether most of a torque, beyond masses and acceleration, goes with friction of the wrong sign."""
    friction, others = _friction(samples, j), np.column_stack([asked, samples.ddq[:, j]])
    fitted = np.linalg.lstsq(np.column_stack([friction, others, np.ones(len(effort))]), effort, rcond=None)[0]
    of_friction = friction @ fitted[:2]
    beside = _left(effort, others)
    explained = 1 - _left(effort, np.column_stack([friction, others])) / max(beside, 1e-300)
    by_masses = 1 - beside / max(_left(effort, samples.ddq[:, [j]]), 1e-300)
    agree = fitted[2] > 0 and by_masses > MOTION.of_noise  # masses have their sign: something else is odd
    return bool(explained > MOTION.driving and of_friction @ samples.dq[:, j] < 0 and not agree)


def _friction(samples: Samples, j: int) -> Array:
    """(N, 2) dry and viscous."""
    return np.column_stack([np.sign(samples.dq[:, j]), samples.dq[:, j]])


def _left(values: Array, columns: Array) -> float:
    """Squares that columns, and a constant, leave."""
    columns = np.column_stack([columns, np.ones(len(values))])
    return float(np.sum((values - columns @ np.linalg.lstsq(columns, values, rcond=None)[0]) ** 2))
