"""Rates of the concealment on real recordings, with exact binomial intervals."""

from __future__ import annotations

import numpy as np
import pandas as pd

from armscope.proof.binomial import rate
from armscope.real.scoring import Scores

GROUPS = {"all": [], "effect": ["effect"], "arm": ["set"]}


def tables(scores: Scores) -> dict[str, pd.DataFrame]:
    """Every table by name."""
    return {
        "cases": scores.cases,
        "numbers": scores.numbers,
        "rates": rates_table(scores),
        "held_out": held_out_table(scores.cases),
        "withheld": scores.withheld,
        "skipped": scores.skipped,
    }


def rates_table(scores: Scores) -> pd.DataFrame:
    """Found, right place, no new name, none unheard of, interval holds; by size, and by effect or arm and size.

    For each half and both. Columns by, of, size, half, score, and those of `Rate`.
    """
    rows = []
    cases = scores.cases.assign(quiet=scores.cases["new_names"] == 0, none_unheard_of=scores.cases["unheard_of"] == 0)
    covered = scores.numbers
    if len(covered):
        covered = covered[covered["covered"].notna()]
    for by, keys in GROUPS.items():
        for half in ("fixed", "fresh", "both"):
            for key, group in _grouped(cases, keys, half):
                for score in ("found", "right_place", "quiet", "none_unheard_of"):
                    rows.append({"by": by, **key, "half": half, "score": score, **vars(rate(group[score]))})
            for key, group in _grouped(covered, keys, half):
                rows.append({"by": by, **key, "half": half, "score": "covered", **vars(rate(group["covered"]))})
    return pd.DataFrame(rows)


def _grouped(rows: pd.DataFrame, keys: list[str], half: str) -> list[tuple[dict[str, object], pd.DataFrame]]:
    if rows.empty:
        return []
    chosen = rows[~rows["twin"]] if half == "both" else rows[rows["half"] == half]
    found = []
    for values, group in chosen.groupby([*keys, "size"], sort=False):
        *of, size = values if isinstance(values, tuple) else (values,)
        found.append(({"of": of[0] if of else "all", "size": size}, group))
    return found


def held_out_table(cases: pd.DataFrame) -> pd.DataFrame:
    """Per arm and size: medians of floor, without and with (mm), and of the share recovered."""
    rows = []
    for (name, size), group in cases.groupby(["set", "size"]):
        middle = group[["floor_mm", "without_mm", "with_mm", "recovered", "size_ratio"]].median()
        rows.append({"set": name, "size": size, "cases": len(group), **middle.to_dict()})
    return pd.DataFrame(rows).replace([np.inf, -np.inf], np.nan)
