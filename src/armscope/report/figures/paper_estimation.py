"""Figs. 6, 7, 10 and 11: true and estimated errors along a test trajectory."""

from __future__ import annotations

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from armscope.core.types import Array
from armscope.report.style import AXIS_NAMES, BLACK, GREY, VERMILION, legend_above, styled

Band = tuple[Array, Array]
"""(low, high), each (N, 3), mm."""


def estimation_performance(
    errors: Array,
    predictions: Mapping[str, Array],
    true_band: Band | None = None,
    bands: Mapping[str, Band] | None = None,
) -> Figure:
    """True and estimated errors along a trajectory: one row per axis, one column per model.

    Args:
        errors: (N, 3) of the robot that is drawn, mm.
        predictions: by model, (N, 3) median over the seeds, mm.
        true_band: range of the true errors of the drawn robots.
        bands: by model, range of the errors estimated for them.

    Returns:
        The figure.
    """
    with styled():
        figure, panels = plt.subplots(
            3, len(predictions), figsize=(4.5 * len(predictions), 6.5), sharex=True, sharey="row", squeeze=False
        )
        points = np.arange(1.0, len(errors) + 1)
        for column, (model, predicted) in enumerate(predictions.items()):
            for axis in range(3):
                panel: Axes = panels[axis, column]
                if true_band is not None:
                    _shade(panel, points, true_band, axis, GREY, "true, 5–95 % of the drawn robots")
                if bands and model in bands:
                    _shade(panel, points, bands[model], axis, VERMILION, "estimated, 5–95 % of them")
                panel.plot(points, errors[:, axis], color=BLACK, label="true error")
                panel.plot(points, predicted[:, axis], color=VERMILION, linestyle="--", label="estimated error")
                panel.axhline(0, color=GREY, linewidth=0.6)
                if column == 0:
                    panel.set_ylabel(f"$\\delta_{AXIS_NAMES[axis]}$ (mm)")
            panels[0, column].set_title(model)
            panels[-1, column].set_xlabel("target point")
        labelled = [panel.get_legend_handles_labels() for panel in panels.flat]
        entries = {label: handle for handles, labels in labelled for handle, label in zip(handles, labels, strict=True)}
        legend_above(figure, entries.values())
    return figure


def _shade(panel: Axes, points: Array, band: Band, axis: int, colour: str, label: str) -> None:
    """A band, unless it is too thin to be seen: then it has no entry in the legend either."""
    low, high = band[0][:, axis], band[1][:, axis]
    name = label if np.max(high - low) > THINNEST_MM else None
    panel.fill_between(points, low, high, color=colour, alpha=0.28, linewidth=0, label=name)


THINNEST_MM = 0.02
"""A band narrower than this everywhere is not seen."""
