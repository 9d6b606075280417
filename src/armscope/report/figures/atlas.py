"""The atlas: how much of the mismatch each place could explain with each driver, as a map."""

from __future__ import annotations

import warnings
from collections.abc import Collection, Iterator, Sequence

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from armscope.report.figures.arm_picture import share_colours
from armscope.report.style import BLACK, styled
from armscope.report.subject import Drawn, Subject
from armscope.verdict.schema import Atlas, Diagnosis, FoundEffect
from armscope.verdict.sentences import atlas_column

WORTH_A_NUMBER = 0.03
"""Cells below this share are coloured but carry no number."""
IMPOSSIBLE = "#F0F1F3"


def draw_atlas(
    shares: pd.DataFrame, marked: Collection[tuple[str, str]] = (), left: pd.DataFrame | None = None
) -> Figure:
    """Location x driver maps of the share explained.

    Args:
        shares: index location, columns driver (in words), values 0 to 1; NaN where there is no such effect.
        marked: (location, driver) cells of the effects that were named: they get a frame.
        left: the same on top of the named effects, as a share of the original mismatch; None leaves it out.

    Returns:
        The figure.
    """
    maps = [("before any effect", shares)]
    if left is not None:
        maps.append(("after the fitted model", left.reindex(index=shares.index, columns=shares.columns)))
    top = max(0.05, float(np.nanmax(shares.to_numpy(), initial=0.0)))
    n_rows, n_columns = shares.shape
    height = 0.27 * n_rows + 1.9
    width = max(0.52 * n_columns, 2.2) * len(maps) + 2.6
    with styled(), plt.rc_context({"axes.grid": False}):
        figure, panels = plt.subplots(1, len(maps), figsize=(width, height), sharey=True, squeeze=False)
        for panel, (title, table) in zip(panels[0], maps, strict=True):
            image = panel.imshow(
                np.ma.masked_invalid(table.to_numpy(dtype=float)), cmap=share_colours(), vmin=0, vmax=top, aspect="auto"
            )
            panel.set_facecolor(IMPOSSIBLE)
            panel.set_title(title, loc="left")
            panel.set_xticks(range(n_columns), table.columns, rotation=40, ha="right", rotation_mode="anchor")
            panel.set_yticks(range(n_rows), table.index)
            panel.tick_params(length=0)
            panel.spines[:].set_visible(False)
            panel.set_xticks(np.arange(n_columns + 1) - 0.5, minor=True)
            panel.set_yticks(np.arange(n_rows + 1) - 0.5, minor=True)
            panel.grid(which="minor", color="white", linewidth=1.4, alpha=1.0)
            panel.tick_params(which="minor", length=0)
            _write_numbers(panel, table, top)
        for location, driver in marked:
            if location in shares.index and driver in shares.columns:
                _frame(panels[0][0], list(shares.columns).index(driver), list(shares.index).index(location))
        bar = figure.colorbar(image, ax=panels[0].tolist(), shrink=min(1.0, 2.6 / height), pad=0.015, aspect=22)
        bar.set_label("share explained (%)")
        bar.ax.yaxis.set_major_formatter(lambda value, _: f"{100 * value:.0f}")
        bar.outline.set_linewidth(0)
    return figure


def _write_numbers(panel: Axes, table: pd.DataFrame, top: float) -> None:
    for row, values in enumerate(table.to_numpy(dtype=float)):
        for column, share in enumerate(values):
            if np.isfinite(share) and share >= WORTH_A_NUMBER:
                colour = "white" if share > 0.45 * top else BLACK
                panel.text(column, row, f"{100 * share:.0f}", ha="center", va="center", fontsize=7.5, color=colour)


def _frame(panel: Axes, column: int, row: int) -> None:
    panel.add_patch(
        Rectangle((column - 0.5, row - 0.5), 1, 1, fill=False, edgecolor=BLACK, linewidth=1.8, zorder=5, clip_on=False)
    )


def attribution(verdict: Diagnosis) -> bool:
    """Whether there is anything in the atlas."""
    return verdict.atlas is not None and bool(np.isfinite(verdict.atlas.share).any())


def atlas_figure(subject: Subject) -> Iterator[Drawn]:
    """The atlas with the named effects framed."""
    verdict = subject.verdict
    if verdict.atlas is not None and attribution(verdict):
        shares, left, marked = atlas_tables(verdict.atlas, verdict.effects)
        drawn = draw_atlas(shares, marked, left)
        yield Drawn("atlas", drawn, "Map of the share of the mismatch by location and driver")


def atlas_tables(
    atlas: Atlas, effects: Sequence[FoundEffect]
) -> tuple[pd.DataFrame, pd.DataFrame, list[tuple[str, str]]]:
    """Location x driver tables of the best direction's share, on top of the frames and of the model; named cells."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # all directions NaN: there is no such effect
        tables = [
            pd.DataFrame(np.nanmax(values, axis=1), index=atlas.locations, columns=atlas.drivers)
            for values in (atlas.share, atlas.left)
        ]
    there = tables[0].notna()
    rows, columns = there.index[there.any(axis=1)], there.columns[there.any(axis=0)]
    shares, left = (table.reindex(index=rows, columns=columns) for table in tables)
    marked = [(effect.location, column) for effect in effects if (column := atlas_column(effect))]
    return shares, left, marked
