"""The claims as the page shows them: both methods side by side, and what remains under other assumptions."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from armscope.paper.claims import AS_PRINTED, IMPROVED, LEAST_SQUARES, SKIPPED
from armscope.paper.claims.claim import GROUPS, OWN
from armscope.paper.claims.table import DEPENDS, FAILS, HOLDS, OPEN
from armscope.report.html import significant

TAGS = {HOLDS: "holds", FAILS: "fails", DEPENDS: "depends", OPEN: "open", SKIPPED: "open", "not varied": "open"}


@dataclass(frozen=True)
class Cell:
    """A verdict with what it rests on: text of the tag, its class, and a line below."""

    text: str
    tag: str
    below: str


@dataclass(frozen=True)
class ClaimRow:
    """One claim as a line of the page's table; cells are None where a method does not apply."""

    claim: str
    source: str
    wording: str
    criterion: str
    printed: Cell | None
    improved: Cell
    remains: Cell
    number: str
    number_is: str
    in_table: str
    why: str


def claim_rows(claims: pd.DataFrame, why: pd.DataFrame) -> dict[str, list[ClaimRow]]:
    """By group, the lines of the table of claims. ``claims``: see `armscope.paper.claims.summarise`; ``why``: see
    `armscope.paper.decisive_errors.reasons`."""
    reasons = {(row.key, row.method): str(row.sentence) for row in why.itertuples()}
    rows: dict[str, list[ClaimRow]] = {group: [] for group in GROUPS}
    for key, by_method in claims.groupby("key", sort=False):
        cells = {str(row["method"]): row for _, row in by_method.iterrows()}
        best = cells.get(IMPROVED, cells.get(LEAST_SQUARES))
        assert best is not None
        printed = cells.get(AS_PRINTED)
        rows[str(best["group"])].append(
            ClaimRow(
                claim=str(best["claim"]),
                source=str(best["source"]),
                wording=_text(best["wording"]),
                criterion=str(best["criterion"]),
                printed=None if printed is None else _printed(printed),
                improved=_verdict(best),
                remains=_remains(best),
                number=_number(best),
                number_is=str(best["number_is"]),
                in_table=_in_table(best),
                why=reasons.get((str(key), str(best["method"])), "") if best["verdict"] == DEPENDS else "",
            )
        )
    return {group: mine for group, mine in rows.items() if mine}


def _text(value: object) -> str:
    """Empty cells come as NaN; joints have their Greek letters."""
    return value.replace("theta", "θ") if isinstance(value, str) else ""


def _verdict(row: pd.Series) -> Cell:
    if row["verdict"] == SKIPPED:
        return Cell("skipped", "open", _text(row["why_skipped"]))
    low, high = 100 * float(row["share_low"]), 100 * float(row["share_high"])
    below = f"{int(row['true'])} of {int(row['robots'])} robots ({low:.0f}–{high:.0f} %)"
    return Cell(str(row["verdict"]), TAGS[str(row["verdict"])], below)


def _printed(row: pd.Series) -> Cell:
    """The printed method's verdict, and in a word what other assumptions make of it."""
    cell = _verdict(row)
    if row["under_assumptions"] == "not varied":
        return cell
    decided = f": {_text(row['depends_on'])}" if _text(row["depends_on"]) else ""
    elsewhere = f"under other assumptions: {row['under_assumptions']}{decided}, {range_of_shares(row)}"
    return Cell(cell.text, cell.tag, f"{cell.below}; {elsewhere}")


def range_of_shares(row: Mapping[Hashable, Any] | pd.Series) -> str:
    """The least and the largest share of the robots over all scenarios, %."""
    least, most = (f"{100 * float(row[name]):.0f}" for name in ("share_least", "share_most"))
    return f"{least} %" if least == most else f"{least}–{most} %"


def _remains(row: pd.Series) -> Cell:
    """What remains of the improved method's verdict when the assumptions change."""
    found = str(row["under_assumptions"])
    if found == "not varied":
        return Cell("not varied", "open", "see config/thorough.yaml")
    moved = f"; moved most by {_text(row['moved_by'])}" if _text(row["moved_by"]) else ""
    seen = f"{range_of_shares(row)} of the robots in {int(row['scenarios'])} scenarios"
    if found.endswith("under all"):
        return Cell(found, "holds" if found.startswith(HOLDS) else "fails", seen + moved)
    if _text(row["depends_on"]):
        return Cell(f"{found}: {_text(row['depends_on'])}", "depends", seen)
    return Cell(found, TAGS[found], seen + moved)


def _number(row: pd.Series) -> str:
    """A claim's number with its range over the robots; what is nothing in practice is not spelled out."""
    if pd.isna(row.get("number", np.nan)):
        return "–"
    unit = f" {row['unit']}" if _text(row["unit"]) else ""
    if unit == " %" and abs(float(row["number_high"])) < 0.01:
        return "under 0.01 %"
    number, low, high = _sized([float(row[name]) for name in ("number", "number_low", "number_high")])
    return f"{number}{unit}" if low == high else f"{number}{unit} ({low}–{high})"


def _in_table(row: pd.Series) -> str:
    """The same number from the printed Table 2."""
    if pd.isna(row["number_printed"]):
        return "–"
    unit = f" {row['unit']}" if _text(row["unit"]) else ""
    return f"{_sized([float(row['number_printed'])])[0]}{unit}"


def _sized(values: Sequence[float]) -> list[str]:
    """Numbers in the same form: counts without decimals."""
    counts = all(value.is_integer() for value in values if np.isfinite(value))
    words = [f"{value:.0f}" if counts else "≈ 0" if 0 < abs(value) < 1e-4 else significant(value) for value in values]
    return [word if np.isfinite(value) else "∞" for word, value in zip(words, values, strict=True)]


@dataclass(frozen=True)
class FirstScreen:
    """The claims of the paper by what became of them, in words."""

    count: int
    printed_holds: list[str]
    printed_fails: list[str]
    printed_moved: list[str]
    always_holds: list[str]
    always_fails: list[str]
    improved_depends: list[str]


def first_screen(claims: pd.DataFrame) -> FirstScreen:
    """What holds under the printed method, and what under any assumption that was tried."""
    own = claims[claims["group"] == OWN]
    printed = own[own["method"] == AS_PRINTED]
    improved = own[own["method"] != AS_PRINTED]

    def named(rows: pd.DataFrame) -> list[str]:
        return [_lower(str(claim)) for claim in rows["claim"]]

    under = improved["under_assumptions"]
    return FirstScreen(
        count=int(own["key"].nunique()),
        printed_holds=named(printed[printed["verdict"] == HOLDS]),
        printed_fails=named(printed[printed["verdict"] == FAILS]),
        printed_moved=named(printed[printed["under_assumptions"] == "depends on the assumption"]),
        always_holds=named(improved[under == f"{HOLDS} under all"]),
        always_fails=named(improved[under == f"{FAILS} under all"]),
        improved_depends=named(improved[under.isin([DEPENDS, "depends on the assumption"])]),
    )


def _lower(text: str) -> str:
    """A sentence inside a list; names keep their capitals."""
    keeps = ("Fourier", "Cartesian", "SDP", "FDP")
    return text if text.startswith(keeps) else text[:1].lower() + text[1:]


def sensitivity_table(claims: pd.DataFrame, sensitivity: pd.DataFrame) -> tuple[pd.DataFrame, Sequence[str]]:
    """Share of the robots for which each of the paper's claims is true, by scenario (improved method). Returns
    (table in per cent, the scenarios in words in the order of its columns)."""
    own = claims[(claims["group"] == OWN) & (claims["method"] != AS_PRINTED) & claims["share"].notna()]
    wide = (
        sensitivity[sensitivity["method"] != AS_PRINTED]
        .assign(percent=100 * sensitivity["share"])
        .pivot_table(index="key", columns="scenario", values="percent", sort=False)
        .reindex(own["key"])
    )
    first = sensitivity.drop_duplicates("scenario")
    words = {row["scenario"]: _text(f"{row['factor']}: {row['level']}") for _, row in first.iterrows()}
    table = pd.DataFrame({"claim": own["claim"].to_numpy(), "configured": _percent(100 * own["share"])})
    for number, scenario in enumerate(wide.columns, start=1):
        table[str(number)] = _percent(wide[scenario])
    return table, [words[str(name)] for name in wide.columns]


def _percent(values: pd.Series) -> list[str]:
    return ["–" if pd.isna(value) else f"{value:.0f}" for value in values]
