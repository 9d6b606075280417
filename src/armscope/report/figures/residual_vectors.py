"""What was measured minus what the model says, as arrows in the workspace."""

from __future__ import annotations

from collections.abc import Iterator

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, Normalize
from matplotlib.figure import Figure
from matplotlib.quiver import Quiver

from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.report.figures.arm_picture import share_colours
from armscope.report.style import GREY, styled
from armscope.report.subject import Drawn, Subject

MOST_ARROWS = 350
MOST_INCHES = 7.0


def draw_vectors(points: Array, before: Array, after: Array) -> Figure:
    """Residuals before and after as arrows, from above and in the half-plane of reach and height, to one scale.

    Args:
        points: (N, 3) measured tool points, base axes, m.
        before, after: (N, 3) residuals without any effect and with the fitted model, base axes, mm.

    Returns:
        The figure.
    """
    shown = spread_evenly(len(points), MOST_ARROWS)
    at = 1e3 * points[shown]
    typical = float(np.percentile(np.linalg.norm(before, axis=1), 95))
    across = float(max(np.ptp(at, axis=0).max(), 1.0))
    factor = nice(0.09 * across / max(typical, 1e-6))
    both = {"before": before[shown], "after": after[shown]}
    above, side = at[:, :2], _folded(at, at)
    limits = [
        _limits(above, [factor * left[:, :2] for left in both.values()]),
        _limits(side, [factor * _folded(at, left) for left in both.values()]),
    ]
    heights = [float(np.ptp(low_high[:, 1]) / np.ptp(low_high[:, 0])) for low_high in limits]
    norm, colours = Normalize(0, typical), share_colours()
    with styled():
        side_length = min(3.1, MOST_INCHES / sum(heights))
        size = (2 * side_length + 2.6, side_length * sum(heights) + 1.3)
        figure, panels = plt.subplots(2, 2, figsize=size, height_ratios=heights, sharex="row", sharey="row")
        for column, (title, left) in enumerate(both.items()):
            rms = float(np.sqrt(np.mean((before, after)[column] ** 2)))
            panels[0, column].set_title(f"{title}: {rms:.3g} mm RMS per axis")
            length = np.linalg.norm(left, axis=1)
            for row, (where, arrows) in enumerate(((above, left[:, :2]), (side, _folded(at, left)))):
                panel = panels[row, column]
                drawn = _arrows(panel, where, factor * arrows, length, norm, colours)
                panel.set(xlim=limits[row][:, 0], ylim=limits[row][:, 1], aspect="equal")
            _mark_base(panels[0, column])
        panels[0, 0].set(ylabel="from above: y (mm)")
        panels[1, 0].set(ylabel="from the side: height z (mm)")
        for panel in panels[0]:
            panel.set_xlabel("x (mm)")
        for panel in panels[1]:
            panel.set_xlabel("distance from the base's axis (mm)")
        bar = figure.colorbar(
            ScalarMappable(norm, colours), ax=panels.ravel().tolist(), shrink=0.5, pad=0.01, aspect=28, extend="max"
        )
        bar.set_label("length of the residual (mm)")
        bar.outline.set_linewidth(0)
        _key(panels[0, 0], drawn, factor, nice(typical))
    return figure


def nice(value: float) -> float:
    """The largest of 1, 2, 5, 10, 20, ... that does not exceed the value."""
    power = 10.0 ** np.floor(np.log10(max(value, 1e-9)))
    return float(max(step * power for step in (1, 2, 5) if step * power <= value * (1 + 1e-9)))


def _folded(at: Array, vectors: Array) -> Array:
    """(N, 2) components away from the base's axis and up."""
    outwards = at[:, :2] / np.maximum(np.linalg.norm(at[:, :2], axis=1, keepdims=True), 1e-9)
    return np.column_stack([np.sum(outwards * vectors[:, :2], axis=1), vectors[:, 2]])


def _arrows(panel: Axes, at: Array, arrows: Array, sizes: Array, norm: Normalize, colours: Colormap) -> Quiver:
    return panel.quiver(
        *at.T, *arrows.T, sizes, cmap=colours, norm=norm, angles="xy", scale_units="xy", scale=1,
        width=0.0035, headwidth=3.5, headlength=4, headaxislength=3.6, edgecolor="#3A424A", linewidth=0.25, zorder=3,
    )  # fmt: skip


def _limits(at: Array, arrows: list[Array]) -> Array:
    """(2, 2) lowest and highest coordinates that hold the points and nearly all arrows."""
    across = float(max(np.ptp(at, axis=0).max(), 1.0))
    reach = np.vstack([at, *(at + np.clip(some, -0.2 * across, 0.2 * across) for some in arrows)])
    margin = 0.03 * across
    return np.vstack([reach.min(axis=0) - margin, reach.max(axis=0) + margin])


def _key(panel: Axes, arrows: Quiver, factor: float, length: float) -> None:
    """The arrows' scale in words, and one arrow of known length behind them."""
    figure = panel.get_figure(root=True)
    assert figure is not None
    words = figure.suptitle(
        f"Arrows are drawn {factor:g} times as long as the residual. {length:g} mm:", x=0.02, ha="left", fontsize=9
    )
    figure.canvas.draw()
    box = words.get_window_extent().transformed(figure.transFigure.inverted())
    key = panel.quiverkey(arrows, box.x1 + 0.055, (box.y0 + box.y1) / 2, factor * length, "", color=GREY,
                                coordinates="figure")  # fmt: skip
    key.set_in_layout(False)


def _mark_base(panel: Axes) -> None:
    left, right = sorted(panel.get_xlim())
    low, high = sorted(panel.get_ylim())
    if left < 0 < right and low < 0 < high:
        panel.plot(0, 0, marker="s", markersize=7, color=GREY, zorder=2)
        panel.annotate("base", (0, 0), (5, 5), textcoords="offset points", color=GREY, fontsize=8)


def vectors_figure(subject: Subject) -> Iterator[Drawn]:
    """Residual vectors before and after."""
    rows = subject.verdict.residuals
    drawn = draw_vectors(rows.points * 1e-3, rows.before, rows.after)
    yield Drawn("vectors", drawn, "Residual vectors in the workspace, before and after")
