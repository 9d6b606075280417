"""Whether positions of a moving arm are in other units or in another order of joints: what the masses' torque says."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
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

    def turned(self, joints: Sequence[int]) -> Samples:
        """With the sign of some joints' torque turned."""
        return replace(self, effort=self._signs(joints) * self.effort)

    def turned_round(self, joints: Sequence[int]) -> Samples:
        """With the positions of some joints counted the other way round."""
        signs = self._signs(joints)
        return Samples(signs * self.q, signs * self.dq, signs * self.ddq, self.effort)

    def _signs(self, joints: Sequence[int]) -> Array:
        return np.where(np.isin(np.arange(self.q.shape[1]), joints), -1.0, 1.0)


@dataclass(frozen=True, eq=False)
class OtherReading:
    """What a table means if it is not what its columns say."""

    told: tuple[Suspicion, ...]
    samples: Samples  # as they are then
    order: tuple[int, ...] = ()  # of the channels of torque, by joint; empty as they stand


def ordinary_columns(samples: Samples, j: int) -> Array:
    """(N, 4) offset, dry and viscous friction and a rotor of a joint."""
    dq = samples.dq[:, j]
    return np.column_stack([np.ones(len(dq)), np.sign(dq), dq, samples.ddq[:, j]])


def beyond_friction(samples: Samples, rigid: Array) -> Iterator[tuple[Array, Array]]:
    """By joint, (N,) torque as recorded and as the masses ask for, each without offset, friction and a rotor."""
    for j in range(rigid.shape[1]):
        ordinary = ordinary_columns(samples, j)
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


def read_otherwise(samples: Samples, arm: MovingArm) -> Iterator[OtherReading]:
    """What the table means if it is not what its columns say: degrees, or another order of the joints. Yields a
    problem, where the masses explain the torque only if the table is read otherwise."""
    if len(samples.q) < MOTION.reading_samples or not np.any(arm.inertial):
        return
    few = samples.rows(spread_evenly(len(samples.q), MOTION.reading_rows))
    stated = explained(few, arm)

    def better(share: float) -> bool:
        return share > MOTION.explained and MOTION.clearly * (1 - share) < 1 - stated

    def reading(share: float, otherwise: str, cure: str, then: Samples, order: tuple[int, ...] = ()) -> OtherReading:
        statement = f"masses explain {_share(stated)} of the torque, and {_share(share)} {otherwise}"
        return OtherReading((Suspicion("problem", statement, cure),), then, order)

    if (as_radians := _as_radians(few, arm)) is not None and better(as_radians):
        otherwise = "if what is read as degrees is radians: no joint moves beyond 6.3 degrees"
        cure = "Call their columns q1_rad ... and dq1_rad_s ...."
        yield reading(as_radians, otherwise, cure, samples.scaled(180 / np.pi, ~arm.sliding))
        return
    if stated >= MOTION.explained:
        return
    found = max(tried_readings(few, arm), key=lambda each: each.share)
    if better(found.share):
        yield reading(found.share, found.otherwise, found.cure, found.then(samples), found.order)


@dataclass(frozen=True, eq=False)
class TriedReading:
    """A reading that is tried: how much masses explain then, in words and as what it makes of a table."""

    share: float
    otherwise: str
    cure: str
    then: Callable[[Samples], Samples]
    order: tuple[int, ...] = ()


def tried_readings(few: Samples, arm: MovingArm) -> Iterator[TriedReading]:
    """Degrees, of all joints or of one, and other orders, each tried on a few samples."""
    turning = np.flatnonzero(~arm.sliding)
    for some in [turning, *(turning[[k]] for k in range(len(turning) if len(turning) > 1 else 0))]:
        which = np.isin(np.arange(arm.n_motors), some)
        then = partial(Samples.scaled, factor=np.pi / 180, turning=which)
        if len(some) == 1 < arm.n_motors:
            otherwise, j = f"if q{some[0] + 1} alone is in degrees", some[0] + 1
            cure = f"Call its columns q{j}_deg and dq{j}_deg_s, or scale them: the others are as they say."
        else:
            otherwise, cure = "if positions are degrees", "Call their columns q1_deg ... and dq1_deg_s ...."
        yield TriedReading(explained(then(few), arm), otherwise, cure, then)
    for order in _orders(arm):
        for what in MISNUMBERED:
            then = partial(Samples.reordered, order=order, what=what)
            otherwise = f"with {what} in the order {' '.join(f'{j + 1}' for j in order)}"
            cure = "Number the columns in the order of the arm's joints, from the base."
            yield TriedReading(explained(then(few), arm), otherwise, cure, then, order if what != POSITIONS else ())


def _as_radians(few: Samples, arm: MovingArm) -> float | None:
    """Share that masses explain if degrees are radians; None where a joint that turns goes beyond a turn of these."""
    turning, unit = ~arm.sliding, 180 / np.pi
    if not turning.any() or unit * np.abs(few.q[:, turning]).max() > 2 * np.pi:
        return None
    return explained(few.scaled(unit, turning), arm)


def exchanged(samples: Samples, arm: MovingArm, names: Sequence[str]) -> Iterator[OtherReading]:
    """Torques that follow another joint's motion and hardly their own: friction tells it where masses ask for little.

    Args:
        samples: differenced over a twentieth of a second.
        arm: as stated.
        names: of the columns of torque.

    Yields:
        Once, with a problem for every such column, if each of them, put in order, is told far better.
    """
    if len(samples.q) < MOTION.reading_samples or arm.n_motors < 2:
        return
    from scipy.optimize import linear_sum_assignment  # takes long to import: a table that is refused needs none

    few = samples.rows(spread_evenly(len(samples.q), MOTION.reading_rows))
    left = _left_by_motion(few, arm)
    told_by = linear_sum_assignment(np.log(left))[1]
    moved = np.flatnonzero(told_by != np.arange(arm.n_motors))
    own, others = left[moved, moved], left[moved, told_by[moved]]
    if not len(moved) or np.any(own <= MOTION.clearly * others) or np.any(1 - others < MOTION.explained):
        return
    found = []
    for j, of, now, then in zip(moved.tolist(), told_by[moved].tolist(), own, others, strict=True):
        statement = (
            f"{names[j]} follows joint {of + 1}: its speed, acceleration and masses explain {_share(1 - then)} of it, "
            f"those of joint {j + 1} {_share(1 - now)}"
        )
        cure = f"Are torques exchanged? Call the column that of joint {of + 1}."
        found.append(Suspicion("problem", statement, cure))
    order = tuple(np.argsort(told_by).tolist())
    yield OtherReading(tuple(found), samples.reordered(order, TORQUES), order)


def left_along(samples: Samples, arm: MovingArm) -> Array:
    """(2, m) share of each torque, as it is and with its sign turned, that offset and its joint's motion leave.

    Of the motion friction, a rotor and the stated masses ask for torque, none of which can be negative.
    """
    from scipy.optimize import nnls  # takes long to import: a table that is refused needs none

    few = samples.rows(spread_evenly(len(samples.q), MOTION.reading_rows))
    rigid, left = arm.torques(few.q, few.dq, few.ddq, arm.inertial), np.ones((2, arm.n_motors))
    for j in range(arm.n_motors):
        asked = np.column_stack([np.sign(few.dq[:, j]), few.dq[:, j], few.ddq[:, j], rigid[:, j]])
        asked -= asked.mean(axis=0)
        asked /= np.maximum(np.linalg.norm(asked, axis=0), 1e-300)
        recorded = few.effort[:, j] - few.effort[:, j].mean()
        size = float(np.linalg.norm(recorded))
        if size > 0:
            left[:, j] = [(nnls(asked, sign * recorded / size)[1]) ** 2 for sign in (1, -1)]
    return np.maximum(left, MOTION.least_left)


def left_in_all(samples: Samples, arm: MovingArm) -> float:
    """Logarithm of the share that each joint's motion leaves of its torque, summed."""
    return float(np.log(left_along(samples, arm)[0]).sum())


def _left_by_motion(samples: Samples, arm: MovingArm) -> Array:
    """(m, m) share of each torque's power that offset, friction, rotor and masses of each joint leave."""
    rigid = arm.torques(samples.q, samples.dq, samples.ddq, arm.inertial)
    effort = samples.effort - samples.effort.mean(axis=0)
    power = np.maximum(np.sum(effort**2, axis=0), 1e-300)
    left = np.ones((arm.n_motors, arm.n_motors))
    for j in range(arm.n_motors):
        dq = samples.dq[:, j]
        ordinary = np.column_stack([np.ones(len(dq)), np.sign(dq), dq, samples.ddq[:, j], rigid[:, j]])
        missed = effort - ordinary @ np.linalg.lstsq(ordinary, effort, rcond=None)[0]
        left[:, j] = np.sum(missed**2, axis=0) / power
    return np.asarray(np.clip(left, 1e-12, None))


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
