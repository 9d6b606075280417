"""What compensation leaves: model by trajectory, predicted and in closed loop."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from armscope.compensation.closed_loop import NO_MODEL
from armscope.report.style import BLUE, GREEN, GREY, ORANGE, SKY, VERMILION, legend_above, styled


def cross_table_figure(table: pd.DataFrame) -> Figure:
    """One panel per trajectory, one row per model: errors predicted to remain, and what the virtual arm really kept.
    ``table``: see `armscope.compensation.closed_loop.cross_table`."""
    spatial = table[table["axis"] == "3D"]
    trajectories = [name for name in spatial["trajectory"].unique() if name != "identification"]
    models = [NO_MODEL, *(name for name in spatial["model"].unique() if name != NO_MODEL)]
    rows = np.arange(len(models))[::-1]
    with styled():
        figure, panels = plt.subplots(
            1, len(trajectories), figsize=(3.1 * len(trajectories) + 1.4, 0.34 * len(models) + 1.5), sharex=True,
            sharey=True, squeeze=False,
        )  # fmt: skip
        for panel, trajectory in zip(panels[0], trajectories, strict=True):
            here = spatial[spatial["trajectory"] == trajectory].set_index(["model", "stage"])["rms_mm"]
            prediction = np.array([here.get((model, "prediction"), np.nan) for model in models])
            loop = np.array([here.get((model, "closed loop"), np.nan) for model in models])
            panel.axvline(loop[0], color=GREY, linewidth=0.8, linestyle=":")
            panel.hlines(rows, prediction, loop, color=GREY, linewidth=1.0, zorder=1)
            panel.plot(prediction, rows, "o", color=BLUE, markerfacecolor="white", label="measured minus predicted")
            panel.plot(loop, rows, "D", color=VERMILION, markersize=4, label="closed loop: arm at the commands")
            panel.set_xscale("log")
            panel.xaxis.set_major_formatter("{x:g}")
            panel.set_title(trajectory)
            panel.set_xlabel("error left (mm, 3D RMS)")
        panels[0, 0].set_yticks(rows, models)
        panels[0, 0].set_ylim(-0.6, len(models) - 0.4)
        legend_above(figure, columns=2)
    return figure


def regions_figure(table: pd.DataFrame) -> Figure:
    """One panel per model: error against the number of blended regions; the one that cross-validation chose is
    filled. ``table``: see `armscope.paper.outlook.paper_regions`."""
    models = list(table["model"].unique())
    paths = [name for name in table.columns if name.startswith("test") or name == "held out"]
    colours = (GREEN, ORANGE, SKY)
    with styled():
        figure, panels = plt.subplots(
            1, len(models), figsize=(2.6 * len(models) + 0.8, 3.2), squeeze=False, sharey=True
        )
        for panel, model in zip(panels[0], models, strict=True):
            here = table[table["model"] == model]
            regions, held_out = here["regions"], here["held_out_rms_mm"]
            panel.plot(regions, here["fit_rms_mm"], "--", color=GREY, label="fit")
            panel.errorbar(
                regions, held_out, here["stderr_mm"], marker="o", color=BLUE, markerfacecolor="white", capsize=2,
                label="held out (cross-validation)",
            )  # fmt: skip
            for path, colour in zip(paths, colours, strict=False):
                panel.plot(regions, here[path], ".:", color=colour, label=path)
            chosen = here["chosen"].astype(bool)
            panel.plot(regions[chosen], held_out[chosen], "o", color=BLUE, label="chosen", zorder=5)
            panel.set_xscale("log", base=2)
            panel.set_yscale("log")
            panel.set_xticks(regions, [str(count) for count in regions])
            panel.minorticks_off()
            panel.yaxis.set_major_formatter("{x:g}")
            panel.set_title(model)
            panel.set_xlabel("regions")
        panels[0, 0].set_ylabel("error left (mm, 3D RMS)")
        legend_above(figure, columns=3 + len(paths))
    return figure
