"""Why claims depend on the robot: the number of each against the geometric error that decides it most."""

from __future__ import annotations

import textwrap

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FormatStrFormatter, MaxNLocator, NullFormatter

from armscope.paper.claims import IMPROVED
from armscope.paper.claims.catalogue import CLAIMS
from armscope.paper.decisive_errors import SPEAKS_FROM, meaning
from armscope.report.style import BLUE, VERMILION, legend_above, panel_grid, styled

COLUMNS = 3


def why_figure(reasons: pd.DataFrame, per_robot: pd.DataFrame, geometric: pd.DataFrame) -> Figure:
    """One small picture per claim that depends on the robot by the improved method.

    Args:
        reasons: see `armscope.paper.decisive_errors.reasons`.
        per_robot: outcome per claim, method and robot.
        geometric: one row per drawn robot, columns robot and each geometric error in tolerances.

    Returns:
        The figure.
    """
    told = reasons[(reasons["method"] == IMPROVED) & (reasons["share"] >= SPEAKS_FROM) & (reasons["errors"] != "")]
    told = told.dropna(subset=["errors"])
    with styled():
        figure, panels = panel_grid(len(told), COLUMNS, (3.2, 2.7))
        for panel, (_, reason) in zip(panels, told.iterrows(), strict=True):
            mine = per_robot[(per_robot["key"] == reason["key"]) & (per_robot["method"] == IMPROVED)]
            _draw(panel, reason, mine, geometric)
        if len(told):
            legend_above(figure, columns=2)
        else:
            figure.text(0.5, 0.5, "No claim is decided by few geometric errors.", ha="center")
    return figure


def _draw(panel: Axes, reason: pd.Series, outcome: pd.DataFrame, geometric: pd.DataFrame) -> None:
    first = str(reason["errors"]).partition(", ")[0]
    joined = outcome.merge(geometric[["robot", first]], on="robot")
    numbers = joined["number"].to_numpy(dtype=float)
    for true, colour, marker, label in ((True, BLUE, "o", "true of the robot"), (False, VERMILION, "x", "not true")):
        chosen = joined["true"].astype(bool).to_numpy() == true
        panel.scatter(joined.loc[chosen, first], numbers[chosen], color=colour, marker=marker, s=16, label=label)
    positive = bool((numbers > 0).all() and np.ptp(np.log10(np.maximum(numbers, 1e-300))) > 0)
    if positive:
        panel.set_yscale("log")
        panel.yaxis.set_major_locator(MaxNLocator(4))
        panel.yaxis.set_major_formatter(FormatStrFormatter("%.3g"))
        panel.yaxis.set_minor_formatter(NullFormatter())
    claim = next(each for each in CLAIMS if each.key == reason["key"])
    panel.set_title(textwrap.fill(claim.claim, 38), fontsize=8)
    panel.set_xlabel(f"{meaning(first)} (tolerances)", fontsize=8)
    panel.set_ylabel(claim.number_is.split(",")[0].split(" of the")[0], fontsize=7)
