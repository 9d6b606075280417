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
    """Whether any path makes Table 2 and the equations agree (see `armscope.paper.audit`), and what was searched."""
    searched = f"Searched: {audit['searched'].iloc[0]}."
    joint = audit[(audit["check"] == ALL) & audit["trajectory"].isin(TEST_TRAJECTORIES)]
    agreeing = joint[joint["possible"].astype(bool)]
    if agreeing.empty and not is_thorough(audit):
        return (
            "No path that makes Table 2 and Eqs. (15)–(20) agree on any of the three test trajectories was found among "
            f"the few that were tried: too few to say that there is none. {searched}"
        )
    if agreeing.empty:
        return (
            "No path that the text allows makes Table 2 and Eqs. (15)–(20) agree on any of the three test trajectories "
            "under either reading of “RMS”: the printed numbers can't all be of one robot on these trajectories. "
            f"{searched}"
        )
    where = [f"{ROMAN[str(row.trajectory)]} ({READING_WORDS[str(row.reading)]})" for row in agreeing.itertuples()]
    apart = [name for name in TEST_TRAJECTORIES if name not in set(agreeing["trajectory"])]
    none = "no path does" if is_thorough(audit) else "none of the few that were tried does"
    never = f"; on {' and '.join(ROMAN[name] for name in apart)} {none}" if apart else ""
    return f"Table 2 and Eqs. (15)–(20) can agree on trajectory {', '.join(where)}{never}. {searched}"


def is_thorough(audit: pd.DataFrame) -> bool:
    """Whether so much was searched that what was not found is not there."""
    return bool(audit["thorough"].astype(bool).all())


@dataclass(frozen=True)
class Contradictions:
    """What of the printed Table 2 can't be true under one reading."""

    cells: frozenset[tuple[str, str, str]]  # (model, trajectory, axis) that no path allows, taken by themselves
    trajectories: frozenset[str]  # on which no path allows all cells together
    thorough: bool  # whether that can be said: else they are what the few paths that were tried don't allow


def contradictions(audit: pd.DataFrame) -> Contradictions:
    """Cells and trajectories of the printed table, read as "rss", that contradict its equations, or each other.
    ``audit``: see `armscope.paper.audit`."""
    broken = audit[(audit["reading"] == "rss") & ~audit["possible"].astype(bool)]
    single = broken[broken["axis"].isin(AXES)]
    cells: set[tuple[str, str, str]] = set()
    for row in single.itertuples():
        models = [model for model in MODELS if model in str(row.check)]
        involved = models if len(models) > 1 else [UNCOMPENSATED, *models]
        cells |= {(model, str(row.trajectory), str(row.axis)) for model in involved}
    trajectories = frozenset(broken.loc[broken["check"] == ALL, "trajectory"])
    return Contradictions(frozenset(cells), trajectories, is_thorough(audit))
