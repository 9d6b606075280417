"""What is left: curves that no effect of the library explains, with their bands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from armscope.core.types import Array
from armscope.report.style import BLACK, BLUE, styled


@dataclass(frozen=True, eq=False)
class Curve:
    """One curve to draw.

    Attributes:
        title: where it is and what it follows.
        x, value, low, high: (K,) the driver, the curve and its 95 % band, in the units that the labels name.
        x_label, y_label: with units.
        rows: (N,) the driver at the recorded rows, drawn as ticks at the bottom; None leaves them out.
    """

    title: str
    x: Array
    value: Array
    low: Array
    high: Array
    x_label: str
    y_label: str
    rows: Array | None = None


def draw_curves(curves: Sequence[Curve]) -> Figure:
    """Each curve with its band in a panel of its own."""
    columns = min(2, len(curves))
    rows = -(-len(curves) // columns)
    with styled():
        figure, panels = plt.subplots(
            rows, columns, figsize=(4.3 * columns + (1.2 if columns == 1 else 0), 2.7 * rows), squeeze=False
        )
        for panel in panels.flat[len(curves) :]:
            panel.set_visible(False)
        for panel, curve in zip(panels.flat, curves, strict=False):
            panel.axhline(0, color=BLACK, linewidth=0.6)
            panel.fill_between(curve.x, curve.low, curve.high, color=BLUE, alpha=0.2, linewidth=0)
            panel.plot(curve.x, curve.value, color=BLUE, linewidth=1.6)
            panel.set(title=curve.title, xlabel=curve.x_label, ylabel=curve.y_label)
            if curve.rows is not None:
                ticks = np.unique(np.quantile(curve.rows, np.linspace(0, 1, 120)))
                panel.plot(ticks, np.zeros_like(ticks), "|", color=BLACK, markersize=5, alpha=0.4,
                           transform=panel.get_xaxis_transform(), clip_on=False)  # fmt: skip
    return figure
