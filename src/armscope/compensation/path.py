"""A path as a user wants it, with whatever context the model follows, and the nominal arm's continuous way along it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from armscope.compensation.constants import BRANCH, COMMANDS, REFUSED
from armscope.compensation.forward import NominalArm
from armscope.compensation.newton import Wanted, solve_commands
from armscope.core.inputs import InputError
from armscope.core.types import Array, Indices
from armscope.recordings import Recordings
from armscope.recordings.table import as_recordings
from armscope.recordings.textfile import read_text_table
from armscope.robot import Arm
from armscope.robot.constants import SEARCH
from armscope.robot.inverse import BEYOND_REACH, PathSolution, follow_path

if TYPE_CHECKING:
    import pandas as pd  # slow to import


Frame = Literal["base", "measurement"]


@dataclass(frozen=True, eq=False)
class WantedPath:
    """N rows of a path."""

    # the rows as recordings without measurements: angles (where given), context, runs, targets, orientations
    table: Recordings
    # (N, 3) wanted points, m, in `frame`; None for a joint path: where the nominal arm's tool would be
    points: Array | None
    has_angles: bool  # whether the table gives motor angles: the wanted posture, or the branch to solve on

    def __len__(self) -> int:
        return len(self.table)

    @property
    def context(self) -> dict[str, Array]:
        """(N,) columns of load, temperature and sides of approach, by name: what a command is for."""
        table = self.table
        sides = () if table.approach is None else table.approach.T
        told = {"payload_kg": table.payload, "temperature_c": table.temperature}
        told |= {f"approach{motor}": side for motor, side in enumerate(sides, start=1)}
        return {name: values for name, values in told.items() if values is not None}


def read_path(path: Path | str, arm: Arm) -> WantedPath:
    """Read a path table: x_mm, y_mm, z_mm (or _m), or q1_rad ... (or _deg), or both.

    With both, the points are wanted and the angles say on which branch (elbow up or down, wrist flipped or not).

    Raises:
        InputError: names file, row, column, the value found, the rule and the cure.
    """
    return as_path(read_text_table(Path(path), lambda header: _given(header, path)), path, arm)


def as_path(table: pd.DataFrame, source: Path | str, arm: Arm) -> WantedPath:
    """A table as a path; see `read_path`.

    Args:
        table: with points x_mm, y_mm, z_mm, or motor angles, and context.
        source: where it was read, for errors.
        arm: the nominal arm.

    Returns:
        The wanted path.

    Raises:
        InputError: as `read_path`.
    """
    has_angles, has_points = _given(table.columns, source)
    if not has_angles:
        table = table.assign(**{f"q{motor}_rad": 0.0 for motor in range(1, arm.n_motors + 1)})
    rows = as_recordings(table, source, arm.n_motors, measured=has_points)
    rows = replace(rows, number=np.full(len(rows), np.nan))  # a path is of now
    return WantedPath(rows, rows.positions if has_points else None, has_angles)


def _given(columns: Iterable[str], source: Path | str) -> tuple[bool, bool]:
    """Whether a table has motor angles, and whether it has points."""
    names = list(map(str, columns))
    has_angles = any(f"q{motor}_{unit}" in names for motor in range(1, 10) for unit in ("rad", "deg"))
    has_points = any(f"{axis}_{unit}" in names for axis in "xyz" for unit in ("mm", "m"))
    if not has_angles and not has_points:
        rule = "a path has x_mm, y_mm, z_mm (or _m), or q1_rad, q2_rad, ... (or _deg)"
        found = ", ".join(names[: REFUSED.columns_named])
        raise InputError(source, "line 1", found, rule, "The unit is part of the column's name.")
    return has_angles, has_points


def unit_doubt(points: Array, reach: float) -> str:
    """A hint that lengths may be in another unit than the column's name says; "" without doubt."""
    far = float(np.median(np.linalg.norm(points, axis=1)))
    if far > REFUSED.far * reach:
        return f"; the points lie {far:.4g} m away: are they millimetres in columns called _m?"
    if far < reach / REFUSED.near:
        return f"; the points lie {far * 1e3:.3g} mm from the base: are they metres in columns called _mm?"
    return ""


def nominal_branch(
    arm: Arm,
    wanted: Wanted,
    start: Array,
    held: Mapping[int, float] | None = None,
    largest_step: float = SEARCH.jump_rad,
) -> PathSolution:
    """Motor angles of the nominal arm along a path, each as near as possible to the one before.

    Args:
        arm: the arm.
        wanted: N points, or full poses.
        start: (m,) rad, where the arm comes from.
        held: motors that keep an angle, by their number from 1.
        largest_step: rad; a larger motion of any motor between neighbours is a jump; infinite: none is.

    Returns:
        Angles and reasons as `follow_path` gives them; a full pose may also fail with "wrist pole".
    """
    held = dict(held or {})
    stride = -(-len(wanted) // (BRANCH.points if wanted.rotations is None else BRANCH.poses))
    if stride > 1:
        knots = np.unique(np.append(np.arange(0, len(wanted), stride), len(wanted) - 1))
        coarse = _point_by_point(arm, wanted.rows(knots), start, held, largest_step * stride)
        if coarse.reached.all():
            angles = _between(arm, wanted, knots, coarse.motor_angles, held)
            if angles is not None and np.abs(np.diff(angles, axis=0)).max() <= largest_step:
                return PathSolution(wanted.points, angles, np.full(len(wanted), "", dtype="<U24"))
    return _point_by_point(arm, wanted, start, held, largest_step)


def _point_by_point(
    arm: Arm, wanted: Wanted, start: Array, held: Mapping[int, float], largest_step: float
) -> PathSolution:
    if wanted.rotations is None and wanted.reachable is None:
        return follow_path(arm, wanted.points, start, held, largest_step)
    return _follow_poses(arm, wanted, start, held, largest_step)


def _between(arm: Arm, wanted: Wanted, knots: Indices, at_knots: Array, held: Mapping[int, float]) -> Array | None:
    """All rows' angles from those at the knots; None where a row does not converge."""
    rows = np.arange(len(wanted))
    start = np.column_stack([np.interp(rows, knots, column) for column in at_knots.T])
    solution = solve_commands(NominalArm(arm), wanted, start, _free(arm, held))
    return solution.angles if solution.converged.all() else None


def _follow_poses(
    arm: Arm, wanted: Wanted, start: Array, held: Mapping[int, float], largest_step: float
) -> PathSolution:
    """Full poses one after the other, as `follow_path` does for points."""
    nominal, free = NominalArm(arm), _free(arm, held)
    q = start.copy()
    for motor, angle in held.items():
        q[motor - 1] = angle
    angles = np.full((len(wanted), arm.n_motors), np.nan)
    reasons = np.full(len(wanted), "", dtype="<U24")
    skipped, reached_any = 0, False
    for row in range(len(wanted)):
        target = wanted.rows(np.array([row]))
        found, why = _one_pose(nominal, target, q, free)
        if found is None and (not reached_any or np.isinf(largest_step)):
            found, why = _from_many_starts(nominal, target, q, free)
        if found is not None and reached_any and np.abs(found - q).max() > largest_step * (skipped + 1):
            why = f"jump of joint {int(np.argmax(np.abs(found - q))) + 1}"
            found = None
        if found is None:
            reasons[row], skipped = why, skipped + 1
            continue
        angles[row] = q = found
        skipped, reached_any = 0, True
    unexplained = np.flatnonzero(reasons == BEYOND_REACH)[: BRANCH.explained]
    for row in unexplained:
        found, why = _from_many_starts(nominal, wanted.rows(np.array([row])), q, free)
        reasons[row] = why if found is None else f"jump of joint {int(np.argmax(np.abs(found - q))) + 1}"
    return PathSolution(wanted.points, angles, reasons)


def _one_pose(nominal: NominalArm, target: Wanted, start: Array, free: NDArray[np.bool_]) -> tuple[Array | None, str]:
    if np.linalg.norm(target.points[0]) > nominal.arm.reach:
        return None, BEYOND_REACH
    solution = solve_commands(nominal, target, start[None], free)
    if solution.converged[0]:
        return (solution.angles[0], "") if solution.singular[0] >= COMMANDS.pole else (None, "pole")
    return None, f"limit of joint {solution.limit[0]}" if solution.limit[0] else BEYOND_REACH


def _from_many_starts(
    nominal: NominalArm, target: Wanted, near: Array, free: NDArray[np.bool_]
) -> tuple[Array | None, str]:
    """The solution nearest to ``near`` from starts spread over the limits."""
    from scipy.stats import qmc  # takes half a second: seldom needed

    if np.linalg.norm(target.points[0]) > nominal.arm.reach:
        return None, BEYOND_REACH

    limits = np.where(np.isfinite(nominal.arm.limits), nominal.arm.limits, [-np.pi, np.pi])
    starts = qmc.scale(qmc.Halton(nominal.arm.n_motors, scramble=False).random(BRANCH.starts), *limits.T)
    starts = np.where(free, starts, near)
    every = target.rows(np.zeros(BRANCH.starts, dtype=np.intp))
    solution = solve_commands(nominal, every, starts, free)
    good = solution.converged & (solution.singular >= COMMANDS.pole)
    if not good.any():
        broken = solution.limit[solution.limit > 0]
        if solution.converged.any():
            return None, "pole"
        return None, f"limit of joint {np.bincount(broken).argmax()}" if len(broken) else BEYOND_REACH
    cost = np.where(good, np.abs(solution.angles - near).max(axis=1), np.inf)
    return solution.angles[int(np.argmin(cost))], ""


def _free(arm: Arm, held: Mapping[int, float]) -> NDArray[np.bool_]:
    return np.array([motor + 1 not in held for motor in range(arm.n_motors)])
