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
WORDS_PT = 9  # As high as the words of the page around it


def fleet_figure(causes: pd.DataFrame) -> Figure:
    """Size at the tool of the most frequent causes, arms grouped by type. ``causes``: of
    `armscope.fleet.summary.causes_of_arms`."""
    told = causes[~causes["minor"].astype(bool)]
    often = told["cause"].value_counts().index[:MOST_CAUSES]
    label = told["type"] + "  " + told["arm"] + " " + told["date"] + " " + told["run"]
    sizes = told.assign(label=label).pivot_table(index="label", columns="cause", values="rms_at_tool_mm", aggfunc="max")
    sizes = sizes.reindex(columns=often).sort_index()
    with styled():
        height = float(np.clip(0.19 * len(sizes) + 3.2, 4, 15))
        width = float(np.clip(0.26 * len(often) + 3.4, 5, 10.5))
        figure, axes = plt.subplots(figsize=(width, height))
        shown = sizes.to_numpy(dtype=float)
        low, high = (np.nanmin(shown), np.nanmax(shown)) if np.isfinite(shown).any() else (0.01, 1.0)
        picture = axes.imshow(shown, aspect="auto", cmap="cividis_r", norm=LogNorm(low, max(high, 1.01 * low)))
        told_as = [plain(cause) for cause in often]
        axes.set_xticks(range(len(often)), told_as, rotation=60, ha="right", fontsize=WORDS_PT)
        step = max(1, -(-len(sizes) // MOST_LABELS))
        axes.set_yticks(range(0, len(sizes), step), list(sizes.index[::step]), fontsize=WORDS_PT)
        axes.grid(visible=False)
        # above the map, where it is seen before anything is scrolled
        bar = figure.colorbar(picture, label="RMS at the tool (mm per axis)", format="{x:g}", location="top", aspect=30)
        within = high < 10 * low  # 3, 4, 5 within one decade, not 3 x 10^0; of more decades they would overlap
        bar.ax.xaxis.set_minor_formatter("{x:g}" if within else NullFormatter())
    return figure
