"""Sweeps as curves with their spread over seeds."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from armscope.report.style import BLUE, GREEN, GREY, ORANGE, VERMILION, legend_above, panel_grid, styled

COLOURS = (BLUE, VERMILION, GREEN, ORANGE)
MARKERS = "osD^"


def sweeps(table: pd.DataFrame) -> Figure:
    """One panel per sweep: 3D RMS error left over on each set, median and range over seeds, and least squares.
    ``table``: rows of `armscope.paper.sweep.run_variant` for all variants."""
    names = list(dict.fromkeys(table["sweep"]))
    with styled():
        figure, panels = panel_grid(len(names), 3, (3.4, 2.7))
        for panel, name in zip(panels, names, strict=True):
            _draw(panel, table[table["sweep"] == name])
            model = table.loc[table["sweep"] == name, "model"]
            panel.set(title=model.iloc[0] if model.nunique() == 1 else "", xlabel=name, yscale="log")
            panel.margins(x=0.12)
            panel.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            panel.yaxis.set_major_formatter("{x:g}")
            panel.yaxis.set_minor_formatter(NullFormatter())
        figure.supylabel("3D RMS error left (mm)")
        legend_above(figure, columns=5)
    return figure


def _draw(panel: Axes, table: pd.DataFrame) -> None:
    values = list(dict.fromkeys(table["varied"]))
    places = np.arange(len(values))
    ordered = pd.to_numeric(table["varied"], errors="coerce").notna().all()
    line = "-" if ordered else ""
    for (trajectory, rows), colour, marker in zip(
        table.groupby("trajectory", sort=False), COLOURS, MARKERS, strict=False
    ):
        spread = rows.groupby("varied", sort=False)["rms_mm"].agg(["median", "min", "max"]).reindex(values)
        optimum = rows.groupby("varied", sort=False)["least_squares_mm"].first().reindex(values)
        if ordered:
            panel.fill_between(places, spread["min"], spread["max"], color=colour, alpha=0.2, linewidth=0)
        else:
            panel.vlines(places, spread["min"], spread["max"], color=colour, alpha=0.4, linewidth=5)
        panel.plot(places, spread["median"], line, marker=marker, markersize=4, color=colour, label=str(trajectory))
        panel.plot(places, optimum, color=colour, linestyle=":", linewidth=0.9)
    panel.plot([], [], color=GREY, linestyle=":", label="least squares")
    panel.set_xticks(places, [str(value) for value in values])
