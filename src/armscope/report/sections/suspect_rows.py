"""Rows that look like bad shots."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pandas as pd

from armscope.report.sectioning import Section, Subject
from armscope.verdict.schema import SuspectRow

MOST_SUSPECTS = 40
READS_AS = "reads as target (correct the label)"


def _context(subject: Subject) -> dict[str, Any]:
    suspects = subject.verdict.suspects
    return {"suspects": _suspects(suspects), "suspects_left_out": max(0, len(suspects) - MOST_SUSPECTS)}


def _suspects(suspects: Sequence[SuspectRow]) -> pd.DataFrame:
    worst = sorted(suspects, key=lambda row: row.weight)[:MOST_SUSPECTS]
    table = pd.DataFrame(
        [(row.id, row.run or "–", row.residual_mm, f"{row.weight:.2f}", row.reads_as or "–") for row in worst],
        columns=["row (id)", "run", "left over (mm)", "weight kept (1 = full)", READS_AS],
    )
    table = table.drop(columns="run") if all(not row.run for row in worst) else table
    return table.drop(columns=READS_AS) if all(not row.reads_as for row in worst) else table


SUSPECT_ROWS = Section("suspect_rows", "Suspect rows", "Rows that look like bad shots", _context, folded=True)
