"""The audit of the printed numbers in one sentence, and the cells of Table 2 that contradict others."""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd

from armscope.paper.audit import MODELS
from armscope.paper.printed import AXES, TEST_TRAJECTORIES, UNCOMPENSATED

ROMAN = dict(zip(TEST_TRAJECTORIES, ("I", "II", "III"), strict=True))
READING_WORDS = {"rss": "root of the sum of squares", "rms": "root of the mean square"}
ALL = "all together"


def audit_sentence(audit: pd.DataFrame) -> str:
    """Whether any path makes Table 2 and the equations agree (see `armscope.paper.audit`)."""
    joint = audit[(audit["check"] == ALL) & audit["trajectory"].isin(TEST_TRAJECTORIES)]
    agreeing = joint[joint["possible"].astype(bool)]
    if agreeing.empty:
        return (
            "No path that the text allows makes Table 2 and Eqs. (15)–(20) agree on any of the three test trajectories "
            "under either reading of “RMS”: the printed numbers can't all be of one robot on these trajectories."
        )
    where = [f"{ROMAN[str(row.trajectory)]} ({READING_WORDS[str(row.reading)]})" for row in agreeing.itertuples()]
    apart = [name for name in TEST_TRAJECTORIES if name not in set(agreeing["trajectory"])]
    never = f"; on {' and '.join(ROMAN[name] for name in apart)} no path does" if apart else ""
    return f"Table 2 and Eqs. (15)–(20) can agree on trajectory {', '.join(where)}{never}."


@dataclass(frozen=True)
class Contradictions:
    """What of the printed Table 2 can't be true under one reading.

    Attributes:
        cells: (model, trajectory, axis) that no path allows, taken by themselves.
        trajectories: on which no path allows all cells together.
    """

    cells: frozenset[tuple[str, str, str]]
    trajectories: frozenset[str]


def contradictions(audit: pd.DataFrame) -> Contradictions:
    """Cells and trajectories of the printed table, read as "rss", that contradict its equations, or each other.

    Args:
        audit: see `armscope.paper.audit`.
    """
    broken = audit[(audit["reading"] == "rss") & ~audit["possible"].astype(bool)]
    single = broken[broken["axis"].isin(AXES)]
    cells: set[tuple[str, str, str]] = set()
    for row in single.itertuples():
        models = [model for model in MODELS if model in str(row.check)]
        involved = models if len(models) > 1 else [UNCOMPENSATED, *models]
        cells |= {(model, str(row.trajectory), str(row.axis)) for model in involved}
    return Contradictions(frozenset(cells), frozenset(broken.loc[broken["check"] == ALL, "trajectory"]))
