"""The page of the concealment on real recordings."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from armscope.real import scoring
from armscope.report.html import definitions, share_text, write_page
from armscope.report.pages.real_concealed import SCORES, withheld_table


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
