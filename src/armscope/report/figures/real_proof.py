"""Concealment on real recordings as figures: outcomes, fitted over planted sizes, held-out error won back."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from armscope.report.figures.proof import OUTCOME_COLOURS
from armscope.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, SKY, legend_above, styled

SIZE_MARKERS = (("o", SKY), ("s", ORANGE), ("D", BLUE))
RATIO_RANGE = (-0.5, 2.5)
RECOVERED_RANGE = (-1.0, 1.5)


def draw_all(tables: Mapping[str, pd.DataFrame], titles: Mapping[str, str]) -> dict[str, Figure]:
    """Every figure by name."""
    cases = tables["cases"].assign(arm=[titles.get(name, name) for name in tables["cases"]["set"]])
    with styled():
        return {"found": found(cases), "sizes": sizes(cases), "held_out": held_out_by_arm(cases)}


def found(cases: pd.DataFrame) -> Figure:
    """How planted effects ended, by effect and by arm, at each size."""
    rows = max(cases["effect"].nunique(), cases["arm"].nunique()) * (cases["size"].nunique() + 1)
    figure, panels = plt.subplots(1, 2, figsize=(9.6, max(3.2, 1.6 + 0.13 * rows)))
    for axes, key in zip(panels, ("effect", "arm"), strict=True):
        _outcomes(axes, cases, key)
    handles = [Patch(color=colour, label=name) for name, colour in OUTCOME_COLOURS.items()]
    legend_above(figure, handles, columns=5)
    return figure


def _outcomes(axes: Axes, cases: pd.DataFrame, key: str) -> None:
    """Stacked bars; one group per value of ``key``, one bar per size in it, the smallest on top."""
    names, sizes = sorted(cases[key].unique()), sorted(cases["size"].unique())
    ticks, labels = [], []
    for row, name in enumerate(names):
        for step, size in enumerate(sizes):
            group = cases[(cases[key] == name) & (cases["size"] == size)]
            at = -(row * (len(sizes) + 1) + step)
            left = 0.0
            for outcome, colour in OUTCOME_COLOURS.items():
                share = float((group["outcome"] == outcome).mean()) if len(group) else 0.0
                axes.barh(at, share, left=left, color=colour, height=0.85)
                left += share
            axes.text(1.02, at, f"{size:g}×, {len(group)}", va="center", fontsize=7, color=GREY)
        ticks.append(-(row * (len(sizes) + 1) + (len(sizes) - 1) / 2))
        labels.append(name.replace("_", " "))
    axes.set_yticks(ticks, labels)
    axes.set_xlim(0, 1)
    axes.set_xticks([0, 0.5, 1], ["0", "50 %", "100 %"])
    axes.set_xlabel("share of the planted effects")
    axes.grid(axis="y", visible=False)
    axes.set_ylim(-len(names) * (len(sizes) + 1) + 1.4, 0.6)


def sizes(cases: pd.DataFrame) -> Figure:
    """Fitted over planted size of the effects found under their own name, by effect."""
    names = sorted(cases["effect"].unique())
    figure, axes = plt.subplots(figsize=(7.2, max(2.4, 1.4 + 0.4 * len(names))))
    rows = cases[np.isfinite(cases["size_ratio"].astype(float))]
    axes.axvline(1, color=GREEN, lw=1)
    _dots(axes, rows, "size_ratio", "effect", names, RATIO_RANGE)
    axes.set_xlabel("fitted over true size (1: exact)")
    _size_legend(figure, cases)
    return figure


def held_out_by_arm(cases: pd.DataFrame) -> Figure:
    """Share of the planted squared error on unseen rows that the altered verdict's model takes away, by arm."""
    names = sorted(cases["arm"].unique())
    figure, axes = plt.subplots(figsize=(7.2, max(2.4, 1.4 + 0.4 * len(names))))
    axes.axvline(1, color=GREEN, lw=1)
    axes.axvline(0, color=BLACK, lw=0.8)
    _dots(axes, cases, "recovered", "arm", names, RECOVERED_RANGE)
    axes.set_xlabel("share of the planted squared error taken away on unseen rows (1: all)")
    _size_legend(figure, cases)
    return figure


def _dots(axes: Axes, rows: pd.DataFrame, value: str, key: str, names: list[str], span: tuple[float, float]) -> None:
    """One dot per case, one line per name, sizes below each other; dots beyond the span sit at its end as arrows."""
    for step, size in enumerate(sorted(rows["size"].unique())):
        marker, colour = SIZE_MARKERS[step % len(SIZE_MARKERS)]
        mine = rows[rows["size"] == size]
        at = np.array([-names.index(name) for name in mine[key]]) + 0.22 * (1 - step)
        shown = np.clip(mine[value].to_numpy(dtype=float), *span)
        inside = shown == mine[value].to_numpy(dtype=float)
        axes.plot(shown[inside], at[inside], marker, color=colour, ms=4, alpha=0.8)
        for end, arrow in ((span[0], "<"), (span[1], ">")):
            out = ~inside & (shown == end)
            axes.plot(shown[out], at[out], arrow, color=colour, ms=5, clip_on=False)
    axes.set_yticks(range(0, -len(names), -1), [name.replace("_", " ") for name in names])
    axes.set_xlim(*span)
    axes.set_ylim(-len(names) + 0.4, 0.6)


def _size_legend(figure: Figure, cases: pd.DataFrame) -> None:
    handles = [
        Line2D([], [], ls="", marker=marker, color=colour, label=f"{size:g} times what the arm leaves")
        for (marker, colour), size in zip(SIZE_MARKERS, sorted(cases["size"].unique()), strict=False)
    ]
    legend_above(figure, handles, columns=3)
