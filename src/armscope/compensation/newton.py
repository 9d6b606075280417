"""Newton's method for all rows of a path at once: the command nearest to a start under which a tool is where it should.

Each row solves min |q - q0|^2 subject to f(q) = wanted, as `armscope.robot.inverse` does, on the given forward model:

    q <- q0 + J+ (wanted - f(q) + J (q - q0)),    J+ = J' (J J')^-1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from armscope.compensation.constants import COMMANDS
from armscope.compensation.forward import Forward, Rows, ToolPose
from armscope.compensation.reachable import Reachable
from armscope.core.parallel import each_piece
from armscope.core.types import Array, Indices
from armscope.robot.constants import SEARCH
from armscope.robot.newton_steps import damping, least_turns, shortened, smallest_singular_value


@dataclass(frozen=True, eq=False)
class Wanted:
    """Where the tool should be, N rows in base axes."""

    points: Array  # (N, 3) m
    rotations: Array | None = None  # (N, 3, 3) of the last frame, or None where the orientation is free
    reachable: Reachable | None = None  # directions in which the arm can be led; None for all

    def __len__(self) -> int:
        return len(self.points)

    def rows(self, which: Rows | NDArray[np.bool_]) -> Wanted:
        """Some of the rows."""
        rotations = None if self.rotations is None else self.rotations[which]
        return Wanted(self.points[which], rotations, self.reachable)

    def gap(self, pose: ToolPose, lever: float) -> Array:
        """(N, 3 or 6) what is missing: displacement (m) and turn times ``lever`` (m); fewer where it can't be had."""
        gap = self.points - pose.points
        turn = None if self.rotations is None else lever * self.turn(pose)
        if self.reachable is not None:
            gap = gap @ self.reachable.shifts.T
            turn = None if turn is None else turn @ self.reachable.turns.T
        return gap if turn is None else np.concatenate([gap, turn], axis=1)

    def turn(self, pose: ToolPose) -> Array:
        """(N, 3) the rotation vector that is missing, rad, base axes; NaN where the orientation is free."""
        if self.rotations is None:
            return np.full((len(self.points), 3), np.nan)
        return Rotation.from_matrix(self.rotations @ np.swapaxes(pose.rotations, 1, 2)).as_rotvec()

    def jacobian(self, pose: ToolPose, lever: float) -> Array:
        """(N, 3 or 6, m) how the gap closes by unit turns of the motors, m/rad."""
        moved, turned = pose.jacobian[:, :3], lever * pose.jacobian[:, 3:]
        if self.reachable is not None:
            moved, turned = self.reachable.shifts @ moved, self.reachable.turns @ turned
        return moved if self.rotations is None else np.concatenate([moved, turned], axis=1)


@dataclass(frozen=True, eq=False)
class Solution:
    """Commands for N rows."""

    angles: Array  # (N, m) rad; the last iterate where not converged
    converged: NDArray[np.bool_]  # (N,) whether the tool is where it should be (1e-9 m; turns by the arm's lever)
    limit: Indices  # (N,) number of a motor (from 1) whose limit the row would break; 0 for none
    singular: Array  # (N,) smallest singular value of the scaled Jacobian (m/rad over the lever)
    iterations: int  # of the row that took most


def weakest(wanted: Wanted, pose: ToolPose, free: NDArray[np.bool_], arm_lever: float) -> Array:
    """(N,) smallest singular value of the scaled Jacobian: what a unit turn of the motors moves the tool at least.

    Args:
        wanted: N rows.
        pose: the arm where it is.
        free: (m,) motors that may move.
        arm_lever: m that a radian of the tool's turn counts as.

    Returns:
        (N,) m per rad; near 0 the row is singular.
    """
    return smallest_singular_value(wanted.jacobian(pose, arm_lever) * free) / arm_lever


def lever(forward: Forward) -> float:
    """By how many metres a radian of turn counts: a quarter of the arm's reach."""
    return COMMANDS.lever * forward.arm.reach


def solve_commands(
    forward: Forward, wanted: Wanted, start: Array, free: NDArray[np.bool_], rows: Rows | None = None
) -> Solution:
    """The commands nearest to ``start`` (N, m) rad that bring the tool to ``wanted``, within the joint limits.

    A motor that would break its limit is put there, and the others solve again; a row is given up when no motor is left
    or the rest can't reach.

    Args:
        forward: the arm.
        wanted: N rows.
        start: (N, m) rad.
        free: (m,) motors that may move.
        rows: (N,) their row numbers in the path; None counts from 0.

    Returns:
        Angles (N, m), rad, which rows converged, the motor whose limit stopped a row, how near a singularity each is.
    """
    rows = np.arange(len(wanted)) if rows is None else rows
    found = each_piece(row_pieces(len(wanted)), lambda at: _solved(forward, wanted.rows(at), start[at], free, rows[at]))
    return Solution(
        np.concatenate([each.angles for each in found]),
        np.concatenate([each.converged for each in found]),
        np.concatenate([each.limit for each in found]),
        np.concatenate([each.singular for each in found]),
        max(each.iterations for each in found),
    )


def row_pieces(count: int) -> list[Indices]:
    """Numbers of all rows, some at a time; one empty piece where there are none."""
    return np.array_split(np.arange(count), max(1, -(-count // COMMANDS.rows_at_a_time)))


def _solved(forward: Forward, wanted: Wanted, start: Array, free: NDArray[np.bool_], rows: Rows) -> Solution:
    low, high = forward.arm.limits.T
    moves = np.tile(free, (len(wanted), 1))
    origin, limit = start.copy(), np.zeros(len(wanted), dtype=np.intp)
    angles, converged, singular, steps = _iterate(forward, wanted, origin, moves, rows)
    for _ in range(forward.arm.n_motors):
        excess = np.maximum(low - angles, angles - high)
        broken = np.flatnonzero(((excess > SEARCH.no_turn_rad) & moves).any(axis=1) & converged)
        if not len(broken):
            break
        over = (excess[broken] > SEARCH.no_turn_rad) & moves[broken]
        limit[broken] = np.argmax(np.where(over, excess[broken], -np.inf), axis=1) + 1
        origin[broken] = np.where(over, np.clip(angles[broken], low, high), origin[broken])
        moves[broken] &= ~over
        again = _iterate(forward, wanted.rows(broken), origin[broken], moves[broken], rows[broken])
        angles[broken], converged[broken], singular[broken] = again[:3]
        steps = max(steps, again[3])
    return Solution(angles, converged, np.where(converged, 0, limit), singular, steps)


def _iterate(
    forward: Forward, wanted: Wanted, origin: Array, moves: NDArray[np.bool_], rows: Rows
) -> tuple[Array, NDArray[np.bool_], Array, int]:
    """Angles, converged, smallest singular value, steps."""
    arm_lever, angles = lever(forward), origin.copy()
    converged, singular = np.zeros(len(wanted), dtype=bool), np.zeros(len(wanted))
    at_work, best, steps = np.arange(len(wanted)), np.full(len(wanted), np.inf), 0
    for steps in range(COMMANDS.steps + 1):
        here = wanted.rows(at_work)
        pose = forward.at(angles[at_work], rows[at_work])
        gap = here.gap(pose, arm_lever)
        jacobian = here.jacobian(pose, arm_lever) * moves[at_work][:, None, :]
        size = np.linalg.norm(gap, axis=1)
        done = size < SEARCH.tolerance_m
        singular[at_work[done]] = smallest_singular_value(jacobian[done]) / arm_lever
        converged[at_work[done]] = True
        stuck = np.zeros(len(at_work), dtype=bool)
        if steps % SEARCH.patience == 0:
            stuck = size > best[at_work] / 2
            best[at_work] = size
        stays = ~done & ~stuck & np.isfinite(size)
        at_work = at_work[stays]
        if not len(at_work) or steps == COMMANDS.steps:
            break
        gap, jacobian = gap[stays], jacobian[stays]
        back = angles[at_work] - origin[at_work]
        goal = gap + np.einsum("nij,nj->ni", jacobian, back)
        step = least_turns(jacobian, goal, damping(size[stays], SEARCH.least_damping)) - back * moves[at_work]
        angles[at_work] += shortened(step, COMMANDS.step_rad)
    return angles, converged, singular, steps


@dataclass(frozen=True, eq=False)
class Corrected:
    """What `correct` finds for n rows: m and rad as in `Compensated`; ``pole`` (n,) where the arm can't be led."""

    uncorrected: Array
    uncorrected_turn: Array
    solution: Solution
    predicted: Array
    residual_turn: Array
    pole: NDArray[np.bool_]


def correct(real: Forward, wanted: Wanted, nominal: Array, free: NDArray[np.bool_], rows: Indices) -> Corrected:
    """Some rows of a path: where the real arm would be at the nominal posture, and the commands that put it right.

    Args:
        real: the arm.
        wanted: n points, or full poses, base axes.
        nominal: (n, m) rad, the nominal posture.
        free: (m,) motors that may move.
        rows: (n,) their numbers in the path.

    Returns:
        Commands and misses with and without them.
    """
    before = real.at(nominal, rows)
    solution = solve_commands(real, wanted, nominal, free, rows)
    at_start = weakest(wanted, before, free, lever(real))
    after = real.at(solution.angles, rows)
    return Corrected(
        np.linalg.norm(wanted.points - before.points, axis=1),
        np.linalg.norm(wanted.turn(before), axis=1),
        solution,
        after.points,
        np.linalg.norm(wanted.turn(after), axis=1),
        np.where(solution.converged, solution.singular, at_start) < COMMANDS.pole,
    )
