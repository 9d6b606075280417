"""Causes of a fleet by arm: one row per diagnosis, one column per cause."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from armscope.report.style import styled
from armscope.verdict.wording import plain

MOST_CAUSES, MOST_LABELS = 30, 60


def fleet_figure(causes: pd.DataFrame) -> Figure:
    """Size at the tool of the most frequent causes, arms grouped by type.

    Args:
        causes: of `armscope.fleet.summary.causes_of_arms`.
    """
    told = causes[~causes["minor"].astype(bool)]
    often = told["cause"].value_counts().index[:MOST_CAUSES]
    label = told["type"] + "  " + told["arm"] + " " + told["date"] + " " + told["run"]
    sizes = told.assign(label=label).pivot_table(index="label", columns="cause", values="rms_at_tool_mm", aggfunc="max")
    sizes = sizes.reindex(columns=often).sort_index()
    with styled():
        height = float(np.clip(0.14 * len(sizes) + 2.2, 3, 14))
        figure, axes = plt.subplots(figsize=(9.2, height))
        shown = sizes.to_numpy(dtype=float)
        low, high = (np.nanmin(shown), np.nanmax(shown)) if np.isfinite(shown).any() else (0.01, 1.0)
        picture = axes.imshow(shown, aspect="auto", cmap="cividis_r", norm=LogNorm(low, max(high, 1.01 * low)))
        axes.set_xticks(range(len(often)), [plain(cause) for cause in often], rotation=60, ha="right", fontsize=7)
        step = max(1, -(-len(sizes) // MOST_LABELS))
        axes.set_yticks(range(0, len(sizes), step), list(sizes.index[::step]), fontsize=6)
        axes.grid(visible=False)
        # as high as the map: the words beside a bar of few rows would be cut off
        bar = figure.colorbar(picture, label="RMS at the tool\n(mm per axis)", format="{x:g}")
        within = high < 10 * low  # 3, 4, 5 within one decade, not 3 x 10^0; of more decades they would overlap
        bar.ax.yaxis.set_minor_formatter("{x:g}" if within else NullFormatter())
    return figure
