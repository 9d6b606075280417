"""The page of the proof: what the diagnosis finds, what it misses, what it gets wrong, beside what was aimed at."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd

from armscope.proof import definitions as proof_definitions
from armscope.proof.rates import NEAR_THRESHOLD
from armscope.report.html import definitions, share_text, significant, write_page
from armscope.verdict.wording import plain

TAGS = {"met": "holds", "not met": "fails", "open": "depends", "too few cases": "depends"}
SHOWN_WRONG = 400
IN_WORDS = {
    "estimate": "share", "low": "95 % from", "high": "95 % to", "found": "found as", "fresh": "fresh seeds",
    "exact_story": "exact, minor names aside", "silent": "no name given", "value": "size",
    "held_out_close": "held-out error within 5 % of the true model's", "within_5_percent": "share within 5 %",
    "evidence_nats": "evidence (nats)", "nine_in_ten_below": "nine in ten below", "rms_mm": "RMS (mm)",
    "price_of_fitting": "price of fitting", "held_out_ratio": "held out / true", "weakest": "weakest / noise",
    "left_out": "column left out", "failed": "why it failed",
}  # fmt: skip
"""What columns are called on the page; the CSV files keep their names."""


def write_proof_page(path: Path, tables: Path, figures: Path, seed: dict[str, Any], size: str) -> None:
    """Write the report of a proof.

    Args:
        path: report.html.
        tables: folder of the tables that `armscope proof score` writes.
        figures: folder of the figures (SVG).
        seed: `proof_seed`, and whether it was `drawn`.
        size: small or full.
    """
    read = {file.stem: pd.read_csv(file) for file in sorted(tables.glob("*.csv")) if file.stat().st_size > 1}
    worlds = read["worlds"]
    write_page(
        path,
        "proof.html.j2",
        figures=figures,
        size=size,
        seed=seed,
        worlds=worlds,
        fresh=int(worlds["fresh"].sum()),
        failed=_in_words(worlds[worlds["failed"].notna()][["world", "category", "failed"]]),
        aims=_aims(read["aims"]),
        tags=TAGS,
        summary=_summary(read["aims"]),
        definitions=definitions(proof_definitions.__doc__ or ""),
        per_effect=_in_words(_wide(read["per_effect"], "effect")),
        rough=_rough(read["rough"]),
        outcomes=_in_words(_wide(read["outcomes"], "category")),
        thresholds=_in_words(read["thresholds"]),
        detection=_in_words(_detection(read["detection"])),
        near=NEAR_THRESHOLD,
        held_out=_in_words(read["held_out"]),
        evidence=_in_words(read["evidence"]),
        false_alarms=_in_words(read["false_alarms"]),
        wrong=_wrong(read["wrong_worlds"]),
        significant=significant,
    )


def _in_words(table: pd.DataFrame) -> pd.DataFrame:
    """A table for people: columns and causes in words."""
    told = table.assign(effect=table["effect"].map(plain)) if "effect" in table else table
    if "fresh" in told:
        told = told.assign(fresh=["yes" if fresh else "no" for fresh in told["fresh"]])
    return told.rename(columns=IN_WORDS)


def _aims(table: pd.DataFrame) -> list[dict[str, Any]]:
    """One entry per aim: what it asks for, and fixed and fresh results."""
    entries = []
    for text, group in table.groupby("aim", sort=False):
        half = {str(row["seeds"]): {str(k): v for k, v in row.items()} for row in group.to_dict("records")}
        first = next(iter(half.values()))
        percent = first["most"] <= 1
        entries.append(
            {"text": text, "goal": _goal(first["least"], first["most"], percent)}
            | {name: _result(half[name], percent) for name in ("fresh", "fixed", "all")}
        )
    return entries


def _goal(least: float, most: float, percent: bool) -> str:
    if not percent:
        return f"≤ {most:g}"
    if least == most:
        return f"{least:.0%}"
    return f"≥ {least:.0%}" if most == 1 else f"{least:.0%} – {most:.0%}"


def _result(row: dict[str, Any], percent: bool) -> dict[str, str]:
    if pd.isna(row["estimate"]):
        return {"value": "–", "interval": "", "cases": f"{row['cases']:.0f}", "verdict": row["verdict"]}
    value, interval = (
        (f"{row['estimate']:.1%}", f"{row['low']:.0%} – {row['high']:.0%}")
        if percent
        else (f"{row['estimate']:.2f}", f"{row['low']:.2f} – {row['high']:.2f}")
    )
    return {"value": value, "interval": interval, "cases": f"{row['cases']:.0f}", "verdict": row["verdict"]}


def _summary(table: pd.DataFrame) -> str:
    """How many aims are met on fresh seeds, in words."""
    verdicts = table[table["seeds"] == "fresh"]["verdict"].value_counts()
    order = ("met", "open", "not met", "too few cases")
    words = {"met": "met", "open": "open", "not met": "not met", "too few cases": "without enough cases to say"}
    return ", ".join(f"{verdicts[name]} {words[name]}" for name in order if name in verdicts)


def _wide(table: pd.DataFrame, index: str) -> pd.DataFrame:
    """Scores as columns: share, right and cases of all seeds together and of the fresh ones."""
    text = table.assign(
        cell=[share_text(*row) for row in table[["estimate", "right", "cases"]].itertuples(index=False)]
    )
    pieces = []
    for seeds in ("fresh", "fixed"):
        chosen = text[text["seeds"] == seeds]
        wide = chosen.pivot_table(index=index, columns="score", values="cell", aggfunc="first", sort=False)
        pieces.append(wide.assign(seeds=seeds).reset_index())
    both = pd.concat(pieces).sort_values([index, "seeds"], kind="stable")
    return both[[index, "seeds", *[column for column in both.columns if column not in (index, "seeds")]]]


def _rough(table: pd.DataFrame) -> pd.DataFrame:
    """One row per family and score: fresh and fixed seeds and both, each with cases and interval."""
    counted = (table[name] for name in ("estimate", "right", "cases", "low", "high"))
    shown = table.assign(
        cell=[
            f"{100 * share:.0f} % ({right:.0f}/{cases:.0f}; {100 * low:.0f}–{100 * high:.0f} %)"
            for share, right, cases, low, high in zip(*counted, strict=True)
        ]
    )
    wide = shown.pivot_table(index=["family", "score"], columns="seeds", values="cell", aggfunc="first", sort=False)
    return wide.reindex(columns=["fresh", "fixed", "all"]).fillna("–").reset_index()


def _detection(table: pd.DataFrame) -> pd.DataFrame:
    """One row per effect: how many were seen and how many named, with intervals."""
    pieces = {
        word: table[table["found"] == found].set_index("effect")
        for word, found in (("seen", "seen"), ("named", "right"))
    }
    seen = pieces["seen"]
    shown = pd.DataFrame({"cases": seen["cases"], "median size": seen["middle_size"].round(2)})
    for word, piece in pieces.items():
        bounds = zip(piece["low"], piece["high"], strict=True)
        shown[word] = piece["right"]
        shown[f"share {word}, 95 % interval"] = [f"{100 * low:.0f} – {100 * high:.0f} %" for low, high in bounds]
    return shown.reset_index()


def _wrong(table: pd.DataFrame) -> pd.DataFrame:
    """Worlds with a wrong answer, readable."""
    shown = table.drop(columns=[column for column in ("failed",) if table[column].isna().all()])
    return _in_words(shown.head(SHOWN_WRONG))
