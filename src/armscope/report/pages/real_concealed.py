"""docs/real-concealed.md: known effects concealed in recordings of real arms, and how often they were found."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from armscope.core.files import write_text
from armscope.core.words import table_lines
from armscope.real import scoring
from armscope.report.html import definitions, share_text, significant, write_page

HEAD = """\
# Known effects concealed in recordings of real arms

<!-- written by `snakemake -j1 real_concealed` from results; edits here are lost -->"""
CONCEALMENT = """\
One known effect at a time, added to [the recordings](real-arms.md) behind a seal at 0.5, 1 and 3 times what each
arm's own diagnosis leaves, on top of all the arm does (`snakemake -j2 proof_real`; definitions and figures in its
report):"""
WITHHELD = """\
The same recordings without the columns that say how loaded the arm was: is it still found to give way? Where drives and
bearings are not told apart, they give way without a name, among the small errors everywhere."""
SCORES = {
    "found": "found",
    "right_place": "right place",
    "covered": "interval holds",
    "quiet": "no new name",
    "none_unheard_of": "none that was not listed",
}
LISTED = """\
A new name is one that the arm's own verdict does not have; in the last column, one that it does not even list as what
one of its names could be in place of."""


def write_concealment(path: Path, proof: Path, titles: Mapping[str, str], of: str) -> None:
    """Write how often known effects that were added to recordings were found, and what is found with less recorded.

    Args:
        path: where to.
        proof: folder of the tables of `armscope real score`.
        titles: what to call each arm.
        of: what the results are of: a commit.
    """
    rates = pd.read_csv(proof / "rates.csv")
    rates = rates[rates["half"] == "both"]
    there = set(rates[rates["by"] == "arm"]["of"])
    missing = [title for name, title in titles.items() if name not in there]
    lines = [HEAD, "", f"Measured at {of}.", "", CONCEALMENT, ""]
    lines += _rates(rates, [("all", "all"), *(("arm", name) for name in titles)], titles, "arm")
    lines += ["", *_rates(rates, [("effect", name) for name in sorted(rates[rates["by"] == "effect"]["of"].unique())])]
    lines += ["", LISTED]
    if missing:
        lines += ["", f"Not run for this page: {', '.join(missing)}."]
    skipped = pd.read_csv(proof / "skipped.csv")
    if len(skipped):
        lines += [
            "",
            "Not planted, because nobody could find it or no real arm has it:",
            "",
            *_not_planted(skipped, titles),
        ]
    write_text(path, "\n".join([*lines, *_withheld(proof, titles)]) + "\n")


def _not_planted(skipped: pd.DataFrame, titles: Mapping[str, str]) -> list[str]:
    """A row per effect, arm and reason, with the sizes at which it holds."""
    rows = []
    for (effect, name, reason), group in skipped.groupby(["effect", "set", "reason"], sort=True):
        sizes = ", ".join(f"{size:g}" for size in sorted(group["size"].unique()))
        rows.append((str(effect).replace("_", " "), titles.get(str(name), str(name)), sizes, str(reason)))
    return table_lines(["effect", "arm", "size", "why"], rows)


def _rates(
    rates: pd.DataFrame, groups: list[tuple[str, str]], titles: Mapping[str, str] | None = None, head: str = "effect"
) -> list[str]:
    rows = []
    for by, of in groups:
        mine = rates[(rates["by"] == by) & (rates["of"] == of)]
        for size, group in mine.groupby("size"):
            cells = group[["score", "estimate", "right", "cases"]].itertuples(index=False)
            shares = {score: share_text(*numbers) for score, *numbers in cells}
            shown = [shares.get(score, "–") for score in SCORES]
            name = (titles or {}).get(of, of.replace("_", " "))
            rows.append((name, f"{size:g}", *shown))
    return table_lines([head, "size", *SCORES.values()], rows)


def _withheld(proof: Path, titles: Mapping[str, str]) -> list[str]:
    path = proof / "withheld.csv"
    if path.stat().st_size <= 1:
        return []
    table = withheld_table(pd.read_csv(path), titles)
    return ["", WITHHELD, "", *table_lines([str(name) for name in table], table.itertuples(index=False))]


def withheld_table(table: pd.DataFrame, titles: Mapping[str, str]) -> pd.DataFrame:
    """What is still found without columns, row by row, in words."""
    if table.empty:
        return table
    follows = table["follows_load"].astype(str).str.replace("_", " ").where(table["load_found"].astype(bool), "nothing")
    everywhere, held_out = (table[name].astype(float).map(significant) for name in ("background_mm", "held_out_mm"))
    return pd.DataFrame(
        {
            "arm": [titles.get(str(name), name) for name in table["set"]],
            "rows": table["rows"].map({"run": "all joints move", "payloads": "three payloads"}),
            "learned from": table["orientations"].map({True: "points and orientations", False: "points"}),
            "withheld": table["withheld"],
            "follows the load": follows,
            "joint compliance by name": table["compliance_found"].map({True: "yes", False: "no"}),
            "small errors everywhere (mm)": everywhere,
            "held out (mm, 3D)": held_out,
        }
    )


def write_real_proof_page(
    path: Path, tables: Mapping[str, pd.DataFrame], figures: Path, seed: Mapping[str, Any], titles: Mapping[str, str]
) -> None:
    """Write report.html.

    Args:
        path: where to.
        tables: of `armscope real score`.
        figures: folder of the figures.
        seed: `proof_seed`, and whether it was `drawn`.
        titles: what to call each set.
    """
    cases = tables["cases"]
    levels = cases.groupby("set")["level_mm"].first().rename(lambda name: titles.get(name, name))
    write_page(
        path,
        "real_proof.html.j2",
        figures=figures,
        seed=seed,
        cases=len(cases),
        arms=", ".join(levels.index),
        levels=levels.rename_axis("arm").rename("leaves (mm per axis)").reset_index(),
        by_size=_wide(tables["rates"], "all", titles).drop(columns="of"),
        by_effect=_wide(tables["rates"], "effect", titles),
        by_arm=_wide(tables["rates"], "arm", titles),
        held_out=_titled(tables["held_out"], titles),
        withheld=withheld_table(tables["withheld"], titles),
        skipped=_titled(tables["skipped"], titles),
        wrong=_wrong(cases, titles),
        failed=int(cases["failed"].notna().sum()),
        definitions=definitions(scoring.__doc__ or ""),
    )  # fmt: skip


def _titled(table: pd.DataFrame, titles: Mapping[str, str]) -> pd.DataFrame:
    return table.assign(set=[titles.get(name, name) for name in table["set"]]).rename(columns={"set": "arm"})


def _wide(rates: pd.DataFrame, by: str, titles: Mapping[str, str]) -> pd.DataFrame:
    """One row per value and size: share (right/cases) of both halves together."""
    mine = rates[(rates["by"] == by) & (rates["half"] == "both")]
    cells = [share_text(*row) for row in mine[["estimate", "right", "cases"]].itertuples(index=False)]
    mine = mine.assign(cell=cells, score=mine["score"].map(SCORES), of=[titles.get(name, name) for name in mine["of"]])
    wide = mine.pivot_table(index=["of", "size"], columns="score", values="cell", aggfunc="first").reset_index()
    kept = [name for name in SCORES.values() if name in wide.columns]
    return wide.fillna("–")[["of", "size", *kept]].assign(of=wide["of"].str.replace("_", " "))


def _wrong(cases: pd.DataFrame, titles: Mapping[str, str]) -> pd.DataFrame:
    chosen = cases[~cases["found"] | (cases["new_names"] > 0)]
    columns = ["arm", "half", "effect", "location", "size", "outcome", "said", "new", "alternatives"]
    return _titled(chosen, titles)[columns].sort_values(["size", "arm", "effect"], ascending=[False, True, True])
