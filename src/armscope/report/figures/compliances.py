"""Compliances of one arm as its runs tell them, each with its interval, beside the figures of others."""

from __future__ import annotations

from textwrap import fill

import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from armscope.real.compliance_tables import ORIENTATIONS, POINTS
from armscope.report.style import BLUE, PURPLE, VERMILION, legend_above, styled

LEARNED = {POINTS: (BLUE, "o", 0.13), ORIENTATIONS: (PURPLE, "D", -0.13)}
OTHERS = "figure of others"


def draw_compliances(values: pd.DataFrame) -> Figure:
    """A column per joint and one for the combination that all runs tell best; a line per run; 95 % intervals."""
    shown, runs = list(dict.fromkeys(values["of"])), list(dict.fromkeys(values["run"]))
    with styled():
        figure, panels = plt.subplots(1, len(shown), figsize=(8.4, 1.6 + 0.34 * len(runs)), sharey=True)
        joints = values[values["of"] != shown[-1]]
        for axes, of in zip(panels, shown, strict=True):
            _panel(axes, values[values["of"] == of], runs)
            alone = of != shown[-1]
            axes.set_title(f"drive of {of}" if alone else fill(of, 26), fontsize=8)
            if alone:
                axes.set_xlim(joints["low"].min() - 10, joints["high"].max() + 10)
        panels[0].set_yticks(range(0, -len(runs), -1), runs)
        panels[0].set_ylim(-len(runs) + 0.5, 0.5)
        figure.supxlabel("compliance, µrad/(N m), with its 95 % interval", fontsize=9)
        present = set(values["learned"])
        handles = [
            Line2D([], [], color=c, marker=m, ms=4, label=name)
            for name, (c, m, _) in LEARNED.items()
            if name in present
        ]
        handles.append(Line2D([], [], ls="", color=VERMILION, marker="|", ms=12, mew=2, label=OTHERS))
        legend_above(figure, handles, columns=3)
    return figure


def _panel(axes: Axes, values: pd.DataFrame, runs: list[str]) -> None:
    axes.axvline(0, color="0.6", lw=0.8)
    for row in values.to_dict("records"):
        colour, marker, beside = LEARNED[row["learned"]]
        at = -runs.index(row["run"])
        axes.plot([row["low"], row["high"]], [at + beside] * 2, color=colour, lw=1.2)
        axes.plot(row["value"], at + beside, marker, color=colour, ms=4)
        if pd.notna(row["reference"]):
            axes.plot(row["reference"], at, "|", color=VERMILION, ms=12, mew=2)
