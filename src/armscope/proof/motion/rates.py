"""Rates of a motion proof with exact binomial intervals, against the aims."""

from __future__ import annotations

import numpy as np
import pandas as pd

from armscope.core.words import table_lines
from armscope.proof.binomial import RATE, Rate, Row, aim_row, aim_rows, of_seeds, rate
from armscope.proof.definitions import SEEDS
from armscope.proof.motion.scoring import AIMS

HELD_OUT = "held-out error over the truth's own, median world (clean, single, multiple)"
MOVING = "the same where joints move (friction of a standing one may be anything within its band)"
HELD_OUT_AIM = (0.0, 1.05)
RIGHT_INPUTS = ("clean", "single", "multiple")


def summary(cases: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """Every aim for fixed, fresh and all worlds: cases, right, estimate, 95 % interval, bounds, verdict."""
    rows = aim_rows(AIMS, cases)
    worlds = cases["worlds"]
    for seeds in SEEDS:
        counted = of_seeds(worlds[worlds["category"].isin(RIGHT_INPUTS)], seeds)
        for aim, column in ((HELD_OUT, "held_out_ratio"), (MOVING, "held_out_moving")):
            rows.append(_held_out(counted[column].to_numpy(dtype=float), (aim, seeds)))
    return pd.DataFrame(rows)


def _held_out(ratios: np.ndarray, what: tuple[str, str]) -> Row:
    """The median, with the order statistics that hold it in 95 % of samples (distribution-free)."""
    count = len(ratios)
    if not count:
        return aim_row(*what, Rate(0, 0, np.nan, np.nan, np.nan), HELD_OUT_AIM)
    ordered = np.sort(ratios)
    below = int(np.floor(count / 2 - 0.98 * np.sqrt(count)))
    low, high = ordered[max(below, 0)], ordered[min(count - 1 - below, count - 1)]
    median = float(ordered[(count - 1) // 2])  # a median that is a world's own, and so may be infinite
    counted = Rate(count, int((ratios <= HELD_OUT_AIM[1]).sum()), median, float(low), float(high))
    return aim_row(*what, counted, HELD_OUT_AIM)


def per_effect(cases: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """How often each concealed cause was found, named right, and held by its intervals: effect, score and rate."""
    rows: list[Row] = []
    groups = (
        ("found", cases["effects"].assign(effect=_with_shape(cases["effects"])), "right"),
        ("name right", cases["names"], "right"),
        ("interval holds", cases["intervals"], "covered"),
    )
    for score, table, column in groups:
        for effect, group in table.groupby("effect"):
            rows.append({"effect": effect, "score": score, **vars(rate(group[column]))})
    return pd.DataFrame(rows, columns=["effect", "score", *RATE])


def _with_shape(effects: pd.DataFrame) -> pd.Series:
    return effects["effect"].where(effects["shape"] == "", effects["effect"] + "/" + effects["shape"])


def in_words(table: pd.DataFrame) -> str:
    """The summary of all worlds as a Markdown table."""
    rows = []
    for _, row in table[table["seeds"] == "all"].iterrows():
        spans = (f"{row['low']:.3g} - {row['high']:.3g}", f"{row['least']:g} - {row['most']:g}")
        rows.append((row["aim"], row["cases"], f"{row['estimate']:.3g}", *spans, row["verdict"]))
    return "\n".join(table_lines(("aim", "cases", "rate", "95 % interval", "aimed at", ""), rows)) + "\n"
