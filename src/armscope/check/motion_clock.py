"""Whether torque was recorded by another clock than positions: where masses and friction meet it at another time only.

A diagnosis tries delays of drives and field buses, some hundredths of a second. Two recordings that were started one
after the other lie farther apart; then friction changes sides at the wrong time, and every law of torque is wrong.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.ndimage import binary_closing

from armscope.check.motion_constants import MOTION
from armscope.check.motion_readings import Samples
from armscope.check.suspicion import Suspicion
from armscope.core.types import Array, Indices
from armscope.recordings.motions import Motions
from armscope.robot.dynamics import MovingArm


def other_clock(motions: Motions, runs: dict[str, tuple[Array, Samples]], arm: MovingArm) -> Iterator[Suspicion]:
    """Joints whose torque belongs to motion at another time.

    Args:
        motions: the table, time stamps mended.
        runs: by name, time (K,), s, of samples of it, and these.
        arm: whose masses are stated.

    Yields:
        A problem, for all joints at once where one lag of all says most, else by joint; nothing where masses and
        friction meet torque as recorded.
    """
    least_told, farthest, step = MOTION.clock
    lags = np.arange(-farthest, farthest + step / 2, step)
    left = _left(motions, runs, arm, lags)
    now = int(np.argmin(np.abs(lags)))
    times_less = np.log(left[now] / np.maximum(left, 1e-300))
    alike = int(np.argmax(times_less.sum(axis=1)))
    gained = times_less[alike]
    well_met = float(np.median(left[now])) < MOTION.met_as_recorded
    if not well_met and abs(lags[alike]) > least_told and gained.min() > 0 and gained.sum() > np.log(MOTION.clearly):
        every = np.arange(motions.n_motors)
        yield _told(motions.kind, lags[alike], every, (left[now], left[alike]))
        return
    for j, best in enumerate(np.argmax(times_less, axis=0)):
        if (
            left[now, j] > MOTION.met_as_recorded
            and abs(lags[best]) > least_told
            and times_less[best, j] > np.log(MOTION.at_another_time)
        ):
            yield _told(motions.kind, lags[best], np.array([j]), (left[now], left[best]))


def _told(kind: str, late: float, joints: Indices, left: tuple[Array, Array]) -> Suspicion:
    """In words; ``left``: shares that are left as recorded and at the other time, of every joint."""
    now, then = (_percent(float(np.median(shares[joints]))) for shares in left)
    of = f"joint {joints[0] + 1}" if len(joints) == 1 else "all joints"
    statement = (
        f"{kind} of {of} lies {abs(1e3 * late):.0f} ms {'after' if late > 0 else 'before'} the motion: masses and "
        f"friction leave {now} of its power as recorded, and {then} at that time"
    )
    way = "earlier" if late > 0 else "later"
    return Suspicion("problem", statement, f"Was it recorded by another clock? Take it {abs(late):.3g} s {way}.")


def _percent(share: float) -> str:
    return f"{100 * share:.2g} %"


def _left(motions: Motions, runs: dict[str, tuple[Array, Samples]], arm: MovingArm, lags: Array) -> Array:
    """(lags, m) share of the power of each joint's torque that offset, friction, rotor and masses leave at each lag.

    Where a joint stands, its friction may be anything, at every lag alike.
    """
    torque, moved = [], []
    for run, (time, few) in runs.items():
        if not len(time):
            continue
        there = motions.run == run
        inside = (time > time[0] + lags[-1]) & (time < time[-1] - lags[-1])
        at = time[inside, None] + lags
        own = [np.interp(at, motions.time[there], effort) for effort in motions.effort[there].T]
        torque.append(np.stack(own, axis=2))
        moved.append(few.rows(np.flatnonzero(inside)))
    if not sum(len(each.q) for each in moved) >= MOTION.reading_samples:
        return np.ones((len(lags), motions.n_motors))
    tau = np.concatenate(torque)
    q, dq, ddq = (np.concatenate([getattr(each, name) for each in moved]) for name in ("q", "dq", "ddq"))
    rigid = arm.torques(q, dq, ddq, arm.inertial)
    left = np.ones(tau.shape[1:])
    for j in range(tau.shape[2]):
        speed = np.abs(dq[:, j])
        moving = binary_closing(speed > MOTION.standing * speed.max(), np.ones(MOTION.around + 1, dtype=bool))
        if moving.sum() < MOTION.reading_samples:
            continue
        shifted, speed = tau[moving, :, j], dq[moving, j]
        ordinary = np.column_stack([np.ones(len(shifted)), np.sign(speed), speed, ddq[moving, j], rigid[moving, j]])
        basis = np.linalg.svd(ordinary, full_matrices=False)[0]
        power = np.sum((shifted - shifted.mean(axis=0)) ** 2, axis=0)
        missed = np.sum((shifted - basis @ (basis.T @ shifted)) ** 2, axis=0)
        left[:, j] = np.where(power > 0, missed / np.maximum(power, 1e-300), 1.0)
    return left
