"""False targets: the commands under which the real arm reaches the wanted points, row by row, or why there are none."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from armscope.compensation.black_box import ErrorModel, domain_inputs
from armscope.compensation.branch import nominal_branch
from armscope.compensation.correction import correct
from armscope.compensation.domain import ALLOWED, Domain
from armscope.compensation.forward import BlackBoxArm, Forward, NominalArm, PhysicalArm
from armscope.compensation.newton import Solution, Wanted, row_pieces, solve_commands
from armscope.compensation.path import Frame, WantedPath, unit_doubt
from armscope.compensation.physical import (
    Identified,
    beyond_time,
    missing_context,
    with_empty_context,
    with_measured_tool,
    with_torques,
)
from armscope.compensation.result import Compensated
from armscope.core.inputs import InputError
from armscope.core.parallel import each_piece
from armscope.core.types import Array
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings
from armscope.robot import Arm, tool_frames
from armscope.robot.inverse import LARGEST_STEP_RAD

LARGEST_CORRECTION_RAD = np.radians(3)
"""Errors of millimetres never ask for more, unless the arm is close to a pole."""


@dataclass(frozen=True, eq=False)
class Options:
    """How to compensate.

    Attributes:
        frame: where wanted points and orientations stand: in the arm's base frame, or in the measurement frame.
        pose: keep the orientation, too: of the table's quaternions, or of its joint angles.
        start: (m,) rad, where the arm comes from; None takes the middle of the identified range.
        allowed: how far outside the identified range a command may lie, standard deviations.
        largest_step: rad; a larger motion of a motor between neighbouring rows is a jump.
    """

    frame: Frame = "base"
    pose: bool = False
    start: Array | None = None
    allowed: float = ALLOWED
    largest_step: float = LARGEST_STEP_RAD


def compensate_black_box(model: ErrorModel, path: WantedPath, options: Options | None = None) -> Compensated:
    """Commands by a black-box error model.

    Motors that stood still when the model was identified keep their angles. With ``pose`` the orientation is corrected,
    too, if the model was fitted to orientations; otherwise it says nothing about them, and the nominal one is kept.

    Args:
        model: fitted by `fit_error_model`, or read from a file.
        path: wanted points, or angles that stand for them.
        options: frame, pose and limits; None takes the defaults.

    Returns:
        Commands (N, m), rad, with what they will reach, which rows can't be had, and why.

    Raises:
        InputError: a path of another arm, or options that the path can't serve.
    """
    options = options or Options()
    _check_arm(model.arm, path.table)
    rotation, translation = np.eye(3), np.zeros(3)
    if options.frame == "measurement":
        rotation, translation = model.base.rotation, model.base.translation
    task = _Task(
        model.arm,
        model.arm,
        path,
        options,
        model.domain,
        forward=lambda nominal: (BlackBoxArm(model), ""),
        domain_inputs=lambda angles: domain_inputs(model, angles),
        to_base=lambda points: (points - translation) @ rotation,
        to_frame=lambda points: points @ rotation.T + translation,
        turn=np.tile(rotation, (len(path), 1, 1)),
    )
    result = task.run(np.full(len(path), "", dtype=object))
    if options.pose and model.turning is None:
        note = "the model was fitted to positions only: orientations are kept as the nominal arm has them"
        return replace(result, notes=(*result.notes, note))
    return result


def compensate_physical(
    model: FittedModel, identified: Identified, path: WantedPath, options: Options | None = None
) -> Compensated:
    """Commands by diagnosed physics, every effect in place, in the context of each row.

    In the base frame the point that is brought to the wanted one is the real place of the measured tool point; in the
    measurement frame it is what the instrument would read there (its scale error included).

    Args:
        model: of a diagnosis.
        identified: the rows on which it was identified: ranges and context.
        path: wanted points with the context that the model follows, or angles that stand for them.
        options: frame, pose and limits; None takes the defaults.

    Returns:
        Commands (N, m), rad, with what they will reach, which rows can't be had, and why.

    Raises:
        InputError: a path of another arm, or options that the path can't serve.
    """
    options = options or Options()
    _check_arm(model.arm, path.table)
    if identified.arm != model.arm.name:
        rule = f"the model is of {model.arm.name!r}"
        raise InputError("domain", "robot", identified.arm, rule, "These files do not belong together.")
    rows, refused, notes = _named(model, path.table)
    for column, missing in missing_context(model, identified, rows).items():
        _refuse(refused, missing, f"no {column}, which the model follows")
    _refuse(
        refused, beyond_time(model, identified, rows), "outside the identified range: time_s, which a drift follows"
    )
    rows = with_empty_context(rows)
    measured = options.frame == "measurement"

    def forward(nominal: Array) -> tuple[Forward, str]:
        with_load, note = with_torques(model, identified, rows, nominal)
        return PhysicalArm(model, with_load, measured), note

    task = _Task(
        with_measured_tool(model, rows),
        model.arm,
        replace(path, table=rows),
        options,
        identified.domain,
        forward=forward,
        domain_inputs=lambda angles: identified.inputs(angles, rows),
        to_base=(lambda points: model.to_base(points, rows.run)) if measured else _same,
        to_frame=(lambda points: model.to_measurement(points, rows.run)) if measured else _same,
        turn=model.base_turns(rows.run) if measured else np.broadcast_to(np.eye(3), (len(rows), 3, 3)),
    )
    result = task.run(refused)
    return replace(result, notes=(*notes, *result.notes))


@dataclass(frozen=True, eq=False)
class _Task:
    """A path, the arm that shall follow it, and where its model holds.

    Attributes:
        arm: the nominal arm with the tool point that is led along the path.
        stated: the controller's arm, whose tool point may be another one.
        forward: the real arm near given nominal postures, and a note about it.
        domain_inputs: the domain's inputs at motor angles of all rows.
        to_base, to_frame: points from the path's frame to the base frame and back.
        turn: (N, 3, 3) the path's frame from the base frame.
    """

    arm: Arm
    stated: Arm
    path: WantedPath
    options: Options
    domain: Domain
    forward: Callable[[Array], tuple[Forward, str]]
    domain_inputs: Callable[[Array], Array]
    to_base: Callable[[Array], Array]
    to_frame: Callable[[Array], Array]
    turn: Array

    def run(self, refused: NDArray[np.object_]) -> Compensated:
        """Nominal branch, Newton's method on the real arm from there, every reason to refuse a row."""
        rows = np.arange(len(self.path))
        held = {} if self.options.pose else self._held()
        wanted = self._wanted(refused)
        nominal = self._nominal(wanted, held, refused)
        real, note = self.forward(nominal)
        free = np.array([motor + 1 not in held for motor in range(self.arm.n_motors)])
        uncorrected, uncorrected_turn, residual_turn = np.full((3, len(rows)), np.nan)
        commands, predicted = np.full_like(nominal, np.nan), np.full((len(rows), 3), np.nan)
        iterations = 0
        possible = np.isfinite(nominal.sum(axis=1)) & np.isfinite(wanted.points.sum(axis=1))
        known = np.flatnonzero(possible & np.equal(refused, ""))
        if len(known):
            pieces = [known[at] for at in row_pieces(len(known))]
            for at, found in zip(
                pieces,
                each_piece(pieces, lambda at: correct(real, wanted.rows(at), nominal[at], free, at)),
                strict=True,
            ):
                uncorrected[at], uncorrected_turn[at] = found.uncorrected, found.uncorrected_turn
                commands[at], predicted[at] = found.solution.angles, found.predicted
                residual_turn[at] = found.residual_turn
                iterations = max(iterations, found.solution.iterations)
                moved = np.abs(found.solution.angles - nominal[at])
                self._refuse_unsolved(refused, at, found.solution, moved, found.pole)
        outside, nearest = self._refuse_outside(refused, commands, unit_doubt(wanted.points, self.arm.reach))
        reasons = np.asarray(refused, dtype=str)
        residual = np.linalg.norm(wanted.points - predicted, axis=1)
        for values in (commands, predicted, residual, residual_turn):
            values[reasons != ""] = np.nan
        ok = np.flatnonzero(reasons == "")
        points, turns = np.full((len(rows), 3), np.nan), np.full((len(rows), 3, 3), np.nan)
        if len(ok):
            points[ok], turns[ok] = tool_frames(self.stated, commands[ok])
        return Compensated(
            self.stated,
            self.path.table.id,
            self.path.table.run,
            reasons,
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
            (note,) if note else (),
        )

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
        _refuse(refused, unknown, "no orientation")
        quaternions = np.where(unknown[:, None], [1.0, 0, 0, 0], table.orientation)
        given = Rotation.from_quat(quaternions, scalar_first=True).as_matrix()
        return Wanted(points, np.swapaxes(self.turn, 1, 2) @ given)

    def _nominal(self, wanted: Wanted, held: dict[int, float], refused: NDArray[np.object_]) -> Array:
        """(N, m) postures of the nominal arm; NaN and a reason where there are none."""
        if self.path.has_angles:
            angles = self.path.table.motor_angles.copy()
            self._refuse_beyond_limits(refused, angles)
            return angles if self.path.points is None else self._nearest(wanted, angles, held, refused)
        start = self.options.start
        if start is None:
            middle = [self.domain.value(f"q{j}") if f"q{j}" in self.domain.names else np.nan for j in self._motors]
            limits = np.where(np.isfinite(self.arm.limits).all(axis=1), np.nan_to_num(self.arm.limits).mean(axis=1), 0)
            start = np.where(np.isnan(middle), limits, middle)
        branch = nominal_branch(self.arm, wanted, start, held, self.options.largest_step)
        doubt = unit_doubt(wanted.points, self.arm.reach)
        for reason in np.unique(branch.reasons[~branch.reached]):
            _refuse(
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
        for motor in np.unique(solution.limit[solution.limit > 0]):
            _refuse(refused, rows[solution.limit == motor], f"limit of joint {motor}")
        _refuse(refused, rows[~solution.converged], "beyond reach on the branch of the given angles")
        return angles

    @property
    def _motors(self) -> range:
        return range(1, self.arm.n_motors + 1)

    def _refuse_beyond_limits(self, refused: NDArray[np.object_], angles: Array) -> None:
        low, high = self.arm.limits.T
        for motor in self._motors:
            beyond = (angles[:, motor - 1] < low[motor - 1] - 1e-9) | (angles[:, motor - 1] > high[motor - 1] + 1e-9)
            _refuse(refused, beyond, f"limit of joint {motor}")

    def _refuse_unsolved(
        self,
        refused: NDArray[np.object_],
        known: NDArray[np.intp],
        solution: Solution,
        moved: Array,
        pole: NDArray[np.bool_],
    ) -> None:
        named = "pole of the wrist" if self.options.pose else "pole: the tool can't be moved in all directions"
        _refuse(refused, known[pole], named)
        for motor in np.unique(solution.limit[solution.limit > 0]):
            _refuse(refused, known[solution.limit == motor], f"limit of joint {motor}")
        _refuse(refused, known[~solution.converged], "no command found: the real arm can't get there")
        worst = np.argmax(moved, axis=1)
        for row in np.flatnonzero(moved.max(axis=1) > LARGEST_CORRECTION_RAD):
            size = np.degrees(moved[row, worst[row]])
            text = f"the correction turns joint {worst[row] + 1} by {size:.1f} degrees: close to a pole"
            refused[known[row]] = refused[known[row]] or text

    def _refuse_outside(self, refused: NDArray[np.object_], commands: Array, doubt: str) -> tuple[Array, Array]:
        """Distances (N,) from the identified range and from the nearest identification row.

        ``doubt`` is what `unit_doubt` says about the path.
        """
        outside, nearest = np.full(len(commands), np.nan), np.full(len(commands), np.nan)
        solved = np.isfinite(commands.sum(axis=1))
        if not solved.any():
            return outside, nearest
        inputs = self.domain_inputs(np.where(solved[:, None], commands, 0.0))[solved]
        outside[solved], label = self.domain.outside(inputs)
        nearest[solved] = self.domain.nearest(inputs)
        where = np.flatnonzero(solved)
        for row, name in zip(where, label, strict=True):
            if outside[row] > self.options.allowed:
                text = f"outside the identified range: {name} by {outside[row]:.2g} standard deviations{doubt}"
                refused[row] = refused[row] or text
        return outside, nearest


def _same(points: Array) -> Array:
    return points


def _given(points: Array | None) -> Array:
    assert points is not None
    return points


def _refuse(refused: NDArray[np.object_], rows: NDArray[np.bool_] | NDArray[np.intp], reason: str) -> None:
    """The first reason of a row stays."""
    which = np.zeros(len(refused), dtype=bool)
    which[rows] = True
    refused[np.flatnonzero(which & np.equal(refused, ""))] = reason


def _check_arm(arm: Arm, rows: Recordings) -> None:
    if rows.n_motors != arm.n_motors:
        raise InputError(
            rows.source,
            "line 1",
            f"{rows.n_motors} motor angles",
            f"{arm.name} has {arm.n_motors} motors",
            "Is this the right model for the path?",
        )


def _named(model: FittedModel, rows: Recordings) -> tuple[Recordings, NDArray[np.object_], tuple[str, ...]]:
    """Rows whose run and target the model knows, refusals for the others, and what was filled in.

    A path without runs is meant for the set-up as it was last; without targets, for the only one there is.
    """
    refused, notes = np.full(len(rows), "", dtype=object), []
    run, target = rows.run.astype(object), rows.target.astype(object)
    if "" not in model.bases and (run == "").any():
        last = list(model.bases)[-1]
        run[run == ""] = last
        notes += [f"rows without a run are taken as of run {last!r}"] if len(model.bases) > 1 else []
    for name in sorted(set(run) - set(model.bases)):
        _refuse(refused, np.flatnonzero(run == name), f"run {name!r} is not in the model")
    targets = sorted({str(part.placed.variant) for part in model.tools})
    if targets and "" not in targets and (target == "").any():
        if len(targets) == 1:
            target[target == ""] = targets[0]
        else:
            _refuse(refused, np.flatnonzero(target == ""), f"no target; the model knows {', '.join(targets)}")
    for name in sorted(set(target) - set(targets)) if targets else ():
        _refuse(refused, np.flatnonzero(target == name), f"target {name!r} is not in the model")
    known = np.isin(run, list(model.bases))
    filled = np.where(known, run, list(model.bases)[-1])
    return replace(rows, run=filled.astype(str), target=target.astype(str)), refused, tuple(notes)
