"""What a table lets the library know before any fit: ranges, and which inertial parameters its motion shows."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.motion.library.causes import Seen
from armscope.motion.samples.timing import Stretch
from armscope.robot.dynamics import MovingArm


def seen_in(arm: MovingArm, stretches: Sequence[Stretch], still: Array | float) -> Seen:
    """Ranges of what causes follow, from some of the samples.

    Args:
        arm: the arm.
        stretches: even samples.
        still: a joint that spans less stands, rad or m; of all, or (m,).

    Returns:
        What the library needs to know of the table.
    """
    q = np.concatenate([stretch.q for stretch in stretches])
    dq = np.concatenate([np.gradient(stretch.q, stretch.time, axis=0) for stretch in stretches if len(stretch) > 1])
    few = q[:: max(len(q) // 500, 1)]
    tenth = [_some(stretch) for stretch in stretches]
    regressor = arm.regressor(*(np.concatenate(each) for each in zip(*tenth, strict=True)))
    warm = [stretch.temperature for stretch in stretches if stretch.temperature is not None]
    load = np.abs(arm.gravity_torques(few, arm.model.gravity.linear)).max(axis=0)
    runs = tuple(dict.fromkeys(stretch.run for stretch in stretches))
    return Seen(
        arm=arm,
        q=np.percentile(q, [0.1, 99.9], axis=0).T,
        dq=np.percentile(dq, [1, 99], axis=0).T,
        speeds=np.percentile(np.abs(dq), np.arange(0.5, 100), axis=0).T,
        load=np.maximum(load, 1e-9),
        effort=np.maximum(np.sqrt(np.mean(np.concatenate([s.effort for s in stretches]) ** 2, axis=0)), 1e-9),
        time=np.array([min(s.time[0] - s.began for s in stretches), max(s.time[-1] - s.began for s in stretches)]),
        temperature=np.percentile(np.concatenate(warm), [0.1, 99.9], axis=0).T if warm else None,
        running_min=_running_min(stretches),
        runs=runs,
        moving=np.asarray(np.ptp(q, axis=0) > still),
        regressor=regressor.reshape(-1, len(arm.inertial)),
        both_sides=_both_sides(stretches),
    )


def _running_min(stretches: Sequence[Stretch]) -> float:
    """Minutes until the last of them ends, from when the arm began to run."""
    return max((float(each.running[-1]) for each in stretches if each.running is not None), default=0.0) / 60


def _both_sides(stretches: Sequence[Stretch]) -> NDArray[np.bool_] | None:
    """(m,) whether all stretches hold the link's position beside the motor's."""
    links = [stretch.link for stretch in stretches if stretch.link is not None]
    return np.asarray(np.isfinite(np.concatenate(links)).all(axis=0)) if links else None


def _some(stretch: Stretch) -> tuple[Array, Array, Array]:
    """Positions and derivatives of some samples, differenced over a tenth of a second: to see what shows at all."""
    step = max(int(stretch.rate / 10), 1)
    q = stretch.q[::step][:: max(len(stretch.q) // step // 300, 1)]
    dq = np.gradient(stretch.q[::step], step / stretch.rate, axis=0)
    ddq = np.gradient(dq, step / stretch.rate, axis=0)
    every = max(len(stretch.q) // step // 300, 1)
    return q, dq[::every], ddq[::every]
