"""Channels of torque that can't be those of their joints: friction that drives, and noise in the place of a torque."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from armscope.check.motion_constants import MOTION
from armscope.check.motion_readings import Samples
from armscope.check.suspicion import Suspicion
from armscope.core.numerals import rounded
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.motion.check import channels
from armscope.motion.constants import LIBRARY
from armscope.recordings.motions import Motions
from armscope.robot.dynamics import MovingArm
from armscope.verdict.wording import percent


def odd_channels(motions: Motions, samples: Samples, arm: MovingArm, told: Iterator[Suspicion]) -> Iterator[Suspicion]:
    """Torques or currents that no joint has that moves so.

    Friction takes power from every motor, whatever its masses: a torque that goes against the speed where friction
    would go with it has the other sign. That is seen at a wrist, too, which carries too little for its masses to show
    it. And where the stated masses ask for much more than is recorded, a channel of which neither they nor friction
    nor acceleration explain anything was not connected.

    Args:
        motions: of which the samples are.
        samples: differenced over a twentieth of a second.
        arm: as stated.
        told: what was found of their sign and size.

    Yields:
        What is found in this way first of all.
    """
    known = list(told)
    yield from known
    if len(samples.q) < MOTION.reading_samples or not np.any(arm.inertial):
        return
    few = samples.rows(spread_evenly(len(samples.q), MOTION.rows))
    asked = arm.torques(few.q, few.dq, few.ddq, arm.inertial)
    gains = np.where(np.isnan(arm.gains), 1.0, arm.gains) if motions.kind == "current" else np.ones(motions.n_motors)
    for j, name in enumerate(channels(motions)):
        moves = np.ptp(motions.q[:, j]) > LIBRARY.still_rad
        if not moves or np.ptp(few.effort[:, j]) == 0 or any(each.statement.startswith(f"{name} ") for each in known):
            continue
        effort = few.effort[:, j] * gains[j]
        if (noise := _noise_alone(effort, asked[:, j], few, j)) is not None:
            statement = f"{name} shows noise alone: {noise}"
            yield Suspicion("problem", statement, f"Is the channel of joint {j + 1} connected?")
        elif _friction_drives(effort, asked[:, j], few, j):
            statement = f"{name} has the sign opposite to the motion: friction of joint {j + 1} would drive it"
            cure = "Turn its sign: torque is the motor's, positive along the motion it drives."
            yield Suspicion("problem", statement, cure)


def _noise_alone(effort: Array, asked: Array, samples: Samples, j: int) -> str | None:
    """What a torque lacks of all that a joint's torque follows; None where it follows any of it."""
    everything = np.column_stack([_friction(samples, j), asked, samples.ddq[:, j]])
    share = 1 - _left(effort, everything) / max(float(np.var(effort)) * len(effort), 1e-300)
    times = float(np.std(asked)) / max(float(np.std(effort)), 1e-300)
    if share > MOTION.of_noise or times < MOTION.other_size:
        return None
    return (
        f"the stated masses ask for {rounded(times)} times as much, and neither they nor friction and acceleration of "
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
