"""What is the same for every model: a path, the arm that shall follow it, and every reason to refuse a row."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from armscope.compensation.constants import COMMANDS
from armscope.compensation.domain import Domain
from armscope.compensation.forward import Forward, NominalArm
from armscope.compensation.newton import Solution, Wanted, correct, row_pieces, solve_commands
from armscope.compensation.path import Frame, WantedPath, nominal_branch, unit_doubt
from armscope.compensation.reachable import Reachable, reachable_by
from armscope.compensation.result import Compensated
from armscope.core.inputs import InputError
from armscope.core.parallel import piece_by_piece
from armscope.core.types import Array, Indices
from armscope.physics.effect import AXES
from armscope.robot import Arm, tool_frames
from armscope.robot.constants import SEARCH


@dataclass(frozen=True, eq=False)
class Options:
    """How to compensate."""

    # where wanted points and orientations stand: in the arm's base frame, or in the measurement frame
    frame: Frame = "base"
    pose: bool = False  # keep the orientation, too: of the table's quaternions, or of its joint angles
    start_rad: Array | None = None  # (m,) where the arm comes from; None takes the middle of the identified range
    # how far outside the identified range a command may lie, standard deviations; None: as far as poses do that were
    # recorded alike
    allowed_outside: float | None = None
    separate_points: bool = False  # single points, no path: a motor may turn far between neighbouring rows

    @property
    def largest_step(self) -> float:
        """Beyond which a motion of a motor between neighbouring rows is a jump, rad."""
        return np.inf if self.separate_points else SEARCH.jump_rad


@dataclass(frozen=True, eq=False)
class PathTask:
    """A path, the arm that shall follow it, and where its model holds."""

    arm: Arm  # the nominal arm with the tool point that is led along the path
    stated: Arm  # the controller's arm, whose tool point may be another one
    path: WantedPath
    options: Options
    domain: Domain
    forward: Callable[[Array], tuple[Forward, str]]  # the real arm near given nominal postures, and a note about it
    # the domain's inputs at motor angles of some rows, and which rows these are
    domain_inputs: Callable[[Array, Indices], Array]
    # to_base, to_frame: points from the path's frame to the base frame and back
    to_base: Callable[[Array], Array]
    to_frame: Callable[[Array], Array]
    turn: Array  # (N, 3, 3) the path's frame from the base frame

    def run(self, refused: NDArray[np.object_]) -> Compensated:
        """Nominal branch, Newton's method on the real arm from there, every reason to refuse a row."""
        rows = np.arange(len(self.path))
        held = {} if self.options.pose else self._held()
        free = np.array([motor not in held for motor in self._motors])
        can = reachable_by(self.arm, free)
        wanted = replace(self._wanted(refused), reachable=None if can.is_everywhere else can)
        nominal = self._nominal(wanted, held, refused)
        real, note = self.forward(nominal)
        uncorrected, uncorrected_turn, residual_turn = np.full((3, len(rows)), np.nan)
        commands, predicted = np.full_like(nominal, np.nan), np.full((len(rows), 3), np.nan)
        iterations = 0
        possible = np.isfinite(nominal.sum(axis=1)) & np.isfinite(wanted.points.sum(axis=1))
        known = np.flatnonzero(possible & np.equal(refused, ""))
        if len(known):
            pieces = [known[at] for at in row_pieces(len(known))]
            for at, found in zip(
                pieces,
                piece_by_piece(pieces, lambda at: correct(real, wanted.rows(at), nominal[at], free, at)),
                strict=True,
            ):
                uncorrected[at], uncorrected_turn[at] = found.uncorrected, found.uncorrected_turn
                commands[at], predicted[at] = found.solution.angles, found.predicted
                residual_turn[at] = found.residual_turn
                iterations = max(iterations, found.solution.iterations)
                moved = np.abs(found.solution.angles - nominal[at])
                refuse(refused, at[found.pole], self._pole(can))
                self._refuse_unsolved(refused, at, found.solution, moved)
        outside, nearest = self._refuse_outside(refused, commands, unit_doubt(wanted.points, self.arm.reach))
        residual = np.linalg.norm(wanted.points - predicted, axis=1)
        beside = can.left_out_of(wanted.points - predicted)
        refuse(
            refused, beside > COMMANDS.out_of_plane_m, "the arm can't be moved there: no motor leads out of its plane"
        )
        left_out = can.told(beside[refused == ""], self.options.pose)
        for values in (commands, predicted, residual, residual_turn):
            values[refused != ""] = np.nan
        points, turns = self._shown(commands, np.flatnonzero(refused == ""))
        return Compensated(
            self.stated,
            self.path.table.id,
            self.path.table.run,
            refused,
            commands,
            nominal,
            points,
            turns,
            self.to_frame(wanted.points),
            self.to_frame(predicted),
            residual,
            uncorrected,
            residual_turn,
            uncorrected_turn,
            outside,
            nearest,
            self.options.frame,
            self.options.pose,
            iterations,
            tuple(filter(None, (note, left_out))),
            context=self.path.context,
        )

    def _left_out(self, can: Reachable, gap: Array, refused: NDArray[np.object_]) -> str:
        """What commands leave of gaps (N, 3) where the arm can't be moved; far off its plane a row is refused."""
        beside = can.left_out_of(gap)
        refuse(
            refused, beside > COMMANDS.out_of_plane_m, "the arm can't be moved there: no motor leads out of its plane"
        )
        return can.told(beside[refused == ""], self.options.pose)

    def _shown(self, commands: Array, ok: Indices) -> tuple[Array, Array]:
        """Points (N, 3) and orientations (N, 3, 3) that the controller shows under commands; NaN but for some rows."""
        points, turns = np.full((len(commands), 3), np.nan), np.full((len(commands), 3, 3), np.nan)
        for at in (ok[piece] for piece in row_pieces(len(ok))):
            points[at], turns[at] = tool_frames(self.stated, commands[at])
        return points, turns

    def _held(self) -> dict[int, float]:
        """Motors that stood still in the identification data, where enough others can move the tool point."""
        still = {int(name[1:]): angle for name, angle in self.domain.still("rad").items()}
        return still if self.arm.n_motors - len(still) >= 3 else {}

    def _wanted(self, refused: NDArray[np.object_]) -> Wanted:
        """Points and, where asked, orientations in base axes."""
        table, nominal = self.path.table, None
        if self.path.points is None or (self.options.pose and table.orientation is None):
            nominal = tool_frames(self.arm, table.motor_angles)
        points = nominal[0] if self.path.points is None and nominal else self.to_base(_given(self.path.points))
        if not self.options.pose:
            return Wanted(points)
        if table.orientation is None:
            if not self.path.has_angles:
                raise InputError(
                    table.source, "line 1", "no columns qw, qx, qy, qz", "a full pose needs an orientation",
                    "Add them, or leave the orientation free.",
                )  # fmt: skip
            assert nominal is not None
            return Wanted(points, nominal[1])
        unknown = ~table.oriented
        refuse(refused, unknown, "no orientation")
        quaternions = np.where(unknown[:, None], [1.0, 0, 0, 0], table.orientation)
        given = Rotation.from_quat(quaternions, scalar_first=True).as_matrix()
        return Wanted(points, np.swapaxes(self.turn, 1, 2) @ given)

    def _nominal(self, wanted: Wanted, held: dict[int, float], refused: NDArray[np.object_]) -> Array:
        """(N, m) postures of the nominal arm; NaN and a reason where there are none."""
        if self.path.has_angles:
            angles = self.path.table.motor_angles.copy()
            self._refuse_beyond_limits(refused, angles)
            return angles if self.path.points is None else self._nearest(wanted, angles, held, refused)
        start = self.options.start_rad
        if start is None:
            middle = [self.domain.value(f"q{j}") if f"q{j}" in self.domain.inputs else np.nan for j in self._motors]
            limits = np.where(np.isfinite(self.arm.limits).all(axis=1), np.nan_to_num(self.arm.limits).mean(axis=1), 0)
            start = np.where(np.isnan(middle), limits, middle)
        branch = nominal_branch(self.arm, wanted, start, held, self.options.largest_step)
        doubt = unit_doubt(wanted.points, self.arm.reach)
        for reason in np.unique(branch.reasons[~branch.reached]):
            refuse(
                refused, np.flatnonzero(branch.reasons == reason), str(reason) + (doubt if "reach" in reason else "")
            )
        return branch.motor_angles

    def _nearest(self, wanted: Wanted, angles: Array, held: dict[int, float], refused: NDArray[np.object_]) -> Array:
        """(N, m) nominal postures at the wanted points nearest to given ones."""
        free = np.array([motor not in held for motor in self._motors])
        rows = np.flatnonzero(np.isfinite(wanted.points.sum(axis=1)) & np.equal(refused, ""))
        if not len(rows):
            return angles
        solution = solve_commands(NominalArm(self.arm), wanted.rows(rows), angles[rows], free, rows)
        angles[rows] = solution.angles
        _refuse_at_limits(refused, rows, solution)
        refuse(refused, rows[~solution.converged], "beyond reach on the branch of the given angles")
        return angles

    @property
    def _motors(self) -> range:
        return range(1, self.arm.n_motors + 1)

    def _refuse_beyond_limits(self, refused: NDArray[np.object_], angles: Array) -> None:
        (low, high), slack = self.arm.limits.T, SEARCH.broken_limit_rad
        for motor in self._motors:
            angle = angles[:, motor - 1]
            beyond = (angle < low[motor - 1] - slack) | (angle > high[motor - 1] + slack)
            refuse(refused, beyond, f"limit of joint {motor}")

    def _pole(self, can: Reachable) -> str:
        """What a row is refused for whose tool can't be led as is asked."""
        if not self.options.pose:
            return "pole: the tool can't be moved in all directions"
        few = can.is_everywhere and self.arm.n_motors < len(AXES)
        too_few = f"{self.arm.n_motors} motors can't set every orientation: leave it free (without --pose)"
        return too_few if few else "pole of the wrist"

    def _refuse_unsolved(self, refused: NDArray[np.object_], known: Indices, solution: Solution, moved: Array) -> None:
        _refuse_at_limits(refused, known, solution)
        refuse(refused, known[~solution.converged], "no command found: the real arm can't get there")
        worst = np.argmax(moved, axis=1)
        for row in np.flatnonzero(moved.max(axis=1) > COMMANDS.correction_rad):
            size = np.degrees(moved[row, worst[row]])
            text = f"the correction turns joint {worst[row] + 1} by {size:.1f} degrees: close to a pole"
            refused[known[row]] = refused[known[row]] or text

    def _refuse_outside(self, refused: NDArray[np.object_], commands: Array, doubt: str) -> tuple[Array, Array]:
        """Distances (N,) from the identified range and from the nearest identification row.

        ``doubt`` is what `unit_doubt` says about the path.
        """
        outside, nearest = np.full(len(commands), np.nan), np.full(len(commands), np.nan)
        solved = np.flatnonzero(np.isfinite(commands.sum(axis=1)))
        allowed = self.domain.allowed if self.options.allowed_outside is None else self.options.allowed_outside
        pieces = [solved[piece] for piece in row_pieces(len(solved))]

        def looked_up(rows: Indices) -> tuple[Array, NDArray[np.object_], Array]:
            inputs = self.domain_inputs(commands[rows], rows)
            return *self.domain.outside(inputs), self.domain.nearest(inputs)

        for rows, found in zip(pieces, piece_by_piece(pieces, looked_up), strict=True):
            outside[rows], label, nearest[rows] = found
            for at in np.flatnonzero(outside[rows] > allowed):
                row = rows[at]
                text = (
                    f"outside the identified range: {label[at]} by {outside[row]:.2g} standard deviations, "
                    f"{allowed:.2g} allowed{doubt}"
                )
                refused[row] = refused[row] or text
        return outside, nearest


def _given(points: Array | None) -> Array:
    assert points is not None
    return points


def refuse(refused: NDArray[np.object_], rows: NDArray[np.bool_] | Indices, reason: str) -> None:
    """Refuse rows that are not refused yet: the first reason of a row stays.

    Args:
        refused: (N,) reasons, "" for none; changed in place.
        rows: which.
        reason: why.
    """
    which = np.zeros(len(refused), dtype=bool)
    which[rows] = True
    refused[np.flatnonzero(which & np.equal(refused, ""))] = reason


def _refuse_at_limits(refused: NDArray[np.object_], rows: Indices, solution: Solution) -> None:
    """The rows whose solution ends at a joint's limit."""
    for motor in np.unique(solution.limit[solution.limit > 0]):
        refuse(refused, rows[solution.limit == motor], f"limit of joint {motor}")
