"""Rows that look like bad shots and fit another target of the table: they carry its label by mistake."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from armscope.core.types import Indices
from armscope.core.words import enumerated
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.constants import TELLING
from armscope.physics.model import predict
from armscope.verdict.schema import MISLABELLED, Notice, SuspectRow


def reads_as(state: DiagnosisState, rows: Indices) -> list[str]:
    """The other target whose place on the tool rows fit within the noise.

    Args:
        state: the finished selection.
        rows: (n,) numbers of the rows that look like bad shots.

    Returns:
        (n) names; "" where none fits.
    """
    model, some = state.fit.model, state.recordings.rows(rows)
    found, nearest = [""] * len(rows), np.full(len(rows), TELLING.reads_as_sigmas * np.sqrt(3) * 1e-3 * state.fit.noise)
    known = sorted({str(part.placed.variant) for part in model.tools})
    for target in known if len(known) > 1 else ():
        asked = np.flatnonzero(some.target != target)
        if not len(asked):
            continue
        other = replace(some.rows(asked), target=np.full(len(asked), target, dtype=some.target.dtype))
        distance = np.linalg.norm(predict(model, other) - other.positions, axis=1)
        for row, off in zip(asked.tolist(), distance.tolist(), strict=True):
            if off < nearest[row]:
                found[row], nearest[row] = target, off
    return found


def told_of_labels(suspects: Sequence[SuspectRow]) -> list[Notice]:
    """That rows read as another target than their label says, and what to do: a notice, or none."""
    rows = [f"row {each.run + ': ' if each.run else ''}{each.id} reads as target {each.reads_as}" for each in suspects
            if each.reads_as]  # fmt: skip
    if not rows:
        return []
    more = f" and {len(rows) - TELLING.labels_told} more (suspects.csv)" if len(rows) > TELLING.labels_told else ""
    text = f"Labels in column target are wrong: {enumerated(rows[: TELLING.labels_told])}{more}."
    return [Notice(MISLABELLED, f"{text} Correct them, and diagnose again: these rows are no bad shots.")]
