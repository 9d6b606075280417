"""Several recordings as one table in which each keeps frames of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from armscope.check.preconditions import check_table
from armscope.core.inputs import InputError
from armscope.core.types import Array, Indices
from armscope.recordings import Recordings
from armscope.robot import Arm

CONTEXT = ("time", "temperature", "payload", "approach", "speed", "torque", "sigma")


def stacked(arm: Arm, recordings: Mapping[str, Recordings]) -> tuple[Recordings, Indices]:
    """One table of all rows that can be used: bases free per run, tools free per recording.

    Args:
        arm: the nominal arm.
        recordings: by name.

    Returns:
        The table, and (N,) the number of the recording that each row is of.

    Raises:
        InputError: fewer than two recordings, or one that does not fit the arm.
    """
    if len(recordings) < 2:
        raise InputError("compare", "", f"{len(recordings)} recordings", "two or more are needed")
    tables = [check_table(arm, table).recordings for table in recordings.values()]
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


_ROWS = ("motor_angles", "positions", "run", "target", "id")


def _joined(values: list[Array | None]) -> Array | None:
    """What all recordings hold; None where one does not: it could be no cause of a difference between them."""
    known = [each for each in values if each is not None]
    return np.concatenate(known) if len(known) == len(values) else None
