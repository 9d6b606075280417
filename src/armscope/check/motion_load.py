"""Whether a load that nobody stated makes torques as large as they are: a wrist carries little beside it by itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.check.motion_constants import MOTION
from armscope.check.motion_readings import Samples, beyond_friction, left_in_all, ordinary_columns, read_otherwise
from armscope.check.suspicion import Suspicion
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.recordings.motions import Motions
from armscope.robot.dynamics import MovingArm


def factors_of(samples: Samples, rigid: Array) -> dict[int, float]:
    """By how many times torques differ from those of masses, beyond friction, of joints where masses explain most.
    ``samples``: N of m joints; ``rigid``: (N, m) N m, of the masses."""
    factors: dict[int, float] = {}
    for j, (left, asked) in enumerate(beyond_friction(samples, rigid)):
        power = float(asked @ asked)
        if power > 0 and (asked @ left) ** 2 >= MOTION.explained * power * float(left @ left):
            factors[j] = float(asked @ left) / power
    return factors


def is_of_another_size(factor: float) -> bool:
    """Whether a torque is far from that of the masses."""
    return not 1 / MOTION.other_size < factor < MOTION.other_size


def with_stated_payload(arm: MovingArm, motions: Motions) -> MovingArm:
    """The arm with the payload that most samples state, at its tool point."""
    if motions.payload is None:
        return arm
    return replace(arm, inertial=arm.inertial + float(np.median(motions.payload)) * arm.point_load())


def with_a_load(samples: Samples, arm: MovingArm) -> tuple[MovingArm, float] | None:
    """The arm with a load that brings all torques to the size of the masses', and the load's kg.

    It must suit all joints at once: a single channel in another unit is none.

    Returns:
        None where no torque is far from the masses', or no load explains it, or another unit or order explains more.
    """
    few = samples.rows(spread_evenly(len(samples.q), MOTION.rows))
    rigid = arm.torques(few.q, few.dq, few.ddq, arm.inertial)
    now = factors_of(few, rigid)
    far = [factor for factor in now.values() if is_of_another_size(factor)]
    if not far or min(far) < 0:  # a sign is looked at before a size
        return None
    load = _fitted(few, arm, rigid)
    mass = float(load[0])
    heaviest = float(arm.inertial[::10].sum())
    if not 0 < mass < heaviest or np.linalg.norm(load[1:]) > MOTION.load_within * mass:
        return None
    inertial = arm.inertial.copy()
    inertial[-10:-6] += load
    loaded = replace(arm, inertial=inertial)
    then = factors_of(few, arm.torques(few.q, few.dq, few.ddq, inertial))
    suits = now.keys() <= then.keys() and not any(is_of_another_size(factor) for factor in then.values())
    return (loaded, mass) if suits and not _read_better(samples, arm, loaded) else None


def _read_better(samples: Samples, arm: MovingArm, loaded: MovingArm) -> bool:
    """Whether another reading of the table, by the arm as stated, leaves less than the load does."""
    return any(left_in_all(each.samples, arm) < left_in_all(samples, loaded) for each in read_otherwise(samples, arm))


def _fitted(few: Samples, arm: MovingArm, rigid: Array) -> Array:
    """Mass and first moments (4,) of a load; every joint counts alike, whatever its torque beyond friction."""
    regressor = arm.regressor(few.q, few.dq, few.ddq)[:, :, -10:-6]
    rows, wanted = [], []
    for j in range(arm.n_motors):
        ordinary = ordinary_columns(few, j)
        both = np.column_stack([few.effort[:, j], few.effort[:, j] - rigid[:, j], regressor[:, j]])
        both -= ordinary @ np.linalg.lstsq(ordinary, both, rcond=None)[0]
        size = max(float(np.linalg.norm(both[:, 0])), 1e-300)
        wanted.append(both[:, 1] / size)
        rows.append(both[:, 2:] / size)
    return np.asarray(np.linalg.lstsq(np.concatenate(rows), np.concatenate(wanted), rcond=None)[0])


def unstated_load(mass: float) -> Suspicion:
    """That torques ask for such a load, kg, in words."""
    statement = f"torques are those of the stated masses and a load of about {mass:.2g} kg that is not stated"
    cure = (
        "Weigh it and state it as tool_load in robot.yaml, or let a diagnosis find it. If the arm carried nothing, is "
        "a torque in another unit?"
    )
    return Suspicion("hint", statement, cure)
