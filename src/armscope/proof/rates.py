"""Rates with exact binomial intervals, and the tables that are made of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from armscope.proof.binomial import RATE, Rate, Row, aim_row, aim_rows, of_seeds, rate
from armscope.proof.definitions import (
    AIMS,
    CLEAR_STRENGTH,
    HELD_OUT_TOLERANCE,
    RELIABLE,
    RIGHT_INPUTS,
    ROUGH,
    SEEDS,
    THRESHOLD_AIM,
)
from armscope.proof.oracle import Threshold, threshold
from armscope.proof.rough import rough_table
from armscope.proof.scoring import Cases
from armscope.verdict.effects import UNKNOWN

THRESHOLD_TEXT = "detection threshold (90 %) in multiples of the oracle's"
POWER_BINS = (0.0, 0.6, 0.9, 1.15, 1.45, 1.9, 2.6, 5.0, 12.0, 40.0, np.inf)
EVIDENCE_BINS = (-np.inf, 1.0, 3.0, 10.0, 30.0, np.inf)
NEAR_THRESHOLD = (1.0, 2.6)
"""Sizes, in multiples of the oracle's 90 % threshold, at which an oracle finds nearly all and a diagnosis may not."""
POWER_CATEGORIES = ("single", "faint")
OUTCOMES = ("exact", "exact_story", "silent", "held_out_close")


def aims_table(cases: Cases, rng: np.random.Generator) -> pd.DataFrame:
    """Every aim for fixed, fresh and all worlds, with its rate, interval, bounds and verdict."""
    rows = aim_rows(AIMS, cases.tables())
    for seeds in SEEDS:
        found = _detection_threshold(of_seeds(cases.effects, seeds), "seen", RELIABLE, rng)
        counted = Rate(found.cases, None, found.value, found.low, found.high)
        rows.append(aim_row(THRESHOLD_TEXT, seeds, counted, THRESHOLD_AIM))
    return pd.DataFrame(rows)


def _powered(effects: pd.DataFrame) -> pd.DataFrame:
    """Effects that stood alone in a world with right inputs, sized against the oracle."""
    alone = effects["category"].isin(POWER_CATEGORIES) & ~effects["minor"].astype(bool)
    single = effects[alone & (effects["size_in_thresholds"] > 0)]
    return single[~single["world"].duplicated(keep=False)]


def _detection_threshold(effects: pd.DataFrame, column: str, share: float, rng: np.random.Generator) -> Threshold:
    """Multiple of the oracle's threshold at which that share of the effects is found; rng: of the bootstrap."""
    chosen = _powered(effects)
    return threshold(
        chosen["size_in_thresholds"].to_numpy(dtype=float), chosen[column].to_numpy(dtype=bool), share, rng
    )


def thresholds_table(effects: pd.DataFrame, rng: np.random.Generator) -> pd.DataFrame:
    """Sizes, in multiples of the oracle's 90 % threshold, at which half and nine of ten are seen and named."""
    rows: list[Row] = []
    for seeds in SEEDS:
        for column in ("seen", "right"):
            for share in (0.5, RELIABLE):
                found = _detection_threshold(of_seeds(effects, seeds), column, share, rng)
                rows.append({"seeds": seeds, "found": column, "share": share, **vars(found)})
    return pd.DataFrame(rows)


def detection_table(effects: pd.DataFrame) -> pd.DataFrame:
    """Of each effect alone at 1 to 2.6 of the oracle's threshold: seen and right, with rates; hardest to see first."""
    alone = _powered(effects)
    near = alone[alone["size_in_thresholds"].astype(float).between(*NEAR_THRESHOLD)]
    rows: list[Row] = []
    for effect, group in near.groupby("effect"):
        middle = group["size_in_thresholds"].median()
        for column in ("seen", "right"):
            rows.append({"effect": effect, "found": column, "middle_size": middle, **vars(rate(group[column]))})
    table = pd.DataFrame(rows, columns=["effect", "found", "middle_size", *RATE])
    seen = table[table["found"] == "seen"].set_index("effect")["estimate"]
    return table.sort_values("effect", key=lambda names: names.map(seen), kind="stable", ignore_index=True)


def power_table(effects: pd.DataFrame) -> pd.DataFrame:
    """Share seen and named over `size`, in multiples of the oracle's threshold; see `_found_over`."""
    alone = _powered(effects)
    size = alone["size_in_thresholds"].astype(float)
    middle = size.groupby(pd.cut(size, POWER_BINS), observed=True).transform("median")
    return _found_over(alone, "size", middle)


def strength_table(effects: pd.DataFrame) -> pd.DataFrame:
    """Share seen and named over `strength` (RMS at the tool / noise); see `_found_over`."""
    alone = _powered(effects[effects["category"] == "single"])
    return _found_over(alone, "strength", alone["strength"].astype(float).round(1))


def _groups(table: pd.DataFrame, by: Any, **options: Any) -> Iterator[tuple[str, Any, pd.DataFrame]]:
    """Groups of the worlds of fixed seeds, of fresh ones, of all: seeds, key, rows."""
    for seeds in SEEDS:
        for key, group in of_seeds(table, seeds).groupby(by, **options):
            yield seeds, key, group


def _found_over(effects: pd.DataFrame, name: str, over: pd.Series) -> pd.DataFrame:
    """By seeds and ``over``: found (seen, right), its rate, and how often the oracle finds it."""
    rows: list[Row] = []
    for seeds, at, group in _groups(effects, over):
        for column in ("seen", "right"):
            counted = vars(rate(group[column])) | {"oracle": group["oracle_power"].mean()}
            rows.append({"seeds": seeds, name: at, "found": column} | counted)
    columns = ["seeds", name, "found", "cases", "right", "estimate", "low", "high", "oracle"]
    return pd.DataFrame(rows, columns=columns)


def per_effect_table(cases: Cases) -> pd.DataFrame:
    """Recall, precision, right location and coverage of every effect: effect, seeds, score, cases, right, ..."""
    rows: list[Row] = []
    for seeds in SEEDS:
        for score, effect, right in _per_effect(cases, seeds):
            rows.append({"effect": effect, "seeds": seeds, "score": score, **vars(rate(right))})
    return pd.DataFrame(rows, columns=["effect", "seeds", "score", *RATE])


def _per_effect(cases: Cases, seeds: str) -> Iterator[tuple[str, str, pd.Series]]:
    effects, names, intervals = (of_seeds(t, seeds) for t in (cases.effects, cases.names, cases.intervals))
    clear = ~effects["minor"].astype(bool) & (effects["strength"] >= CLEAR_STRENGTH)
    told = effects["category"].isin((*RIGHT_INPUTS, "outside"))
    held = intervals["category"].isin(RIGHT_INPUTS) & intervals["covered"].notna()
    for score, rows, column in (
        ("recall", effects[clear & told], "right"),
        ("precision", names, "right"),
        ("location", names[names["effect_right"].astype(bool)], "right"),
        ("coverage", intervals[held], "covered"),
        ("scanned number", intervals[intervals["right"].notna()], "right"),
    ):
        for effect, group in rows.groupby("effect"):
            yield score, str(effect), group[column]


def evidence_table(names: pd.DataFrame) -> pd.DataFrame:
    """How often a name is right, by the evidence that the verdict gives it (names of the library, not `unknown`)."""
    named = names[names["effect"] != UNKNOWN]
    bins = pd.cut(named["evidence_nats"].astype(float), EVIDENCE_BINS)
    rows: list[Row] = []
    for seeds, span, group in _groups(named, bins, observed=True):
        rows.append({"seeds": seeds, "evidence_nats": _span(span), **vars(rate(group["right"]))})
    return pd.DataFrame(rows, columns=["seeds", "evidence_nats", *RATE])


def _span(nats: pd.Interval) -> str:
    if nats.left < 0:
        return f"below {nats.right:g}"
    return f"above {nats.left:g}" if np.isinf(nats.right) else f"{nats.left:g} to {nats.right:g}"


def outcomes_table(cases: Cases) -> pd.DataFrame:
    """What became of each category: category, seeds, score, cases, right, estimate, low, high."""
    rows: list[Row] = []
    for seeds, category, group in _groups(cases.worlds, "category", sort=False):
        scores = {name: group[name] for name in OUTCOMES} | {
            "no wrong name": group["wrong_names"] == 0,
            "cannot tell": group["answer"] == "cannot tell",
            "nothing missing": group["answer"] == "nothing missing",
            "failed": group["failed"] != "",
        }
        rows += [{"category": category, "seeds": seeds, "score": s, **vars(rate(v))} for s, v in scores.items()]
    return pd.DataFrame(rows)


def effect_outcomes_table(cases: Cases) -> pd.DataFrame:
    """How the concealed effects of each category ended: category, seeds, outcome, effects, share."""
    story = cases.effects[~cases.effects["minor"].astype(bool)]
    rows: list[Row] = []
    for seeds, category, group in _groups(story, "category", sort=False):
        for outcome, count in group["outcome"].value_counts().items():
            row: Row = {"category": category, "seeds": seeds, "outcome": outcome, "effects": count}
            rows.append(row | {"share": count / len(group)})
    return pd.DataFrame(rows, columns=["category", "seeds", "outcome", "effects", "share"])


def outside_table(cases: Cases) -> pd.DataFrame:
    """Worlds outside the library by shape: shape, seeds, outcome, worlds."""
    outside = cases.worlds[cases.worlds["outside"] != ""]
    tables = [
        of_seeds(outside, seeds).groupby(["shape", "outside"]).size().reset_index(name="worlds").assign(seeds=seeds)
        for seeds in SEEDS
        if len(of_seeds(outside, seeds))
    ]
    columns = ["shape", "seeds", "outside", "worlds"]
    return pd.concat(tables, ignore_index=True)[columns] if tables else pd.DataFrame(columns=columns)


def held_out_table(worlds: pd.DataFrame) -> pd.DataFrame:
    """Held-out RMS over the true model's by category: median, nine in ten, price, share within 5 %."""
    rows: list[Row] = []
    for seeds, category, group in _groups(worlds, "category", sort=False):
        ratio = group["held_out_ratio"]
        rows.append(
            {"category": category, "seeds": seeds, "worlds": len(ratio), "median": ratio.median()}
            | {"nine_in_ten_below": ratio.quantile(0.9, interpolation="higher"), "largest": ratio.max()}
            | {"price_of_fitting": group["price_of_fitting"].median()}
            | {"within_5_percent": float((ratio <= HELD_OUT_TOLERANCE).mean())}
        )
    return pd.DataFrame(rows)


def confusion_table(cases: Cases) -> pd.DataFrame:
    """Counts of (true effect, effect said) at 3x the noise and above with right inputs; acceptable names are true."""
    pairs = cases.pairs
    told = pairs["category"].isin((*RIGHT_INPUTS, "outside", "clean")) & ~pairs["category"].isin(("real", "faint"))
    clear = pairs["weakest"].isna() | (pairs["weakest"] >= CLEAR_STRENGTH)
    return pairs[told & clear].groupby(["true", "said"]).size().reset_index(name="effects")


def false_alarms(cases: Cases) -> pd.DataFrame:
    """Names on clean arms, one row each."""
    clean = cases.names[cases.names["category"] == "clean"]
    columns = ["world", "fresh", "effect", "location", "minor", "evidence_nats", "rms_mm"]
    return clean[columns]


def wrong_worlds(cases: Cases) -> pd.DataFrame:
    """Worlds that are not as they should be: what was concealed and what was said."""
    worlds = cases.worlds
    # a faint effect that nobody names is no failure
    silent = (worlds["category"] == "faint") & (worlds["wrong_names"] == 0) & (worlds["failed"] == "")
    good = worlds["exact"].where(~worlds["category"].isin(ROUGH), worlds["right"])
    wrong = worlds[~good.astype(bool) & ~silent]
    columns = "world category fresh arm rows weakest left_out rough concealed said answer held_out_ratio failed"
    return wrong[columns.split()]


def tables(cases: Cases, seed: int = 0) -> dict[str, pd.DataFrame]:
    """All tables of a proof by name: the cases themselves and every rate. ``cases``: as
    `armscope.proof.scoring.score` returns them."""
    rng = np.random.default_rng(seed)
    return cases.tables() | {
        "aims": aims_table(cases, rng),
        "rough": rough_table(cases.worlds, cases.effects, cases.intervals),
        "per_effect": per_effect_table(cases),
        "evidence": evidence_table(cases.names),
        "power": power_table(cases.effects),
        "strength": strength_table(cases.effects),
        "detection": detection_table(cases.effects),
        "thresholds": thresholds_table(cases.effects, rng),
        "outcomes": outcomes_table(cases),
        "effect_outcomes": effect_outcomes_table(cases),
        "outside": outside_table(cases),
        "held_out": held_out_table(cases.worlds),
        "confusion": confusion_table(cases),
        "false_alarms": false_alarms(cases),
        "wrong_worlds": wrong_worlds(cases),
    }
