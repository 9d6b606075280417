"""Bad input and honest limits: what makes a verdict impossible, and what limits it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.physics.placing import STANDS_STILL_RAD, varies
from armscope.recordings import Recordings
from armscope.robot import Arm, forward_kinematics
from armscope.verdict.schema import Notice

FEWEST_ROWS = 15
"""Below, frames and a handful of effects take up all there is."""
TOO_FAR = 0.03
"""Share of the arm's reach beyond which a residual is no calibration error."""
TURNED_TOO_FAR = 0.05
"""Median turn (rad) between modelled and measured orientations beyond which they are not the tool's."""
FLAT = 1e-3
SAME_VALUE_ROWS = 4
LARGEST_ROW_SHIFT = 3


@dataclass(frozen=True)
class Checked:
    """Rows that can be used, and what was noticed on the way."""

    recordings: Recordings
    notices: tuple[Notice, ...]


def check_table(arm: Arm, recordings: Recordings) -> Checked:
    """Leave out rows that can't be measurements; say what the table can't show.

    Raises:
        InputError: the table doesn't fit the arm, or holds no usable rows.
    """
    if recordings.n_motors != arm.n_motors:
        raise InputError(
            recordings.source,
            "line 1",
            f"{recordings.n_motors} motor angles",
            f"{arm.name} has {arm.n_motors} motors",
            "Is this the right robot for the recordings?",
        )
    notices: list[Notice] = []
    kept = np.isfinite(recordings.positions).all(axis=1)
    kept &= _told(_not_repeated(recordings), "repeated rows", "are exact copies of earlier rows", notices)
    kept &= _told(_not_clipped(recordings), "clipped rows", "stand at one and the same extreme coordinate", notices)
    kept &= _told(_not_stuck(recordings), "stuck instrument", "repeat a position although the arm moved", notices)
    if kept.sum() < 4:
        raise InputError(recordings.source, "", f"{int(kept.sum())} usable rows", "at least four poses are needed")
    table = _without_empty_context(recordings if kept.all() else recordings.rows(kept))
    notices += _limits(arm, table)
    return Checked(table, tuple(notices))


def _without_empty_context(recordings: Recordings) -> Recordings:
    """Context that no row of this table recorded is no context."""
    empty: dict[str, Any] = {
        name: None
        for name in ("time", "temperature", "payload", "approach", "speed", "torque", "sigma", "orientation")
        if getattr(recordings, name) is not None and np.isnan(getattr(recordings, name)).all()
    }
    return replace(recordings, **empty) if empty else recordings


def _told(good: NDArray[np.bool_], kind: str, what: str, notices: list[Notice]) -> NDArray[np.bool_]:
    count = int((~good).sum())
    if count:
        notices.append(Notice(kind, f"{count} of {len(good)} rows {what}; they were left out."))
    return good


def _not_repeated(recordings: Recordings) -> NDArray[np.bool_]:
    rows = np.column_stack([recordings.motor_angles, recordings.positions])
    _, first = np.unique(rows, axis=0, return_index=True)
    good = np.zeros(len(rows), dtype=bool)
    good[first] = True
    return good


def _not_clipped(recordings: Recordings) -> NDArray[np.bool_]:
    """Several rows that share the very largest or smallest coordinate are a limit, not a measurement."""
    good = np.ones(len(recordings), dtype=bool)
    for axis in range(3):
        values = recordings.positions[:, axis]
        for extreme in (values.min(), values.max()):
            at = values == extreme
            if at.sum() >= SAME_VALUE_ROWS and np.ptp(recordings.motor_angles[at], axis=0).max() > STANDS_STILL_RAD:
                good &= ~at
    return good


def _not_stuck(recordings: Recordings) -> NDArray[np.bool_]:
    _, which, count = np.unique(recordings.positions, axis=0, return_inverse=True, return_counts=True)
    which = which.reshape(-1)
    good = np.ones(len(recordings), dtype=bool)
    for point in np.flatnonzero(count > 1):
        rows = np.flatnonzero(which == point)
        if np.ptp(recordings.motor_angles[rows], axis=0).max() > 1e-2:
            good[rows[1:]] = False
    return good


def _limits(arm: Arm, recordings: Recordings) -> list[Notice]:
    notices = []
    still = np.flatnonzero(np.ptp(recordings.motor_angles, axis=0) <= STANDS_STILL_RAD) + 1
    if len(still):
        joints = ", ".join(f"joint {j}" for j in still)
        notices.append(Notice("joints that never move", f"{joints}: nothing that follows their angle can be found."))
    for name, values, least in (
        ("payload_kg", recordings.payload, 1e-6),
        ("temperature_c", recordings.temperature, 0.2),
        ("time_s", recordings.time, 1.0),
    ):
        if values is not None and not varies(values, least):
            notices.append(Notice("constant context", f"{name} hardly varies: what follows it can't be found."))
    if not arm.has_masses and recordings.torque is None:
        text = "No link masses and no recorded torques: compliances are known up to unknown mass moments only."
        notices.append(Notice("no loads", text))
    spread = np.linalg.svd(recordings.positions - recordings.positions.mean(axis=0), compute_uv=False)
    if len(spread) < 3 or spread[2] < FLAT * spread[0]:
        notices.append(Notice("poses in one plane", "All tool points lie in one plane: many effects look alike there."))
    return notices


def too_far(arm: Arm, recordings: Recordings, residuals: Array) -> Notice | None:
    """Why the arm's model can't be the recordings' at all, if so; ``residuals`` (N, 3) mm after the free frames.

    Args:
        arm: the nominal arm.
        recordings: the rows.
        residuals: (N, 3) mm after the free frames.

    Returns:
        The notice; None where the model may be theirs.
    """
    size = float(np.median(np.linalg.norm(residuals, axis=1))) / np.sqrt(3)
    if size < TOO_FAR * arm.reach * 1e3:
        return None
    points = forward_kinematics(arm, recordings.motor_angles)
    start = f"After fitting base and tool the residual is still {size:.0f} mm per axis"
    stretch = _spread(recordings.positions) / _spread(points)
    if not 0.5 < stretch < 2:
        text = (
            f"{start}: the measured points are spread {stretch:.3g} times as far as the arm's, so the lengths seem to "
        )
        return Notice("units", f"{text}stand in another unit than their columns' names say.")
    shift = _row_shift(points, recordings.positions)
    if shift:
        text = f"{start}, and nearly vanishes when the positions move by {shift} rows: they are out of step."
        return Notice("rows out of step", text)
    if _distance_misfit(points * [1, 1, -1], recordings.positions) < 0.1 * _spread(points):
        text = f"{start}, and nearly vanishes in the mirror: two of x, y, z are exchanged, or one has the wrong sign."
        return Notice("left-handed frame", text)
    text = (
        f"{start}: this is not the robot of these recordings, two angle columns are exchanged, or rows and positions "
        "do not belong together."
    )
    return Notice("wrong robot", text)


def with_orientations(recordings: Recordings, turns: Array | None) -> tuple[Recordings, list[Notice]]:
    """The table with its orientations, if they are the arm's; and what to say of them.

    Args:
        turns: (N, 3) rad, between modelled and measured orientations after the free frames, NaN where not measured.
    """
    if turns is None:
        return recordings, []
    size = np.linalg.norm(turns[np.isfinite(turns).all(axis=1)], axis=1)
    bare = replace(recordings, orientation=None)
    if len(size) < FEWEST_ROWS:
        text = f"Only {len(size)} rows hold an orientation: positions alone were used."
        return bare, [Notice("few orientations", text)]
    if np.median(size) > TURNED_TOO_FAR:
        text = (
            f"The measured orientations lie {np.degrees(np.median(size)):.3g} degrees (median) from the arm's, however "
            "the tool is turned: positions alone were used. Are the quaternions in the order w, x, y, z?"
        )
        return bare, [Notice("orientations not the arm's", text)]
    return recordings, []


def _spread(points: Array) -> float:
    return float(np.sqrt(np.mean(np.sum((points - points.mean(axis=0)) ** 2, axis=1))))


def _row_shift(points: Array, measured: Array) -> int:
    """The shift of rows under which a rigid motion maps the points onto the measured ones, 0 if there is none."""
    for shift in range(1, LARGEST_ROW_SHIFT + 1):
        for sign in (1, -1):
            moved = np.roll(measured, -sign * shift, axis=0)[shift:-shift]
            if _distance_misfit(points[shift:-shift], moved) < 0.05 * _spread(points):
                return sign * shift
    return 0


def _distance_misfit(points: Array, measured: Array) -> float:
    """RMS distance after the best rigid motion, m."""
    p, m = points - points.mean(axis=0), measured - measured.mean(axis=0)
    u, _, vt = np.linalg.svd(m.T @ p)
    flip = np.diag([1.0, 1.0, float(np.sign(np.linalg.det(u @ vt)))])
    return float(np.sqrt(np.mean(np.sum((m - p @ (u @ flip @ vt).T) ** 2, axis=1))))
