"""Position inverse kinematics: motor angles that bring the tool point along a path, without jumps.

A redundant arm (more free motors than three) takes the solution with the least joint motion since the previous point:
the minimum of |q - q_previous|^2 subject to f(q) = target, by Newton's method on its Lagrange conditions,

    q <- q_previous + J+ (target - f(q) + J (q - q_previous)),    J+ = J' (J J')^-1.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from armscope.core.inputs import InputError
from armscope.core.types import Array, Indices
from armscope.robot.arm import Arm
from armscope.robot.constants import SEARCH
from armscope.robot.kinematics import chain, position_jacobian
from armscope.robot.model import TIP
from armscope.robot.newton_steps import damping, least_turns, shortened

BEYOND_REACH = "beyond reach"


@dataclass(frozen=True, eq=False)
class PathSolution:
    """Motor angles along a path of N points."""

    targets: Array  # (N, 3) where the tool should be, in the base frame, m
    motor_angles: Array  # (N, m) rad; NaN in rows that can't be reached
    reasons: NDArray[np.str_]  # (N,) "" where reached, else "beyond reach", "limit of joint j" or "jump of joint j"

    @property
    def reached(self) -> NDArray[np.bool_]:
        """(N,) which points are reached."""
        reached: NDArray[np.bool_] = self.reasons == ""
        return reached

    def require_all(self, source: object) -> Array:
        """The motor angles, if every point is reached. Raises InputError: names ``source``, the first row that can't
        be reached, and why."""
        missed = np.flatnonzero(~self.reached)
        if len(missed):
            row = int(missed[0])
            place = ", ".join(f"{value:.6g}" for value in self.targets[row] * 1e3)
            raise InputError(
                source,
                f"point {row + 1}",
                f"({place}) mm: {self.reasons[row]}",
                f"every point of a path must be within reach, {len(missed)} of {len(self.reasons)} are not",
                "Move the path, or free a motor that is held.",
            )
        return self.motor_angles


def follow_path(
    arm: Arm,
    targets: ArrayLike,
    start: ArrayLike | None = None,
    held: Mapping[int, float] | None = None,
    largest_step: float = SEARCH.jump_rad,
) -> PathSolution:
    """Motor angles that bring the nominal tool point along ``targets``, each as near as possible to the one before.

    Rows that can't be reached are skipped: the path goes on from the last point that was.

    Args:
        arm: the arm.
        targets: (N, 3) in the base frame, m.
        start: (m,) rad, where the arm comes from; None takes the middle of the limits (0 where there are none).
        held: motors that keep an angle (rad), by their number from 1.
        largest_step: rad; a larger motion of any motor between neighbours is a jump (the way to the first is free).
            Infinite: of points that need not be neighbours, each may have a branch of its own.

    Returns:
        Angles (N, m), rad, NaN where a row can't be reached, with the reason of each such row.
    """
    targets = np.atleast_2d(np.asarray(targets, dtype=float))
    held = dict(held or {})
    solver = _Newton(arm, held)
    q = _with_held(_middle(arm) if start is None else np.asarray(start, dtype=float), held)
    solutions = np.full((len(targets), arm.n_motors), np.nan)
    reasons = np.full(len(targets), "", dtype="<U24")
    skipped, reached_any = 0, False
    for row, target in enumerate(targets):
        found = solver.nearest(target, q) if np.linalg.norm(target) <= arm.reach else None
        if found is None and (not reached_any or np.isinf(largest_step)):
            found = _from_many_starts(arm, target[None], held, q)[0]
            found = None if np.isnan(found).any() else solver.nearest(target, found)
        if found is not None and reached_any and np.abs(found - q).max() > largest_step * (skipped + 1):
            reasons[row] = _jump(found, q)
            found = None
        if found is None:
            skipped += 1
            continue
        solutions[row] = q = found
        skipped, reached_any = 0, True
    unexplained = np.flatnonzero(np.isnan(solutions).any(axis=1) & (reasons == ""))
    reasons[unexplained] = _reasons(arm, targets, solutions, unexplained, held)
    return PathSolution(targets, solutions, reasons)


class _Newton:
    """Least joint motion to one target within the limits, on pinocchio (a few microseconds per step)."""

    def __init__(self, arm: Arm, held: Mapping[int, float]) -> None:
        self.arm = arm
        self.free = np.array([motor + 1 not in held for motor in range(arm.n_motors)])
        self.model = arm.model.copy()
        tip = self.model.frames[self.model.getFrameId(TIP)]
        placement = tip.placement * pin.SE3(np.eye(3), arm.tool)
        self.tool = self.model.addFrame(pin.Frame("tool point", tip.parentJoint, 0, placement, pin.FrameType.OP_FRAME))
        self.data = self.model.createData()
        self.neutral = pin.neutral(self.model)
        self.low, self.high = arm.limits.T

    def nearest(self, target: Array, previous: Array) -> Array | None:
        """The solution nearest to ``previous`` within the limits, or None. Motors that meet a limit stay there."""
        free, q = self.free, np.clip(previous, self.low, self.high)
        for _ in range(self.arm.n_motors):
            found = self._solve(target, q, free)
            if found is None:
                return None
            outside = free & ((found < self.low - SEARCH.no_turn_rad) | (found > self.high + SEARCH.no_turn_rad))
            if not outside.any():
                return found
            q = np.where(outside, np.clip(found, self.low, self.high), q)
            free = free & ~outside
        return None

    def _solve(self, target: Array, previous: Array, free: NDArray[np.bool_]) -> Array | None:
        if not free.any():
            return None
        q, checkpoint = previous.copy(), np.inf
        for iteration in range(SEARCH.steps):
            point, jacobian = self._point_and_jacobian(q)
            gap = target - point
            size = float(np.sqrt(gap @ gap))
            if size < SEARCH.tolerance_m:
                return q
            if iteration % SEARCH.patience == 0:
                if size > checkpoint / 2:
                    return None
                checkpoint = size
            jacobian = jacobian * free
            gram = jacobian @ jacobian.T
            gram.flat[::4] += SEARCH.least_damping
            step = jacobian.T @ np.linalg.solve(gram, gap + jacobian @ (q - previous)) + previous - q
            q = q + step * min(1.0, SEARCH.step_rad / max(SEARCH.no_turn_rad, float(np.abs(step).max())))
        return None

    def _point_and_jacobian(self, q: Array) -> tuple[Array, Array]:
        angles = pin.integrate(self.model, self.neutral, self.arm.actuation @ q)
        jacobian = pin.computeFrameJacobian(
            self.model, self.data, angles, self.tool, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        )
        linear = np.reshape(jacobian, (6, self.model.nv))[:3]
        return pin.updateFramePlacement(self.model, self.data, self.tool).translation, linear @ self.arm.actuation


def _reasons(
    arm: Arm, targets: Array, solutions: Array, missed: Indices, held: Mapping[int, float]
) -> NDArray[np.str_]:
    """Why the rows ``missed`` have no solution: each is tried again from many starts, with and without limits."""
    reasons = np.full(len(missed), BEYOND_REACH, dtype="<U24")
    near = np.flatnonzero(np.linalg.norm(targets[missed], axis=1) <= arm.reach)
    if not len(near):
        return reasons
    before = _last_reached(solutions, missed[near], _middle(arm))
    found = _from_many_starts(arm, targets[missed[near]], held, before)
    for place, solution, previous in zip(near, found, before, strict=True):
        if np.isnan(solution).any():
            continue
        excess = np.maximum(arm.limits[:, 0] - solution, solution - arm.limits[:, 1])
        broken = f"limit of joint {int(np.argmax(excess)) + 1}"
        reasons[place] = broken if excess.max() > SEARCH.broken_limit_rad else _jump(solution, previous)
    return reasons


def _jump(solution: Array, previous: Array) -> str:
    return f"jump of joint {int(np.argmax(np.abs(solution - previous))) + 1}"


def _last_reached(solutions: Array, rows: Indices, start: Array) -> Array:
    good = np.flatnonzero(~np.isnan(solutions).any(axis=1))
    if not len(good):
        return np.tile(start, (len(rows), 1))
    before = np.maximum(np.searchsorted(good, rows) - 1, 0)
    return solutions[good[before]]


def _from_many_starts(arm: Arm, targets: Array, held: Mapping[int, float], near: Array) -> Array:
    """(N, m) a solution for each target that breaks the limits least; NaN where none is found.

    Newton's method starts from the poses nearest to the target in a cloud of poses within the limits and in one without
    limits, and from ``near`` (m,) or (N, m). Among solutions within the limits, the one nearest to ``near`` counts.
    """
    near = np.broadcast_to(near, (len(targets), arm.n_motors))
    clouds = [_with_held(_spread(arm, limits), held) for limits in (arm.limits, np.full_like(arm.limits, np.inf))]
    starts = [near[:, None]]
    for cloud in clouds:
        _, nearest = cKDTree(chain(arm, cloud).tool).query(targets, k=SEARCH.starts_per_cloud)
        starts.append(cloud[nearest])
    q = _with_held(np.concatenate(starts, axis=1), held)
    n_starts = q.shape[1]
    q = _solved(arm, np.repeat(targets, n_starts, axis=0), q.reshape(-1, arm.n_motors), held)
    q = _unwound(arm, q).reshape(len(targets), n_starts, arm.n_motors)
    excess = np.maximum(0, np.maximum(arm.limits[:, 0] - q, q - arm.limits[:, 1])).max(axis=2)
    distance = np.abs(q - near[:, None]).max(axis=2)
    cost = np.nan_to_num(np.where(excess > SEARCH.broken_limit_rad, 1e3 + excess, 0) + distance * 1e-3, nan=np.inf)
    chosen: Array = q[np.arange(len(targets)), np.argmin(cost, axis=1)]
    return chosen


def _solved(arm: Arm, goals: Array, q: Array, held: Mapping[int, float]) -> Array:
    """(N, m) solutions by damped Newton steps from ``q``, limits ignored; NaN for rows that stop coming closer."""
    q, free = q.copy(), np.array([motor + 1 not in held for motor in range(arm.n_motors)])
    at_work, checkpoint = np.arange(len(q)), np.full(len(q), np.inf)
    for iteration in range(1, 4 * SEARCH.steps + 1):
        frames = chain(arm, q[at_work])
        gap = goals[at_work] - frames.tool
        size = np.linalg.norm(gap, axis=1)
        stays = size > SEARCH.tolerance_m
        if iteration % SEARCH.patience == 0:
            stuck = stays & (size > checkpoint[at_work] / 2)
            q[at_work[stuck]] = np.nan
            stays &= ~stuck
            checkpoint[at_work] = size
        jacobian = position_jacobian(arm, frames)[stays] * free
        at_work, gap, size = at_work[stays], gap[stays], size[stays]
        if not len(at_work):
            return q
        q[at_work] += shortened(
            least_turns(jacobian, gap, damping(size, SEARCH.least_damping_of_many)), SEARCH.step_rad
        )
    q[at_work] = np.nan
    return q


def _unwound(arm: Arm, q: Array) -> Array:
    """Whole turns taken off motors that move nothing but their own joint, so that limits are broken by what matters."""
    alone = (np.count_nonzero(arm.actuation, axis=0) == 1) & (np.abs(arm.actuation).max(axis=0) == 1)
    middle = _middle(arm)
    return np.where(alone, q - 2 * np.pi * np.round((q - middle) / (2 * np.pi)), q)


def _spread(arm: Arm, limits: Array) -> Array:
    """Poses spread evenly between limits (half a turn either way where there are none)."""
    from scipy.stats import qmc  # takes half a second: seldom needed

    low, high = np.where(np.isfinite(limits), limits, [-np.pi, np.pi]).T
    return qmc.scale(qmc.Halton(arm.n_motors, scramble=False).random(SEARCH.cloud), low, high)


def _middle(arm: Arm) -> Array:
    limits = np.where(np.isfinite(arm.limits).all(axis=1, keepdims=True), arm.limits, 0.0)
    return np.asarray(limits.mean(axis=1))


def _with_held(q: Array, held: Mapping[int, float]) -> Array:
    q = q.copy()
    for motor, angle in held.items():
        q[..., motor - 1] = angle
    return q
