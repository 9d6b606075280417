"""The page of a fleet."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from armscope.core.files import write_table, write_yaml
from armscope.fleet.constants import FLEET
from armscope.fleet.members import Member
from armscope.fleet.summary import (
    arms,
    causes_of_arms,
    learned_sizes,
    outliers,
    priors,
    repeated,
    verdicts,
    without_verdict,
)
from armscope.report.figures.fleet import fleet_figure
from armscope.report.html import write_page
from armscope.report.style import save_figure
from armscope.verdict.wording import plain, spelled

TABLE = ["arm", "type", "date", "run", "answer", "before_mm", "after_mm", "headline"]
IN_WORDS = {
    "before_mm": "error of fitted rows (mm)", "after_mm": "with the model (mm)", "apart": "robust sigmas from its type",
    "arms": "arms with it", "of": "of", "median_mm": "median (mm)", "most_mm": "largest (mm)",
    "expected_share": "expected share",
}  # fmt: skip
"""What columns are called on the page; the CSV files keep their names."""
CSS_PX_PER_INCH = 96


def _in_words(table: pd.DataFrame) -> pd.DataFrame:
    """A table for people: columns and causes in words."""
    told = table.assign(cause=table["cause"].map(plain)) if "cause" in table else table
    if {"arms", "of"} <= set(told.columns):  # "2 of 6" is read in one go
        told.insert(list(told.columns).index("arms") + 1, "of", told.pop("of"))
    return told.rename(columns=IN_WORDS)


def write_fleet_page(members: list[Member], folders: list[Path], output: Path) -> None:
    """report.html, arms.csv, causes.csv, repeated.csv and priors.yaml of a fleet.

    Args:
        members: of the fleet.
        folders: with their verdicts.
        output: folder.
    """
    found, failed = verdicts(members, folders)
    of_arms, of_causes = arms(members, found), causes_of_arms(members, found)
    often = repeated(of_causes, of_arms)
    every_row = pd.concat([of_arms, without_verdict(members, failed)], ignore_index=True) if failed else of_arms
    for name, table in (("arms", every_row), ("causes", of_causes), ("repeated", often)):
        write_table(output / f"{name}.csv", table)
    write_yaml(output / "priors.yaml", priors(often, learned_sizes(members, found)))
    drawn = bool(len(of_causes)) and not of_causes["minor"].all()
    wide_px = 0.0
    if drawn:
        figure = fleet_figure(of_causes)
        wide_px = CSS_PX_PER_INCH * figure.get_figwidth()
        save_figure(figure, output / "causes.svg", formats=("svg", "png"))
    write_page(
        output / "report.html",
        "fleet.html.j2",
        arms=_in_words(of_arms[TABLE]),
        outliers=_in_words(outliers(of_arms)[["arm", "type", "date", "before_mm", "after_mm", "apart", "headline"]]),
        common=_in_words(often[(often["expected_share"] > FLEET.common) & (often["arms"] > 1)]),
        repeated=_in_words(often),
        failed=pd.DataFrame(failed.items(), columns=["diagnosis", "why"]),
        figure=output / "causes.svg" if drawn else None,
        wide_px=round(wide_px),
        comparable=bool((of_arms.groupby("type")["arm"].nunique() >= FLEET.fewest_arms).any()),
        fewest=spelled(FLEET.fewest_arms),
        types=spelled(int(of_arms["type"].nunique())),
        limit=FLEET.outlier,
        share=FLEET.common,
    )
