"""How the swarms converge, by velocity update."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from armscope.report.style import BLACK, BLUE, GREEN, ORANGE, SKY, VERMILION, legend_above, panel_grid, styled


def convergence(history: pd.DataFrame) -> Figure:
    """Which velocity update reaches the least-squares optimum, and when.

    Args:
        history: columns rule, model, iteration, and the excess of the best fitness over the least-squares optimum in
            percent: median, low, high (over seeds and axes).
    """
    colours = {"constriction": BLUE, "inertia": GREEN, "constriction, ring": SKY, "original": VERMILION,
               "original, clamped": ORANGE, "random search": BLACK}  # fmt: skip
    dashes = {"random search": ":", "original, clamped": "--"}
    models = list(dict.fromkeys(history["model"]))
    with styled():
        figure, panels = panel_grid(len(models), 3, (3.2, 2.7), sharex=True, sharey=True)
        for panel, model in zip(panels, models, strict=True):
            for rule, rows_of_rule in history[history["model"] == model].groupby("rule", sort=False):
                colour = colours[str(rule)]
                iteration = rows_of_rule["iteration"]
                panel.fill_between(
                    iteration, rows_of_rule["low"], rows_of_rule["high"], color=colour, alpha=0.15, linewidth=0
                )
                panel.plot(iteration, rows_of_rule["median"], dashes.get(str(rule), "-"), color=colour, label=str(rule))
            panel.set(title=model, yscale="log")
            panel.axhline(1, color=BLACK, linewidth=0.6, linestyle=":")
        figure.supxlabel("iteration")
        figure.supylabel("excess over least squares (%)")
        legend_above(figure)
    return figure
