"""How the swarms converge, by velocity update."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from armscope.report.style import BLACK, BLUE, GREEN, ORANGE, SKY, VERMILION, legend_above, styled


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
        columns = min(3, len(models))
        rows = -(-len(models) // columns)
        figure, panels = plt.subplots(
            rows, columns, figsize=(3.2 * columns, 2.7 * rows + 0.5), sharex=True, sharey=True, squeeze=False
        )
        for panel in panels.flat[len(models) :]:
            panel.set_visible(False)
        for panel, model in zip(panels.flat, models, strict=False):
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
