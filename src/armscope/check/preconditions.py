"""Bad input and honest limits: what makes a verdict impossible, and what limits it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.check.constants import TABLE
from armscope.check.report import what_forbids
from armscope.check.suspicion import BESIDE, Suspicion, refuse_problems
from armscope.check.suspicions import explanation
from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.physics.placing import varies
from armscope.recordings import Recordings
from armscope.recordings.motion import moving
from armscope.robot import Arm
from armscope.verdict.schema import ANOTHER_MODEL, Notice


@dataclass(frozen=True)
class Checked:
    """Rows that can be used, and what was noticed on the way."""

    recordings: Recordings
    notices: tuple[Notice, ...]


def check_table(arm: Arm, recordings: Recordings) -> Checked:
    """Leave out rows that can't be measurements; say what the table can't show. Raises InputError: the table doesn't
    fit the arm, or holds no usable rows."""
    recordings.check_motors(arm.name, arm.n_motors)
    if not len(recordings):
        raise InputError(recordings.source, "", "0 rows", "at least four poses are needed")
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


def refuse_unusable(arm: Arm, recordings: Recordings, anyway: str = "diagnoses") -> None:
    """The one judgement of a table, `armscope check`'s: where something makes results meaningless, none are made.

    Orientations that are not the tool's are no reason: a diagnosis leaves them out by itself and says so.

    Args:
        arm: the arm that it should be of.
        recordings: the table.
        anyway: what --anyway does with it all the same.

    Raises:
        InputError: it holds a problem.
    """
    suspicions = what_forbids(replace(recordings, orientation=None), arm)
    refuse_problems(suspicions, recordings.source, anyway)


def as_notices(problems: Sequence[Suspicion], obstacle: Notice | None) -> tuple[Notice, ...]:
    """Problems as notices, but for the one that an obstacle names already."""
    said = "" if obstacle is None else obstacle.text
    kinds = [(each.kind if each.kind in (ANOTHER_MODEL, *BESIDE) else "check", each.text()) for each in problems]
    return tuple(Notice(kind, text[0].upper() + text[1:]) for kind, text in kinds if text not in said)


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
    return ~(pd.DataFrame(rows).duplicated().to_numpy() & np.isfinite(rows).all(axis=1))


def _not_clipped(recordings: Recordings) -> NDArray[np.bool_]:
    """Several rows that share the very largest or smallest coordinate are a limit, not a measurement."""
    good = np.ones(len(recordings), dtype=bool)
    for axis in range(3):
        values = recordings.positions[:, axis]
        for extreme in (values.min(), values.max()):
            at = values == extreme
            if at.sum() >= TABLE.clipped_rows and moving(recordings.motor_angles[at]).any():
                good &= ~at
    return good


def _not_stuck(recordings: Recordings) -> NDArray[np.bool_]:
    points = pd.DataFrame(recordings.positions)
    again = np.flatnonzero(points.duplicated(keep=False).to_numpy() & np.isfinite(recordings.positions).all(axis=1))
    good = np.ones(len(recordings), dtype=bool)
    for rows in points.iloc[again].groupby([0, 1, 2], sort=False).indices.values():
        if moving(recordings.motor_angles[again[rows]]).any():
            good[again[rows[1:]]] = False
    return good


def _limits(arm: Arm, recordings: Recordings) -> list[Notice]:
    notices = []
    still = np.flatnonzero(~moving(recordings.motor_angles)) + 1
    if len(still):
        joints = ", ".join(f"joint {j}" for j in still)
        notices.append(Notice("joints that never move", f"{joints}: nothing that follows their angle can be found."))
    for name, values, least in (
        ("payload_kg", recordings.payload, TABLE.payload_varies),
        ("temperature_c", recordings.temperature, TABLE.temperature_varies),
        ("time_s", recordings.time, TABLE.time_varies),
    ):
        if values is not None and not varies(values, least):
            notices.append(Notice("constant context", f"{name} hardly varies: what follows it can't be found."))
    loaded = recordings.payload is not None and np.nan_to_num(recordings.payload).max() > 0
    if loaded and not any(arm.description.tool_mm):
        text = (
            "Payloads are recorded and no `tool_mm` is stated: each counts as sitting in the last frame's origin. What "
            "gives way comes out wrong by its lever; `armscope check` tells where the points put the tool."
        )
        notices.append(Notice("payload's place", text))
    if not arm.has_masses and recordings.torque is None:
        text = "No link masses and no recorded torques: compliances are known up to unknown mass moments only."
        notices.append(Notice("no loads", text))
    spread = np.linalg.svd(recordings.positions - recordings.positions.mean(axis=0), compute_uv=False)
    if len(spread) < 3 or spread[2] < TABLE.flat * spread[0]:
        notices.append(Notice("poses in one plane", "All tool points lie in one plane: many effects look alike there."))
    return notices


def too_far(arm: Arm, recordings: Recordings, residuals: Array, problems: Sequence[Suspicion]) -> Notice | None:
    """Why the arm's model can't be the recordings' at all, if so.

    Args:
        arm: the nominal arm.
        recordings: the rows.
        residuals: (N, 3) mm after the free frames.
        problems: what looks wrong, see `what_forbids`.

    Returns:
        The problem that explains it, or that none does; None where residuals may be calibration errors.
    """
    size = float(np.median(np.linalg.norm(residuals, axis=1))) / np.sqrt(3)
    if size < TABLE.too_far * arm.reach * 1e3:
        return None
    start = f"After fitting base and tool the residual is still {size:.0f} mm per axis"
    found = next((each for each in problems if each.kind not in ("check", *BESIDE)), None) or explanation(
        arm, recordings
    )
    return Notice(found.kind, f"{start}: {found.text()}")
