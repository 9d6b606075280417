"""One look for all figures, and the only way they are saved."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
from cycler import cycler

mpl.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.mathtext import MathTextParser
from matplotlib.text import Text

from armscope.core.files import replacing

# Okabe & Ito (2008): eight colours that people with colour-vision deficiencies can tell apart
BLACK, ORANGE, SKY, GREEN, YELLOW, BLUE, VERMILION, PURPLE = (
    "#000000", "#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7",
)  # fmt: skip
GREY = "#8A8A8A"
AXIS_NAMES = ("x", "y", "z")

STYLE: Any = {
    "axes.grid": True,
    "axes.prop_cycle": cycler(color=[BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK]),
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": "medium",
    "figure.constrained_layout.use": True,
    "figure.dpi": 100,
    "font.size": 9,
    "grid.alpha": 0.25,
    "legend.frameon": False,
    "lines.linewidth": 1.2,
    "pdf.fonttype": 42,
    "savefig.dpi": 160,
    "svg.fonttype": "path",
    "svg.hashsalt": "armscope",  # stable ids: the same figure has the same bytes
}

FORMATS = ("png", "svg", "pdf")
_UNDATED: dict[str, dict[str, Any]] = {
    "png": {"Software": None},
    "svg": {"Date": None},
    "pdf": {"CreationDate": None, "Producer": None},
}
_CANVAS: dict[str, Any] = {"svg": FigureCanvasSVG, "pdf": FigureCanvasPdf}


def styled() -> Any:
    """A context in which figures have the common look."""
    return mpl.rc_context(STYLE)


def save_figure(figure: Figure, path: Path | str, formats: Sequence[str] = FORMATS) -> list[Path]:
    """Save ``figure`` as PNG, SVG and PDF beside each other, byte-stable, and close it.

    Args:
        figure: the figure.
        path: where one of them goes; the others differ in their suffix.
        formats: which of the three are wanted.

    Returns:
        The files.
    """
    written: list[Path] = []
    _names_are_no_formulas(figure)
    with styled():
        for suffix in formats:
            target = Path(path).with_suffix(f".{suffix}")
            with replacing(target) as beside:
                if written and suffix in _CANVAS:  # laid out once: `savefig` would draw it once more to find out
                    getattr(_CANVAS[suffix](figure), f"print_{suffix}")(beside, metadata=_UNDATED[suffix])
                else:
                    figure.savefig(beside, format=suffix, metadata=_UNDATED[suffix])
            figure.set_layout_engine("none")
            written.append(target)
    plt.close(figure)
    return written


def _names_are_no_formulas(figure: Figure) -> None:
    """A user's name that holds dollar signs but no formula is drawn as it is, instead of ending the drawing."""
    parser = MathTextParser("path")
    for text in figure.findobj(Text):
        if isinstance(text, Text) and "$" in text.get_text():
            try:
                parser.parse(text.get_text())
            except ValueError:
                text.set_parse_math(False)


def legend_above(figure: Figure, handles: Iterable[Any] | None = None, columns: int = 4) -> None:
    """Put one legend above all panels, where it hides no data.

    Args:
        figure: with its panels drawn.
        handles: with their labels; those of the first panel if left out.
        columns: of the legend.
    """
    shown = figure.axes[0].get_legend_handles_labels()[0] if handles is None else list(handles)
    figure.legend(handles=shown, loc="outside upper center", ncols=columns)


def panel_grid(count: int, columns: int, size: tuple[float, float], **shared: Any) -> tuple[Figure, list[Axes]]:
    """A figure of so many panels, row after row.

    Args:
        count: of panels.
        columns: in a row, at most.
        size: (2,) width and height of a panel, inches; the legend above them has room of its own.
        shared: axes, as `sharex` and `sharey`.

    Returns:
        The figure and its panels.
    """
    columns = max(1, min(columns, count))
    rows = max(1, -(-count // columns))
    figure, panels = plt.subplots(
        rows, columns, figsize=(size[0] * columns, size[1] * rows + 0.5), squeeze=False, **shared
    )
    for panel in panels.flat[count:]:
        panel.set_visible(False)
    return figure, list(panels.flat[:count])


def in_margin(panel: Axes, y: float, words: str, colour: str = GREY, x: float = 1.02) -> None:
    """Words beside a panel, at a value of its y axis.

    Args:
        panel: beside which.
        y: the value.
        words: small ones.
        colour: of them.
        x: where along the panel, 0 ... 1; beyond 1 on the right of it.
    """
    panel.text(x, y, words, transform=panel.get_yaxis_transform(), va="center", fontsize=7, color=colour)
