"""One look for all figures, and the only way they are saved."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
from cycler import cycler

mpl.use("Agg")

import matplotlib.pyplot as plt
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


def legend_above(figure: Figure, handles: Any = None, labels: Any = None, columns: int = 4) -> None:
    """Put one legend above all panels, where it hides no data.

    Args:
        figure: with its panels drawn.
        handles, labels: as matplotlib gives them.
        columns: of the legend.
    """
    if handles is None:
        handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=columns)
