"""The page of a fleet."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from armscope.core.files import write_table, write_yaml
from armscope.fleet.members import Member
from armscope.fleet.summary import (
    COMMON,
    OUTLIER,
    arms,
    causes_of_arms,
    learned_sizes,
    outliers,
    priors,
    repeated,
    verdicts,
)
from armscope.report.figures.fleet import fleet_figure
from armscope.report.html import write_page
from armscope.report.style import save_figure

TABLE = ["arm", "type", "date", "run", "answer", "before_mm", "after_mm", "headline"]


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
    for name, table in (("arms", of_arms), ("causes", of_causes), ("repeated", often)):
        write_table(output / f"{name}.csv", table)
    write_yaml(output / "priors.yaml", priors(often, learned_sizes(members, found)))
    drawn = bool(len(of_causes)) and not of_causes["minor"].all()
    if drawn:
        save_figure(fleet_figure(of_causes), output / "causes.svg", formats=("svg", "png"))
    write_page(
        output / "report.html",
        "fleet.html.j2",
        arms=of_arms[TABLE],
        outliers=outliers(of_arms)[["arm", "type", "date", "before_mm", "after_mm", "apart", "headline"]],
        common=often[(often["expected_share"] > COMMON) & (often["arms"] > 1)],
        repeated=often,
        failed=pd.DataFrame(failed.items(), columns=["diagnosis", "why"]),
        figure=output / "causes.svg" if drawn else None,
        types=int(of_arms["type"].nunique()),
        limit=OUTLIER,
        share=COMMON,
    )
