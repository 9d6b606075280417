"""Rows whose points are not those of their angles: of another target, another row's, the row before's, or nobody's."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from armscope.calibration.fit import robust_least_squares
from armscope.calibration.geometry import State
from armscope.calibration.model import SetUp, set_up
from armscope.check.constants import TRIALS
from armscope.check.suspicion import Suspicion
from armscope.core.grouping import same_configuration
from armscope.core.types import Array, Indices
from armscope.measurement.robust import scale_of
from armscope.recordings import Recordings
from armscope.robot import Arm


def rows_far_off(arm: Arm, recordings: Recordings, place: Callable[[SetUp], State]) -> list[Suspicion]:
    """Rows whose points fit the row before, another target, each other's angles, in pairs or rings, or nobody's.

    Args:
        arm: the nominal arm.
        recordings: the rows.
        place: base and tool as most rows have them.

    Returns:
        What each seems to be, with the rows by name.
    """
    some = recordings.rows(slice(0, TRIALS.rows_for_exchange))
    rows = set_up(arm, some)
    state = place(rows)
    residuals = rows.residuals(state)
    misfit = scale_of(residuals)
    if np.linalg.norm(residuals, axis=1).max() < TRIALS.exchanged * misfit:
        return []
    state = robust_least_squares(rows, state, rows.free("nominal")).state
    residuals = rows.residuals(state)
    distance, usual = np.linalg.norm(residuals, axis=1), scale_of(residuals)
    far = np.flatnonzero(distance > TRIALS.exchanged * usual)
    if not 1 <= len(far) <= 500:
        return []
    predicted, near = some.positions - residuals, TRIALS.fits_another * usual
    stale = far[_of_the_row_before(some, predicted, far, near)]
    far = np.setdiff1d(far, stale)
    reads_as = _targets_read(rows, state, far, near)
    mislabelled, far = far[reads_as >= 0], far[reads_as < 0]
    reads_as = reads_as[reads_as >= 0]
    angles_of, points_of = _assigned(predicted[far], some.positions[far], rows.base[far])
    matched = np.linalg.norm(predicted[far[angles_of]] - some.positions[far[points_of]], axis=1) < near
    matched &= (angles_of != points_of) & (rows.base[far[angles_of]] == rows.base[far[points_of]])
    found = []
    if len(stale):
        few = len(stale) <= TRIALS.most_alone * len(some)
        many = f"{len(stale)} rows hold the points" if len(stale) > 1 else "1 row holds the point"
        cure = "Had the arm not moved yet, or was a reading written twice? Leave them out, or measure them again."
        found.append(Suspicion("hint" if few else "problem", f"{many} of the row before: {ids_of(some, stale)}", cure))
    if len(mislabelled):
        found.append(_told_of_labels(some, mislabelled, [rows.tool_names[tool] for tool in reads_as]))
    if matched.any():
        exchanged = far[angles_of[matched]]
        statement = f"{len(exchanged)} rows seem to have exchanged their points: {ids_of(some, exchanged)}"
        found.append(Suspicion("problem", statement, "Their points fit each other's joint angles."))
    alone = far[angles_of[~matched]]
    alone = alone[distance[alone] > TRIALS.alone * misfit]
    if 0 < len(alone) <= TRIALS.most_alone * len(some):
        found.append(_told_alone(some, alone[np.argsort(-distance[alone])], distance))
    return found


def _of_the_row_before(table: Recordings, predicted: Array, far: Indices, near: float) -> Array:
    """(n,) bool: which of rows far off hold the point of the row before in their run, to within ``near`` m.

    The row before, or the one before of the same target, where the arm stood elsewhere: at one pose another target's
    point is another label. Not where that row holds theirs: then the two exchanged their points.
    """
    pose = same_configuration(table.motor_angles)
    found = np.zeros(len(far), bool)
    for before in (far - 1, _before_of_its_target(table)[far]):
        off = np.linalg.norm(table.positions[far] - predicted[before], axis=1)
        exchanged = np.linalg.norm(table.positions[before] - predicted[far], axis=1) < near
        elsewhere = (before >= 0) & (table.run[far] == table.run[before]) & (pose[far] != pose[before])
        found |= elsewhere & (off < near) & ~exchanged
    return found


def _before_of_its_target(table: Recordings) -> Indices:
    """(N,) the row before of the same target in the same run; -1 for none."""
    last: dict[tuple[str, str], int] = {}
    before = np.full(len(table), -1)
    for row, own in enumerate(zip(table.run.tolist(), table.target.tolist(), strict=True)):
        before[row] = last.get(own, -1)
        last[own] = row
    return before


def _targets_read(rows: SetUp, state: State, far: Indices, near: float) -> Array:
    """(n,) number of the other target that rows far off fit to within ``near`` m; -1 for none."""
    own = on_the_tool(rows, state)[far]
    apart = np.linalg.norm(own[:, None] - state.tools[None], axis=2)
    apart[np.arange(len(far)), rows.tool[far]] = np.inf
    nearest = np.argmin(apart, axis=1)
    return np.asarray(np.where(apart[np.arange(len(far)), nearest] < near, nearest, -1))


def on_the_tool(rows: SetUp, state: State) -> Array:
    """Where each measured point is in the tool's frame, by base and tools as they are placed. Returns (N, 3) m."""
    turned = np.einsum("nji,nj->ni", state.rotations[rows.base], rows.residuals(state))
    return np.asarray(np.einsum("nji,nj->ni", rows.nominal_frames.tool_rotation, turned) + state.tools[rows.tool])


def _told_of_labels(table: Recordings, rows: Indices, targets: list[str]) -> Suspicion:
    """Rows that carry the name of another target than the one that was measured."""
    few = len(rows) <= TRIALS.most_alone * len(table)
    each = [f"row {ids_of(table, rows[[n]])}: reads as target {target}" for n, target in enumerate(targets)]
    listed = "; ".join(each[:10]) + ("; ..." if len(each) > 10 else "")
    statement = (
        f"{'1 row fits' if len(rows) == 1 else f'{len(rows)} rows fit'} another target than column target says: "
    )
    return Suspicion("hint" if few else "problem", statement + listed, "Correct the label, and check again.")


def _assigned(predicted: Array, measured: Array, base: Indices) -> tuple[Indices, Indices]:
    """Which point (n, 3) belongs to which angles: the least sum of distances within what one base saw."""
    from scipy.optimize import linear_sum_assignment  # takes long to import, and is seldom needed

    between = np.linalg.norm(predicted[:, None] - measured[None], axis=2)
    between[base[:, None] != base[None]] = 1e6
    angles_of, points_of = linear_sum_assignment(between)
    return angles_of, points_of


def _told_alone(table: Recordings, alone: Indices, distance: Array) -> Suspicion:
    """Rows that fit nobody's angles, the furthest first."""
    number = "1 row lies" if len(alone) == 1 else f"{len(alone)} rows lie, the furthest first,"
    off = f"up to {1e3 * distance[alone[0]]:.3g} mm" if len(alone) > 1 else f"{1e3 * distance[alone[0]]:.3g} mm"
    statement = f"{number} {off} from where all others put the tool: {ids_of(table, alone)}"
    cure = "Mistyped, or measured while the arm moved? Mend it, or leave out what can't be measured again."
    if not table.positions[alone].any():
        cure = "Their points are exactly 0, 0, 0: readings that were lost. Leave them out."
    return Suspicion("hint", statement, cure)


def ids_of(table: Recordings, rows: Indices) -> str:
    """Rows by run and id, ten at most; by target, too, where several have the id."""
    names = []
    for row in rows[:10]:
        alike = np.count_nonzero((table.run == table.run[row]) & (table.id == table.id[row])) > 1
        of_target = f" ({table.target[row]})" if alike and table.target[row] else ""
        names.append(f"{table.run[row]}: {table.id[row]}{of_target}".removeprefix(": "))
    return ", ".join(names) + (", ..." if len(rows) > 10 else "")
