"""Whether positions of a moving arm are in other units or in another order of joints: what the masses' torque says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from armscope.check.motion_constants import MOTION
from armscope.check.suspicion import Suspicion
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array, Indices
from armscope.robot.dynamics import MovingArm

JOINTS, POSITIONS, TORQUES = MISNUMBERED = ("joints", "positions", "torques")
"""Whose columns may be in another order than the arm's joints."""


@dataclass(frozen=True, eq=False)
class Samples:
    """(N, m) positions, velocities, accelerations and torque or current, as the table has them."""

    q: Array
    dq: Array
    ddq: Array
    effort: Array

    def rows(self, which: Indices) -> Samples:
        """Some of the samples."""
        return Samples(self.q[which], self.dq[which], self.ddq[which], self.effort[which])

    def scaled(self, factor: float, turning: NDArray[np.bool_]) -> Samples:
        """With the positions of turning joints in another unit."""
        by = np.where(turning, factor, 1.0)
        return Samples(by * self.q, by * self.dq, by * self.ddq, self.effort)

    def reordered(self, order: tuple[int, ...], what: str) -> Samples:
        """With columns in another order: of "positions", of "torques", or of "joints", which is both."""
        to = list(order)
        moved = self if what == TORQUES else Samples(self.q[:, to], self.dq[:, to], self.ddq[:, to], self.effort)
        return moved if what == POSITIONS else replace(moved, effort=self.effort[:, to])


def beyond_friction(samples: Samples, rigid: Array) -> Iterator[tuple[Array, Array]]:
    """By joint, (N,) torque as recorded and as the masses ask for, each without offset, friction and a rotor."""
    for j in range(rigid.shape[1]):
        dq, ddq = samples.dq[:, j], samples.ddq[:, j]
        ordinary = np.column_stack([np.ones(len(dq)), np.sign(dq), dq, ddq])
        recorded, asked = (
            each - ordinary @ np.linalg.lstsq(ordinary, each, rcond=None)[0]
            for each in (samples.effort[:, j], rigid[:, j])
        )
        yield recorded, asked


def explained(samples: Samples, arm: MovingArm) -> float:
    """Share of the torque beyond friction that the stated masses explain, each joint by a factor of its own."""
    rigid = arm.torques(samples.q, samples.dq, samples.ddq, arm.inertial)
    told = total = 0.0
    for recorded, asked in beyond_friction(samples, rigid):
        power = float(asked @ asked)
        along = max(float(asked @ recorded), 0.0)
        total += float(recorded @ recorded)
        told += along**2 / power if power > 0 else 0.0
    return told / total if total > 0 else 1.0


def read_otherwise(samples: Samples, arm: MovingArm) -> Iterator[Suspicion]:
    """What the table means if it is not what its columns say: degrees, or another order of the joints.

    Yields:
        A problem, where the masses explain the torque only if the table is read otherwise.
    """
    if len(samples.q) < MOTION.reading_samples or not np.any(arm.inertial):
        return
    few = samples.rows(spread_evenly(len(samples.q), MOTION.reading_rows))
    stated = explained(few, arm)
    if stated >= MOTION.explained:
        return

    def better(share: float) -> bool:
        return share > MOTION.explained and MOTION.clearly * (1 - share) < 1 - stated

    as_degrees = explained(few.scaled(np.pi / 180, ~arm.sliding), arm)
    if better(as_degrees):
        yield Suspicion(
            "problem",
            f"masses explain {_share(stated)} of the torque, and {_share(as_degrees)} if positions are degrees",
            "Call their columns q1_deg ... and dq1_deg_s ....",
        )
        return
    found = [
        (explained(few.reordered(order, what), arm), what, order) for order in _orders(arm) for what in MISNUMBERED
    ]
    best, what, order = max(found, default=(0.0, JOINTS, ()))
    if better(best):
        told = " ".join(f"{j + 1}" for j in order)
        yield Suspicion(
            "problem",
            f"masses explain {_share(stated)} of the torque, and {_share(best)} with {what} in the order {told}",
            "Number the columns in the order of the arm's joints, from the base.",
        )


def _share(of: float) -> str:
    return f"{100 * of:.0f} %"


def _orders(arm: MovingArm) -> Iterator[tuple[int, ...]]:
    """Orders of joints that people mix up: reversed, moved on by one, two swapped."""
    own = tuple(range(arm.n_motors))
    pairs = (dict([pair, pair[::-1]]) for pair in combinations(own, 2))
    swapped = [tuple(pair.get(j, j) for j in own) for pair in pairs]
    for order in dict.fromkeys((own[::-1], (*own[1:], own[0]), (own[-1], *own[:-1]), *swapped)):
        if order != own and np.array_equal(arm.sliding[list(order)], arm.sliding):
            yield order
