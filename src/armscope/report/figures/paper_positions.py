"""Figs. 3 and 4: errors of the identification positions, and what the models make of them."""

from __future__ import annotations

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from armscope.core.types import Array
from armscope.report.style import AXIS_NAMES, BLACK, BLUE, GREY, VERMILION, legend_above, panel_grid, styled


def errors_of_positions(errors: Array, low: Array | None = None, high: Array | None = None) -> Figure:
    """Fig. 3: errors of the identification positions.

    Args:
        errors: (N, 3) measured minus nominal, mm.
        low, high: (N, 3) range of the drawn robots.

    Returns:
        The figure.
    """
    with styled():
        figure, panels = plt.subplots(3, 1, figsize=(7, 5), sharex=True)
        points = np.arange(1, len(errors) + 1)
        for axis, panel in enumerate(panels):
            panel.axhline(0, color=GREY, linewidth=0.6)
            if low is not None and high is not None:
                panel.vlines(
                    points, low[:, axis], high[:, axis], color=GREY, alpha=0.45, linewidth=2.5,
                    label="5–95 % of the drawn robots",
                )  # fmt: skip
            panel.plot(points, errors[:, axis], ".", color=BLUE, markersize=4, label="anchored robot")
            panel.set_ylabel(f"$\\delta_{AXIS_NAMES[axis]}$ (mm)")
        panels[-1].set_xlabel("identification position")
        if low is not None:
            legend_above(figure)
    return figure


def modelling_performance(errors: Array, predictions: Mapping[str, Array]) -> Figure:
    """Fig. 4: what each model makes of the identification errors along y, as the paper shows it.

    Args:
        errors: (N, 3) mm.
        predictions: by model, (N, 3) mm; any number of models.
    """
    with styled():
        figure, panels = panel_grid(len(predictions), 2, (4.5, 2.2), sharex=True, sharey=True)
        points = np.arange(1, len(errors) + 1)
        for panel, (model, predicted) in zip(panels, predictions.items(), strict=True):
            panel.plot(points, errors[:, 1], color=BLACK, linewidth=0.8, label="measured")
            panel.plot(points, predicted[:, 1], color=VERMILION, linestyle="--", linewidth=1.0, label="predicted")
            rest = np.sqrt(np.mean((errors[:, 1] - predicted[:, 1]) ** 2))
            panel.set_title(f"{model}: {rest:.2f} mm RMS left")
            panel.set(xlabel="identification position", ylabel=f"$\\delta_{AXIS_NAMES[1]}$ (mm)")
            panel.label_outer()
        legend_above(figure)
    return figure
