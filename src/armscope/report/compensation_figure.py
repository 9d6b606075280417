"""What compensation leaves: model by trajectory, predicted and in closed loop."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from armscope.compensation.closed_loop import NO_MODEL
from armscope.report.style import BLUE, GREY, VERMILION, legend_above, styled


def cross_table_figure(table: pd.DataFrame) -> Figure:
    """One panel per trajectory, one row per model: errors predicted to remain, and what the virtual arm really kept.

    Args:
        table: see `armscope.compensation.closed_loop.cross_table`.
    """
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
