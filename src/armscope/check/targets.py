"""Targets that are no reflectors, each with a tool offset of its own; and reflectors that have no names."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armscope.calibration.fit import placed
from armscope.calibration.model import set_up
from armscope.check.constants import TRIALS
from armscope.check.rows_far_off import ids_of, on_the_tool
from armscope.check.suspicion import Suspicion
from armscope.core.averages import rms_distance
from armscope.core.types import Array
from armscope.recordings import Recordings, numbered_points
from armscope.robot import Arm

TWO_REFLECTORS = "two reflectors"  # Kind of a suspicion that points of one target are of two


def named_row_by_row(recordings: Recordings) -> list[Suspicion]:
    """Whether column target has nearly as many names as the table has rows: then it numbers points."""
    names = recordings.target.tolist()
    if not numbered_points.number_the_rows(names):
        return []
    return [Suspicion("problem", f"column target: {numbered_points.told_of_names(names)}", numbered_points.CURE)]


def two_reflectors(arm: Arm, table: Recordings, misfit: float) -> list[Suspicion]:
    """Whether points sit at two places on the tool, which one target's name does not tell apart.

    Where each is on the tool is known from the pose, so that two reflectors are two clusters there (Lloyd 1982), by
    which base and tools are placed anew.

    Args:
        arm: the nominal arm.
        table: rows that it explains badly.
        misfit: RMS distance that base and tool leave of them, m.

    Returns:
        The suspicion; none where two places do not explain the points clearly better.
    """
    rows = set_up(arm, table)
    state = placed(rows, TRIALS.steps)
    second = np.zeros(len(table), bool)
    for _ in range(TRIALS.steps):
        before, second = second, _halved(on_the_tool(rows, state))
        if (second == before).all():
            break
        if min(second.sum(), (~second).sum()) < 3 * TRIALS.rows_per_parameter:
            return []
        names = [f"{name} {1 + int(other)}" for name, other in zip(table.target, second, strict=True)]
        rows = set_up(arm, replace(table, target=np.array(names)))
        state = placed(rows, TRIALS.steps)
    if all(len(np.unique(second[table.run == run])) == 1 for run in np.unique(table.run)):
        return []  # a tool that moved between runs
    left = rms_distance(rows.residuals(state))
    if left > TRIALS.clearly_better * misfit:
        return []
    on_tool = on_the_tool(rows, state)
    apart = float(np.linalg.norm(on_tool[second].mean(axis=0) - on_tool[~second].mean(axis=0)))
    statement = f"the points sit at two places on the tool, {1e3 * apart:.3g} mm apart: {1e3 * left:.3g} mm are left so"
    fewer = second if 2 * second.sum() <= len(second) else ~second
    one = ids_of(table, np.flatnonzero(fewer))
    cure = f"Were these two reflectors? Name them in column target; one of them in {one}."
    if np.count_nonzero(np.diff(second.astype(int))) == 1:  # from a row on: a diagnosis asks that of the tool
        return [Suspicion("hint", statement, f"{cure} Or did the tool move then?", TWO_REFLECTORS)]
    return [Suspicion("problem", statement, cure, TWO_REFLECTORS)]


def _halved(points: Array) -> NDArray[np.bool_]:
    """Which of points (N, 3) are nearer to the second of two centres."""
    along = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)[2][0]
    second = points @ along > np.median(points @ along)
    for _ in range(TRIALS.steps):
        if second.all() or not second.any():
            break
        centres = points[~second].mean(axis=0), points[second].mean(axis=0)
        second = np.linalg.norm(points - centres[1], axis=1) < np.linalg.norm(points - centres[0], axis=1)
    return np.asarray(second)
