"""The README's numbers, filled from results so that they can't go stale unnoticed."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from armscope.core.files import read_table, write_text
from armscope.core.inputs import InputError
from armscope.paper.printed import AXES, TRAJECTORIES
from armscope.paper.residuals import SPATIAL
from armscope.report.html import significant

BEGIN, END = "<!-- results: begin", "<!-- results: end -->"


def fill_readme(readme: Path, results: Path, proof: Path) -> None:
    """Replace what stands between the two marks of a README by the numbers of a finished run.

    Args:
        readme: the file; it keeps everything outside the marks.
        results: folder with claims.csv and table2.csv.
        proof: folder with the tables of the full proof.

    Raises:
        InputError: the marks are missing.
    """
    text = readme.read_text(encoding="utf-8")
    if BEGIN not in text or END not in text:
        raise InputError(readme, "", "no marks", f"the numbers go between {BEGIN!r} and {END!r}")
    before, _, rest = text.partition(BEGIN)
    mark, _, rest = rest.partition("\n")
    _, _, after = rest.partition(END)
    claims, table = read_table(results / "claims.csv"), read_table(results / "table2.csv")
    aims, worlds = read_table(proof / "aims.csv"), read_table(proof / "worlds.csv")
    block = "\n".join(
        ["", *_proof_lines(aims, len(worlds)), "", *_claim_lines(claims), "", *_table_lines(table), "", ""]
    )
    write_text(readme, f"{before}{BEGIN}{mark}\n{block}{END}{after}")


def _proof_lines(aims: pd.DataFrame, worlds: int) -> list[str]:
    """The proof's aims on seeds that were drawn when it ran."""
    lines = [
        f"The diagnosis on {worlds} virtual arms with effects concealed from it, simulated by another engine; "
        "the half whose seeds were drawn when the proof ran, with 95 % intervals:",
        "",
        "| aim | cases | found | |",
        "|---|---|---|---|",
    ]
    for row in aims[aims["seeds"] == "fresh"].to_dict("records"):
        if row["aim"].startswith("detection"):
            found = f"{row['estimate']:.1f} ({row['low']:.1f}–{row['high']:.1f})"
        else:
            estimate, low, high = (_percent(row[name]) for name in ("estimate", "low", "high"))
            found = f"{estimate} % ({low}–{high})"
        lines.append(f"| {row['aim']} | {row['cases']} | {found} | {row['verdict']} |")
    return lines


def _percent(share: float) -> str:
    """In whole percent; with decimals where these would turn nearly all into all, or hardly any into none."""
    percent = 100 * share
    for decimals in range(5):
        text = f"{percent:.{decimals}f}"
        if (percent >= 100 or float(text) < 100) and (percent <= 0 or float(text) > 0):
            return text
    return text


def _claim_lines(claims: pd.DataFrame) -> list[str]:
    lines = [
        f"The paper's claims, on {claims['robots'].iloc[0]} virtual robots that agree with its printed Eqs. (15)-(17) "
        "(assumed geometry, poses and tolerances):",
        "",
        "| claim | verdict | robots for which it is true |",
        "|---|---|---|",
    ]
    rows = claims[["claim", "verdict", "share_of_robots"]].to_dict("records")
    return lines + [f"| {row['claim']} | {row['verdict']} | {100 * row['share_of_robots']:.0f} % |" for row in rows]


def _table_lines(table: pd.DataFrame) -> list[str]:
    """Table 2 with x, y and z joined to the length of the error vector."""
    printed = table[table["axis"].isin(AXES) & table["printed"].notna()]
    lengths = (printed.set_index(["model", "trajectory"])["printed"] ** 2).groupby(
        level=[0, 1], sort=False
    ).sum() ** 0.5
    ours = table[table["axis"] == SPATIAL].set_index(["model", "trajectory"])["rss_median"]
    lines = [
        "Table 2 in short, ours / printed (3D, root of the sum of squares in mm; anchored robot, median over seeds):",
        "",
        "| | " + " | ".join(TRAJECTORIES) + " |",
        "|---|" + "---|" * len(TRAJECTORIES),
    ]
    for model in lengths.index.get_level_values(0).unique():
        cells = [
            f"{significant(ours[model, name], 2)} / {significant(lengths[model, name], 2)}" for name in TRAJECTORIES
        ]
        lines.append(f"| {model} | {' | '.join(cells)} |")
    return lines
