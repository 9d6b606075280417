"""Chosen poses beside random ones and a grid: observability, and the errors that are left."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from armscope.design.indices import SOURCES
from armscope.report.style import BLUE, GREEN, GREY, ORANGE, SKY, legend_above, styled

COLOURS = {"chosen": BLUE, "random": ORANGE, "grid": GREEN}
MARKERS = {"chosen": "D", "random": "o", "grid": "s"}
OTHERS = SKY, "^"  # Colour and marker of choices by other criteria


def choice_figure(table: pd.DataFrame, title: str) -> Figure:
    """Three panels: O1 to O5 relative to random poses; error of the parameters; error at poses that took no part.
    ``table``: see `armscope.poses.compare.compare`."""
    with styled():
        figure, (indices, parameters, held_out) = plt.subplots(
            1, 3, figsize=(9.2, 3.1), gridspec_kw={"width_ratios": [1.5, 1, 1]}
        )
        random = table[table["set"] == "random"]
        for number, kind in enumerate(COLOURS):
            here = table[table["set"] == kind]
            ratios = (here[list(SOURCES)] / random[list(SOURCES)].median()).to_numpy(dtype=float)
            places = np.arange(len(SOURCES), dtype=float) + 0.22 * (number - 1)
            _ranges(indices, places, ratios, kind)
        indices.axhline(1, color=GREY, linewidth=0.8, linestyle=":")
        indices.set_xticks(range(len(SOURCES)), list(SOURCES))
        indices.set_yscale("log")
        indices.yaxis.set_major_formatter("{x:g}")
        indices.yaxis.set_minor_formatter("{x:g}")
        indices.set_ylabel("index / median of random poses")
        _by_set(parameters, table, "parameter_rms_mm", "error of the parameters\n(mm at the tool, RMS)")
        _by_set(held_out, table, "held_out_rms_mm", "error at poses that took no part\n(mm, 3D RMS)")
        indices.set_title(title, loc="left", fontsize="small")
        legend_above(figure, columns=3)
    return figure


def _ranges(panel: Axes, places: NDArray[np.float64], values: NDArray[np.float64], kind: str) -> None:
    """Medians with 5 to 95 % of the seeds."""
    low, middle, high = np.quantile(values, [0.05, 0.5, 0.95], axis=0)
    colour, marker = COLOURS.get(kind, OTHERS[0]), MARKERS.get(kind, OTHERS[1])
    label = f"{kind}: median, 5-95 % of seeds"
    panel.errorbar(
        places, middle, [middle - low, high - middle], fmt=marker, color=colour, markersize=4.5, capsize=2, label=label
    )


def _by_set(panel: Axes, table: pd.DataFrame, column: str, label: str) -> None:
    kinds = list(table["set"].unique())
    for place, kind in enumerate(kinds):
        values = table.loc[table["set"] == kind, [column]].to_numpy(dtype=float)
        _ranges(panel, np.array([float(place)]), values, kind)
    names = [kind if kind in COLOURS else f"by {kind}" for kind in kinds]
    panel.set_xticks(range(len(kinds)), names, rotation=0 if len(kinds) < 4 else 35)
    panel.set_xlim(-0.6, len(kinds) - 0.4)
    panel.set_ylim(bottom=0)
    panel.set_ylabel(label)
