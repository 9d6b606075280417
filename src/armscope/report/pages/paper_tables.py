"""The study's tables as the page shows them: headings in words, units named, yes and no instead of True and False."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pandas as pd

from armscope.core.config import Paper, stated_numbers
from armscope.paper.claims.catalogue import CLAIMS
from armscope.paper.decisive_errors import meaning
from armscope.paper.method import iterations_needed
from armscope.paper.printed import AXES, EQUATIONS, TRAJECTORIES, UNCOMPENSATED, printed_texts
from armscope.report.html import significant
from armscope.report.text.audit import READING_WORDS, Contradictions, is_thorough


@dataclass(frozen=True)
class TableCell:
    """A cell of the rendered Table 2; `marked` where the printed numbers contradict each other."""

    text: str
    marked: bool = False


@dataclass(frozen=True)
class Row:
    """One line of the rendered Table 2."""

    label: str
    cells: tuple[TableCell, ...]
    kind: str


def table2_blocks(table: pd.DataFrame, marks: Contradictions) -> list[tuple[str, list[Row]]]:
    """The rendered Table 2, its "RMS" read as "rss": by model, one line per quantity, one cell per trajectory and
    axis. ``table``: as `armscope.paper.beside_printed` returns it."""
    cells = table[table["axis"].isin(AXES)].set_index(["model", "trajectory", "axis"])
    columns = pd.MultiIndex.from_product([TRAJECTORIES, AXES])
    drawn = table["rss_ensemble_median"].notna().any()
    ours = "rss_ensemble_median" if drawn else "rss_median"
    ratio = "rss_ensemble_ratio" if drawn else "rss_ratio"
    whose = "ours: median of the drawn robots" if drawn else "ours: anchored robot"
    blocks = []
    for model in dict.fromkeys(table["model"]):
        of_model = cells.loc[model].reindex(columns)
        printed = tuple(
            TableCell("–" if pd.isna(value) else f"{value:.1f}", (model, *place) in marks.cells)
            for place, value in of_model["printed"].items()
        )
        rows = [
            Row("printed", printed, "printed"),
            Row(whose, _numbers(of_model, ours), "ours"),
            Row("5–95 % of them", _ranges(of_model, "rss_ensemble_low", "rss_ensemble_high"), "quiet"),
            Row("ours / printed", _numbers(of_model, ratio, "×"), "ratio"),
            Row("anchored robot", _numbers(of_model, "rss_median"), "quiet"),
        ]
        blocks.append((model, [row for row in rows if {cell.text for cell in row.cells} != {"–"}]))
    return blocks


def _numbers(cells: pd.DataFrame, column: str, sign: str = "") -> tuple[TableCell, ...]:
    return tuple(TableCell("–" if pd.isna(value) else f"{sign}{significant(value, 2)}") for value in cells[column])


def _ranges(cells: pd.DataFrame, low: str, high: str) -> tuple[TableCell, ...]:
    pairs = zip(cells[low], cells[high], strict=True)
    return tuple(
        TableCell("–" if pd.isna(first) else f"{significant(first, 2)}–{significant(second, 2)}")
        for first, second in pairs
    )


def anchored_rank(table: pd.DataFrame) -> str:
    """Where the anchored robot ranks among all, in a sentence; "" without an ensemble or FDP(CI)."""
    whole = table[table["axis"] == "3D"].set_index(["model", "trajectory"])
    if whole["rss_ensemble_median"].isna().all() or ("FDP(CI)", "identification") not in whole.index:
        return ""
    first = next(row for place, row in whole.iterrows() if place == ("FDP(CI)", "identification"))
    held = whole.drop(index=UNCOMPENSATED, level="model")
    inside = held["rss_median"].between(held["rss_ensemble_low"], held["rss_ensemble_high"])
    low, middle, high = (significant(first[f"rss_ensemble_{name}"]) for name in ("low", "median", "high"))
    return (
        f"The anchored robot is the most probable one, and not a typical one: what FDP(CI) leaves of its errors on the "
        f"identification poses, {significant(first['rss_median'])} mm, is rank {int(first['rank'])} of "
        f"{int(first['robots'])} (drawn robots, 5–50–95 %: {low}, {middle}, {high} mm), and it lies inside the drawn "
        f"robots' 5–95 % range in {int(inside.sum())} of {len(inside)} cells of the fitted models (3D)."
    )


def needed(history: pd.DataFrame) -> pd.DataFrame:
    """By model and rule, the iterations after which 90 % of the swarms are within 1 % of least squares."""
    table = iterations_needed(history)
    far = "never; " + table["final_excess_percent"].map(lambda excess: significant(excess, 2)) + " % above"
    table["shown"] = table["iterations"].astype("Int64").astype("string").fillna(far)
    wide = table.pivot_table(index="model", columns="rule", values="shown", aggfunc="first", sort=False)
    return wide.rename_axis(columns=None).reset_index()


def method_rows(method: pd.DataFrame) -> pd.DataFrame:
    """Median excess over least squares (%) by basis, layout and update, one column per model."""
    shown = method.assign(
        cell=[
            "–" if pd.isna(median) else f"{_size(median)} ({100 * close:.0f} %)"
            for median, close in zip(method["excess_median"], method["close"], strict=True)
        ]
    )
    keys = ["basis", "layout", "update"]
    wide = shown.pivot_table(index=keys, columns="model", values="cell", aggfunc="first", sort=False)
    return _named(wide)


def _named(by_combination: pd.DataFrame) -> pd.DataFrame:
    """Combinations of basis, layout and update as columns."""
    table = by_combination.rename_axis(columns=None).reset_index()
    return table.assign(basis=table["basis"].replace("qr", "QR"))


def _size(percent: float) -> str:
    return "< 0.01" if percent < 0.01 else significant(percent, 2)


def method_claim_rows(claims: pd.DataFrame) -> pd.DataFrame:
    """Share of the robots (%) for which the claims about the swarm are true, by basis, layout and update."""
    words = {claim.key: claim.claim for claim in CLAIMS}
    shown = claims.assign(
        claim=claims["key"].map(words),
        cell=[
            f"{100 * share:.0f} ({100 * low:.0f}–{100 * high:.0f})"
            for share, low, high in zip(claims["share"], claims["share_low"], claims["share_high"], strict=True)
        ],
    )
    keys = ["basis", "layout", "update"]
    wide = shown.pivot_table(index=keys, columns="claim", values="cell", aggfunc="first", sort=False)
    return _named(wide)


def yes_no(values: pd.Series) -> list[str]:
    """Words for True and False."""
    return ["yes" if bool(value) else "no" for value in values]


def audit_rows(audit: pd.DataFrame) -> pd.DataFrame:
    """The audit in words."""
    return pd.DataFrame(
        {
            "trajectory": audit["trajectory"],
            "“RMS” read as": audit["reading"].map(READING_WORDS),
            "axis": audit["axis"],
            "check": audit["check"],
            "varied": audit["varied"],
            "tried": audit["tried"],
            "some path obeys" if is_thorough(audit) else "some path of those tried obeys": yes_no(audit["possible"]),
            "smallest gap (mm)": audit["best_gap_mm"].astype(float),
        }
    )


def coefficient_rows(table: pd.DataFrame) -> pd.DataFrame:
    """Coefficients of one model; printed ones to the letter."""
    texts = printed_texts()
    keys = zip(table["model"], table["axis"], table["term"], strict=True)
    shown = pd.DataFrame(
        {
            "equation": table["equation"].astype("Int64"),
            "axis": table["axis"],
            "term": table["term"].map(term_words),
            "printed": [texts.get(key, "–") for key in keys],
            "median": table["median"],
            "smallest": table["low"],
            "largest": table["high"],
            "least squares": table["least_squares"],
        }
    )
    return shown if table["printed"].notna().any() else shown.drop(columns=["equation", "printed"])


def term_words(term: str) -> str:
    """A term as formulas have it: "θ1²", "cos 2θ3"."""
    text = term.replace("theta", "θ").replace("^2", "²").replace("^3", "³").replace("^4", "⁴")
    return "constant" if text == "const" else text.replace("px", "x").replace("py", "y").replace("pz", "z")


def untold_rows(table: pd.DataFrame) -> pd.DataFrame:
    """The cross-check in words; printed numbers to the letter."""
    texts = {
        f"Eq. ({EQUATIONS[model] + AXES.index(axis)}), {axis}, {term}": text
        for (model, axis, term), text in printed_texts().items()
    }
    same = ["–" if pd.isna(value) else f"{100 * value:.0f} %" for value in table["same_sign"]]
    return pd.DataFrame(
        {
            "printed number": table["number"].map(lambda text: text.replace("theta", "θ").replace("^2", "²")),
            "unit": table["unit"].str.replace("^2", "²"),
            "printed": [
                texts.get(name, f"{value:.1f}") for name, value in zip(table["number"], table["printed"], strict=True)
            ],
            "anchored": table["anchored"],
            "5 %": table["low"],
            "median": table["median"],
            "95 %": table["high"],
            "robots with its sign": same,
            "inside": yes_no(table["inside"]),
        }
    )


def robot_rows(table: pd.DataFrame) -> pd.DataFrame:
    """The anchored robot's geometric errors in words."""
    return pd.DataFrame(
        {
            "error": table["error"].map(meaning),
            "unit": table["unit"],
            "tolerance": table["tolerance"],
            "anchored robot": table["anchored"],
            "in tolerances": table["anchored_in_sigmas"],
            "drawn robots, median": table["ensemble_median_in_sigmas"],
            "their spread": table["ensemble_std_in_sigmas"],
            "told by the equations": [f"{100 * value:.0f} %" for value in table["information"]],
        }
    )


def assumption_rows(paper: Paper) -> pd.DataFrame:
    """Every stated number with its source."""
    rows: list[dict[str, Any]] = stated_numbers(paper)
    return pd.DataFrame(
        {
            "quantity": [row["quantity"].replace(".", ": ").replace("_", " ") for row in rows],
            "value": [_value(row["value"]) for row in rows],
            "source": [row["source"] for row in rows],
        }
    )


def _value(value: Any) -> str:
    if isinstance(value, tuple | list):
        return ", ".join(f"({_value(each)})" if isinstance(each, tuple | list) else _value(each) for each in value)
    return f"{value:g}" if isinstance(value, float) else str(value)
