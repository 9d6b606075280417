"""Drawings as SVG, written by hand: a page of a dozen of them must not wait for a plotting library to be imported."""

from __future__ import annotations

import html
import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from armscope.core.types import Array
from armscope.report.colours import INK, LINE, QUIET

FONT = "system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"
LETTER = 0.56  # Width of a letter in heights of its font, on average
TINY = 1e-300  # Below it steps between ticks are no numbers any more


@dataclass
class Drawing:
    """Shapes in px, y downwards; those of a lower order lie below."""

    width: float
    height: float
    alt: str = ""  # what it shows, for those who can't see it
    _shapes: list[tuple[float, str]] = field(default_factory=list, repr=False)

    def add(self, shape: str, order: float = 0.0) -> None:
        """A shape as SVG."""
        self._shapes.append((order, shape))

    def polygon(self, points: Array, fill: str, stroke: str = "none", width: float = 1.0, order: float = 0.0) -> None:
        """A closed shape (K, 2).

        Args:
            points: (K, 2) px.
            fill: colour.
            stroke: colour of its outline.
            width: of the outline, px.
            order: higher ones lie above.
        """
        self.add(f'<path d="M{_pairs(points)}Z" fill="{fill}" stroke="{stroke}" stroke-width="{width:g}"/>', order)

    def line(self, points: Array, stroke: str = INK, width: float = 1.0, order: float = 0.0, dash: str = "") -> None:
        """A line (K, 2) with round ends.

        Args:
            points: (K, 2) px.
            stroke: colour.
            width: px.
            order: higher ones lie above.
            dash: lengths of dashes and gaps, px; "" for none.
        """
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        shape = f'<path d="M{_pairs(points)}" fill="none" stroke="{stroke}" stroke-width="{width:g}"{dashed} '
        self.add(f'{shape}stroke-linecap="round" stroke-linejoin="round"/>', order)

    def arrow(self, start: Array, end: Array, stroke: str = INK, order: float = 0.0) -> None:
        """A thin line with a head at its end.

        Args:
            start: (2,) px.
            end: (2,) px.
            stroke: colour.
            order: higher ones lie above.
        """
        along = np.asarray(end, float) - np.asarray(start, float)
        along = along / max(float(np.linalg.norm(along)), 1e-9)
        across = np.array([-along[1], along[0]])
        self.line(np.array([start, end - 5 * along]), stroke, 1.1, order)
        self.polygon(np.array([end, end - 8 * along + 3 * across, end - 8 * along - 3 * across]), stroke, order=order)

    def circle(self, at: Array, radius: float, fill: str, stroke: str = "none", order: float = 0.0) -> None:
        """A disc.

        Args:
            at: (2,) its middle, px.
            radius: px.
            fill: colour.
            stroke: colour of its outline.
            order: higher ones lie above.
        """
        self.add(f'<circle cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="{radius:g}" fill="{fill}" stroke="{stroke}"/>', order)

    def dots(self, points: Array, colour: str, size: float, opacity: float) -> None:
        """Many dots (K, 2) of one colour as one shape.

        Args:
            points: (K, 2) px.
            colour: of all.
            size: diameter, px.
            opacity: 0 ... 1.
        """
        marks = "".join(f"M{x:.1f} {y:.1f}h0" for x, y in points)
        self.add(
            f'<path d="{marks}" stroke="{colour}" stroke-width="{size:g}" stroke-linecap="round" '
            f'stroke-opacity="{opacity:g}"/>'
        )

    def rectangle(self, corner: Sequence[float], size: Sequence[float], fill: str, stroke: str = "none") -> None:
        """With its upper left corner; of no negative size.

        Args:
            corner: the upper left one, px.
            size: width and height, px; taken as 0 where negative.
            fill: colour.
            stroke: colour of its outline.
        """
        (x, y), (wide, high) = corner, size
        shape = f'<rect x="{x:.1f}" y="{y:.1f}" width="{max(wide, 0):.1f}" height="{max(high, 0):.1f}"'
        self.add(f'{shape} fill="{fill}" stroke="{stroke}"/>')

    def text(self, at: Sequence[float] | Array, words: str, **look: object) -> None:
        """Words at (x, y), the middle of their height.

        Args:
            at: where, px.
            words: shown as they are.
            look: size (px), anchor (start, middle, end), fill, weight, order, turn (degrees).
        """
        size, order = float(str(look.get("size", 12))), float(str(look.get("order", 0)))
        turn = f' transform="rotate({look["turn"]} {at[0]:.1f} {at[1]:.1f})"' if "turn" in look else ""
        self.add(
            f'<text x="{at[0]:.1f}" y="{at[1] + 0.35 * size:.1f}" font-size="{size:g}" '
            f'text-anchor="{look.get("anchor", "start")}" font-weight="{look.get("weight", "normal")}" '
            f'fill="{look.get("fill", INK)}"{turn}>{html.escape(words, quote=False)}</text>',
            order,
        )

    def svg(self, paper: bool = False) -> str:
        """The picture, to be embedded in a page, or, on white paper of its own, saved."""
        shapes = "".join(shape for _, shape in sorted(self._shapes, key=lambda pair: pair[0]))
        white = ' style="background: #fff"' if paper else ""
        box, alt = f"0 0 {self.width:.0f} {self.height:.0f}", html.escape(self.alt)
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" width="{self.width:.0f}" '
            f'height="{self.height:.0f}" role="img" aria-label="{alt}" font-family="{FONT}"{white}>{shapes}</svg>'
        )

    def _repr_svg_(self) -> str:
        return self.svg(paper=True)


@dataclass(frozen=True)
class Panel:
    """Axes within a drawing: a rectangle (px) and the ranges of x and y that it shows."""

    drawing: Drawing
    left: float
    top: float
    wide: float
    high: float
    x: tuple[float, float]
    y: tuple[float, float]

    def at(self, xs: Array, ys: Array) -> Array:
        """(K, 2) px of points."""
        across = self.left + (np.asarray(xs, float) - self.x[0]) / (self.x[1] - self.x[0]) * self.wide
        down = self.top + (self.y[1] - np.asarray(ys, float)) / (self.y[1] - self.y[0]) * self.high
        return np.column_stack([across, np.clip(down, self.top - 2, self.top + self.high + 2)])

    def frame(self, title: str = "", x_label: str = "", y_label: str = "", y_ticks: bool = True) -> None:
        """Ticks with a faint grid, and what the axes are.

        Args:
            title: above the panel.
            x_label: with the unit.
            y_label: with the unit.
            y_ticks: whether the numbers of the y axis are written.
        """
        low, end = self.top + self.high, self.left + self.wide
        for tick in ticks(*self.x, self._room(self.wide, 90)):
            ((px, _),) = self.at(np.array([tick]), np.array([self.y[0]]))
            self.drawing.line(np.array([[px, self.top], [px, low]]), LINE, 0.8, -2)
            self.drawing.text((px, low + 11), number(tick), size=11, anchor="middle", fill=QUIET)
        y_numbers = ticks(*self.y, self._room(self.high, 33))
        for tick in y_numbers:
            ((_, py),) = self.at(np.array([self.x[0]]), np.array([tick]))
            self.drawing.line(np.array([[self.left, py], [end, py]]), LINE, 0.8, -2)
            if y_ticks:
                self.drawing.text((self.left - 5, py), number(tick), size=11, anchor="end", fill=QUIET)
        self.drawing.text((self.left + self.wide / 2, self.top - 9), title, size=12, anchor="middle")
        self.drawing.text((self.left + self.wide / 2, low + 27), x_label, size=12, anchor="middle")
        if y_label:
            longest = max((len(number(tick)) for tick in y_numbers if y_ticks), default=0)
            middle = (self.left - max(42.0, 14 + 6.7 * longest), self.top + self.high / 2)
            self.drawing.text(middle, y_label, size=12, anchor="middle", turn=-90)

    @staticmethod
    def _room(length: float, each: float) -> int:
        """How many ticks to ask for, so that the two and a half times as many that there may be stand apart."""
        return int(np.clip(length / each, 1, 5))


def ticks(low: float, high: float, wanted: int = 5) -> list[float]:
    """Round numbers between two numbers.

    Args:
        low: the least.
        high: the most.
        wanted: about how many.

    Returns:
        The numbers; none where there is no range.
    """
    if not (math.isfinite(low) and math.isfinite(high) and high > low):
        return []
    step = nice((high - low) / wanted)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [step * n for n in range(first, last + 1)]


def nice(value: float) -> float:
    """The largest of 1, 2, 5, 10, 20, ... that does not exceed the value."""
    value = max(value, TINY)
    power = 10.0 ** math.floor(math.log10(value))
    return float(max(step * power for step in (1, 2, 5) if step * power <= value * (1 + 1e-9)))


def number(value: float) -> str:
    """A tick in words."""
    return f"{value:.6g}".replace("-", "−") if value else "0"


def _pairs(points: Array) -> str:
    return "L".join(f"{x:.1f} {y:.1f}" for x, y in np.asarray(points))
