"""Real runs in the reference protocol as one picture: from the nominal arm to armscope, beside others' figures."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullFormatter

from armscope.real.protocol import ARMSCOPE, ORIENTED
from armscope.report.style import BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, legend_above, styled

MODELS = {
    "nominal": (GREY, "o", "nominal"), "offsets": (SKY, "v", "offsets"), "geometric": (ORANGE, "s", "geometric"),
    "compliance": (GREEN, "^", "+ compliance"), ARMSCOPE: (BLUE, "D", "armscope (points alone, as the others)"),
    ORIENTED: (PURPLE, "P", "armscope, orientations too"),
}  # fmt: skip
TICKS_MM = (0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10)
BESIDE = 0.28  # How far below its line the model stands that learned from more than the others
BEST = "best figure of others"


def draw_protocol(tables: Sequence[tuple[str, pd.DataFrame]]) -> Figure:
    """One line per run; dots are means over the splits, bars their standard deviation. ``tables``: (arm, its
    protocol.csv) in their order."""
    runs = [(arm, run, rows) for arm, table in tables for run, rows in table.groupby("run", sort=False)]
    with styled():
        figure, axes = plt.subplots(figsize=(7.6, 1.1 + 0.36 * len(runs)))
        for at, (_, _, rows) in enumerate(runs):
            _line(axes, -at, rows)
        axes.set_yticks(range(0, -len(runs), -1), [f"{arm}, {run}" for arm, run, _ in runs])
        axes.set_ylim(-len(runs) + 0.4, 0.6)
        axes.set_xscale("log")
        axes.set_xticks(TICKS_MM, [f"{tick:g}" for tick in TICKS_MM])
        axes.xaxis.set_minor_formatter(NullFormatter())
        low, high = (end([value for _, _, rows in runs for value in rows["mean_mm"]]) for end in (min, max))
        axes.set_xlim(0.6 * low, min(1.8 * high, 15.0))
        axes.set_xlabel("RMS of the 3D distance on configurations that took no part, mm")
        handles = [Line2D([], [], ls="", color=c, marker=m, label=label) for c, m, label in MODELS.values()]
        handles.append(Line2D([], [], ls="", color=VERMILION, marker="|", ms=13, mew=2, label=BEST))
        legend_above(figure, handles, columns=3)
    return figure


def _line(axes: Axes, at: float, rows: pd.DataFrame) -> None:
    for model, mean, std, best in zip(rows["model"], rows["mean_mm"], rows["std_mm"], rows["best_mm"], strict=True):
        if model in MODELS:
            colour, marker, _ = MODELS[model]
            height = at - BESIDE if model == ORIENTED else at
            axes.plot([max(mean - std, 0.3 * mean), mean + std], [height, height], color=colour, lw=1.2)
            axes.plot(mean, height, marker, color=colour, ms=5)
        if model == ARMSCOPE:
            axes.plot(best, at, "|", color=VERMILION, ms=13, mew=2)
