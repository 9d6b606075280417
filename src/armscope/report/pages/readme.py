"""The README's numbers, filled from results so that they can't go stale unnoticed."""

from __future__ import annotations

from collections.abc import Hashable
from pathlib import Path
from typing import Any

import pandas as pd

from armscope.core.files import read_table, write_text
from armscope.core.inputs import InputError
from armscope.core.words import table_lines
from armscope.paper.printed import AXES, TRAJECTORIES
from armscope.paper.residuals import SPATIAL
from armscope.report.html import significant
from armscope.report.pages.paper_claims import range_of_shares
from armscope.report.text.audit import audit_sentence


def fill_readme(readme: Path, results: Path, proof: Path) -> None:
    """Replace what stands between the marks of a README by the numbers of finished runs.

    Args:
        readme: the file; it keeps everything outside the marks.
        results: folder with claims.csv, table2.csv and audit.csv.
        proof: folder with the tables of the full proof; where it has none, what the README says of the proof stays.

    Raises:
        InputError: marks are missing.
    """
    claims, table = read_table(results / "claims.csv"), read_table(results / "table2.csv")
    audited = f"*{audit_sentence(read_table(results / 'audit.csv'))}*"
    text = readme.read_text(encoding="utf-8")
    text = filled(text, "results", [*_claim_lines(claims), "", *_table_lines(table), "", audited], readme)
    if (proof / "aims.csv").is_file():
        aims, worlds = read_table(proof / "aims.csv"), read_table(proof / "worlds.csv")
        text = filled(text, "proof", _proof_lines(aims, len(worlds)), readme)
    write_text(readme, text)


def filled(text: str, name: str, lines: list[str], readme: Path) -> str:
    """A text with other lines between two marks.

    Args:
        text: of the page.
        name: of the marks.
        lines: that go between them.
        readme: the page's file, for errors.

    Returns:
        The text with those lines.

    Raises:
        InputError: the marks are missing.
    """
    begin, end = f"<!-- {name}: begin", f"<!-- {name}: end -->"
    if begin not in text or end not in text:
        raise InputError(readme, "", "no marks", f"the numbers go between {begin!r} and {end!r}")
    before, _, rest = text.partition(begin)
    mark, _, rest = rest.partition("\n")
    _, _, after = rest.partition(end)
    block = "\n".join(["", *lines, "", ""])
    return f"{before}{begin}{mark}\n{block}{end}{after}"


def _proof_lines(aims: pd.DataFrame, worlds: int) -> list[str]:
    """The proof's aims on seeds that were drawn when it ran."""
    rows = []
    for row in aims[aims["seeds"] == "fresh"].to_dict("records"):
        if row["aim"].startswith("detection"):
            found = f"{row['estimate']:.1f} ({row['low']:.1f}–{row['high']:.1f})"
        else:
            estimate, low, high = (_percent(row[name]) for name in ("estimate", "low", "high"))
            found = f"{estimate} % ({low}–{high})"
        rows.append((row["aim"], row["cases"], found, row["verdict"]))
    told = (
        f"The diagnosis on {worlds} virtual arms with effects concealed from it, simulated by another engine; "
        "the half whose seeds were drawn when the proof ran, with 95 % intervals:"
    )
    return [told, "", *table_lines(("aim", "cases", "found", ""), rows)]


README_CLAIMS = ("smaller", "as_printed", "alternative", "cartesian_1", "fourier", "remedied", "minimum_data")
"""The claims that a reader of the README is told; all of them stand on the page of the reproduction."""


def _percent(share: float) -> str:
    """In whole percent; with decimals where these would turn nearly all into all, or hardly any into none."""
    percent = 100 * share
    for decimals in range(5):
        text = f"{percent:.{decimals}f}"
        if (percent >= 100 or float(text) < 100) and (percent <= 0 or float(text) > 0):
            return text
    return text


def _claim_lines(claims: pd.DataFrame) -> list[str]:
    robots = int(claims["robots"].dropna().iloc[0])
    told = (
        f"The paper's main claims, on {robots} virtual robots drawn so that its printed Eqs. (15)-(17) come out "
        "(assumed geometry, poses and tolerances): share of the robots for which each is true, with exact 95 % "
        "intervals, and what remains under other assumptions:"
    )
    rows = []
    for key in README_CLAIMS:
        by_method = {row["method"]: row for row in claims[claims["key"] == key].to_dict("records")}
        best = by_method.get("improved", by_method.get("least squares"))
        if best is None or best["verdict"] == "skipped":
            continue
        printed = by_method.get("as printed")
        rows.append((best["claim"], "–" if printed is None else _verdict(printed), _verdict(best), _remains(best)))
    return [told, "", *table_lines(("claim", "method as printed", "improved", "under other assumptions"), rows)]


def _verdict(row: dict[Hashable, Any]) -> str:
    low, high = 100 * row["share_low"], 100 * row["share_high"]
    return f"{row['verdict']}: {100 * row['share']:.0f} % ({low:.0f}–{high:.0f})"


def _remains(row: dict[Hashable, Any]) -> str:
    decided = row["depends_on"] if isinstance(row["depends_on"], str) and row["depends_on"] else ""
    found = f"{row['under_assumptions']}: {decided}" if decided else str(row["under_assumptions"])
    return found if found == "not varied" else f"{found} ({range_of_shares(row)})"


def _table_lines(table: pd.DataFrame) -> list[str]:
    """Table 2 with x, y and z joined to the length of the error vector."""
    printed = table[table["axis"].isin(AXES) & table["printed"].notna()]
    lengths = (printed.set_index(["model", "trajectory"])["printed"] ** 2).groupby(
        level=[0, 1], sort=False
    ).sum() ** 0.5
    whole = table[table["axis"] == SPATIAL].set_index(["model", "trajectory"])
    columns = [f"rss_ensemble_{name}" for name in ("median", "low", "high")]
    ours = {place: [significant(value, 2) for value in row[columns]] for place, row in whole.iterrows()}
    told = (
        "Table 2 in short: median of the drawn robots (5–95 % of them) / printed; length of the x, y, z errors, each "
        "the root of the sum of squares, mm; identification fitted, tests held out:"
    )
    rows = []
    for model in lengths.index.get_level_values(0).unique():
        cells = []
        for name in TRAJECTORIES:
            median, low, high = ours[model, name]
            cells.append(f"{median} ({low}–{high}) / {significant(lengths[model, name], 2)}")
        rows.append((model, *cells))
    return [told, "", *table_lines(("", *TRAJECTORIES), rows)]
