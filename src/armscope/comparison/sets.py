"""Several recordings as one table in which each keeps frames of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np

from armscope.check.preconditions import check_table
from armscope.comparison.constants import COMPARING
from armscope.core.inputs import InputError
from armscope.core.types import Array, Indices
from armscope.core.words import enumerated
from armscope.fitting.design_matrix import point_columns
from armscope.fitting.linearisation import linearised
from armscope.physics.effect import Term
from armscope.physics.frames import free_frames
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings
from armscope.robot import Arm

CONTEXT = ("time", "temperature", "payload", "approach", "speed", "torque", "sigma")
CONTEXT_COLUMNS = ("time_s", "temperature_c", "payload_kg", "approach1 …", "dq1_rad_s …", "tau1_nm …", "sigma_mm")


def stacked(arm: Arm, recordings: Mapping[str, Recordings]) -> tuple[Recordings, Indices]:
    """One table of all rows that can be used: bases free per run, tools free per recording.

    Returns:
        The table, and (N,) the number of the recording that each row is of.

    Raises:
        InputError: fewer than two recordings, one that does not fit the arm, or one of too few rows.
    """
    if len(recordings) < 2:
        raise InputError("compare", "", f"{len(recordings)} recordings", "two or more are needed")
    tables = [check_table(arm, table).recordings for table in recordings.values()]
    for table in tables:
        _check_rows(table)
    _refuse_copies(list(recordings), tables)
    named = [
        replace(
            table,
            run=np.array([f"{name}: {run}" for run in table.run]),
            target=np.array([f"{name}: {target}" for target in table.target]),
            orientation=None,
            extra=None,
        )
        for name, table in zip(recordings, tables, strict=True)
    ]
    context: dict[str, Any] = {name: _joined([getattr(table, name) for table in named]) for name in CONTEXT}
    parts: dict[str, Any] = {name: np.concatenate([getattr(table, name) for table in named]) for name in _ROWS}
    table = replace(named[0], **parts, **context, notes=(), source="recordings")
    return table, np.repeat(np.arange(len(named)), [len(each) for each in named])


def _check_rows(table: Recordings) -> None:
    """Its rows must tell more than where base and tool are, as a diagnosis asks, too. Raises InputError: they don't."""
    numbers, frames = 3 * len(table), sum(len(placed.terms) for placed in free_frames(table, False))
    if numbers <= 2 * frames:
        found = f"{len(table)} rows, which hold {numbers} numbers"
        rule = f"base and tool of each run and target take up {frames}: rows must hold more than twice as many"
        raise InputError(table.source, "", found, rule, "Measure more poses in each run, or name the runs alike.")


def _refuse_copies(names: Sequence[str], tables: Sequence[Recordings]) -> None:
    """A recording of the rows of another one tells nothing of a change, and makes the noise look small. Raises
    InputError: all points of one stand in another one, to the last digit."""
    points = [{tuple(point) for point in table.positions.tolist()} for table in tables]
    for (first, ours), (second, theirs) in combinations(zip(names, points, strict=True), 2):
        if ours <= theirs or theirs <= ours:
            found = f"the points of {first} in {second}, to the last digit"
            rule = "what is compared is measured anew each time"
            raise InputError("compare", "", found, rule, "Was one file copied, or named twice?")


def of_same_poses(tables: Sequence[Recordings]) -> list[tuple[int, ...]]:
    """Recordings in families that cover the same ranges of every joint, and of the payload.

    What no effect says well follows pose and load, so that recordings of others differ although nothing changed.

    Args:
        tables: the recordings; without a payload, none was carried.

    Returns:
        Numbers of recordings; each stands in the first family with whose first member it overlaps.
    """
    still = np.array([*[COMPARING.still_rad] * tables[0].n_motors, COMPARING.same_payload_kg])
    ranges = [np.quantile(_covered(table), COMPARING.covered, axis=0) for table in tables]
    families: list[list[int]] = []
    for k, (low, high) in enumerate(ranges):
        for family in families:
            lower, upper = ranges[family[0]]
            shared, either = (
                np.minimum(high, upper) - np.maximum(low, lower),
                np.maximum(high, upper) - np.minimum(low, lower),
            )
            if (shared >= COMPARING.same_poses * either - still).all():
                family.append(k)
                break
        else:
            families.append([k])
    return [tuple(family) for family in families]


def _covered(table: Recordings) -> Array:
    payload = np.zeros(len(table)) if table.payload is None else np.nan_to_num(table.payload)
    return np.column_stack([table.motor_angles, payload])


def columns_of_rows(model: FittedModel, table: Recordings, terms: Sequence[Term]) -> Array:
    """(3N, p) columns of effects in the order of the rows, mm per SI unit.

    Args:
        model: the arm with frames.
        table: N rows.
        terms: the p effects.

    Returns:
        As tool points show them, base axes.
    """
    found = np.empty((len(table), 3, len(terms)))
    for rows, posture in linearised(table).chunks(model):
        found[rows] = point_columns(posture, terms).reshape(-1, 3, len(terms))
    return found.reshape(-1, len(terms))


_ROWS = ("motor_angles", "positions", "run", "target", "id")


def left_out_context(recordings: Mapping[str, Recordings]) -> str:
    """What some recordings hold and others do not, and so is not looked at, and what to do; "" where there is none."""
    told = []
    for name, column in zip(CONTEXT, CONTEXT_COLUMNS, strict=True):
        having = [each for each, table in recordings.items() if getattr(table, name) is not None]
        if 0 < len(having) < len(recordings):
            of_them = enumerated([f'"{each}"' for each in having]) if len(having) <= COMPARING.named else "some"
            told.append(f"{column} (only in {of_them})")
    if not told:
        return ""
    return (
        f"Left out, as not every recording has it: {', '.join(told)}. So no cause that follows it could be told: "
        "record it in all of them."
    )


def _joined(values: list[Array | None]) -> Array | None:
    """What all recordings hold; None where one does not: it could be no cause of a difference between them."""
    known = [each for each in values if each is not None]
    return np.concatenate(known) if len(known) == len(values) else None
