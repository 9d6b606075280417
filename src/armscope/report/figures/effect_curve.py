"""What is left: curves that no effect of the library explains, with their bands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array
from armscope.core.words import shown_unit
from armscope.report.colours import AFTER, OUTLINE, PALE
from armscope.report.sectioning import Drawn, Subject
from armscope.report.svg import Drawing, Panel
from armscope.verdict.effects import INTERVAL, Curve, FoundEffect

WIDTH, HEIGHT = 440.0, 220.0  # Of a curve's picture, px


@dataclass(frozen=True, eq=False)
class DrawnCurve:
    """One curve to draw."""

    title: str  # where it is and what it follows
    # x, value, low, high: (K,) the driver, the curve and its 95 % band, in the units that the labels name
    x: Array
    value: Array
    low: Array
    high: Array
    x_label: str
    y_label: str
    # (N,) the driver at the recorded rows, drawn as ticks at the bottom; None leaves them out
    rows: Array | None = None


def draw_curves(curves: Sequence[DrawnCurve]) -> Drawing:
    """Each curve with its band in a panel of its own, under each other."""
    drawing = Drawing(WIDTH, HEIGHT * len(curves), "; ".join(f"{curve.title}, with its 95 % band" for curve in curves))
    for place, curve in enumerate(curves):
        low, high = float(np.min(curve.low)), float(np.max(curve.high))
        edge = 0.06 * max(high - low, 1e-12)
        ranges = (float(curve.x.min()), float(curve.x.max())), (min(low, 0.0) - edge, max(high, 0.0) + edge)
        panel = Panel(drawing, 64, HEIGHT * place + 26, WIDTH - 76, HEIGHT - 70, *ranges)
        panel.frame(curve.title, curve.x_label, curve.y_label)
        band = np.vstack([panel.at(curve.x, curve.high), panel.at(curve.x, curve.low)[::-1]])
        drawing.polygon(band, PALE, order=-1)
        drawing.line(panel.at(np.array(ranges[0]), np.zeros(2)), OUTLINE, 0.8)
        drawing.line(panel.at(curve.x, curve.value), AFTER, 2)
        if curve.rows is not None:
            marks = np.unique(np.quantile(curve.rows, np.linspace(0, 1, 120)))
            for x, y in panel.at(marks, np.full(len(marks), ranges[1][0])):
                drawing.line(np.array([[x, y], [x, y - 5]]), OUTLINE, 0.6)
    return drawing


def effect_curves(subject: Subject) -> Iterator[Drawn]:
    """A curve of every effect whose shape says more than a number, named by the effect's number."""
    for number, effect in enumerate(subject.verdict.effects, start=1):
        if effect.curve is not None and worth_drawing(effect):
            yield Drawn(f"curve_{number}", draw_curves([drawn_curve(effect, effect.curve)]))


def worth_drawing(effect: FoundEffect) -> bool:
    """Whether an effect's curve says more than its one number does."""
    return effect.curve is not None and (effect.nameless or len(effect.parameters) > 1)


def drawn_curve(effect: FoundEffect, found: Curve) -> DrawnCurve:
    """An effect's curve in the units of a figure: degrees for angles, µrad or mm for what it does."""
    x, x_unit = (np.degrees(found.at), "deg") if found.driver_unit == "rad" else (found.at, found.driver_unit)
    size = float(np.max(np.abs(found.value), initial=0.0))
    factor, unit = shown_unit(found.value_unit, size)
    value, band = factor * found.value, INTERVAL * factor * found.stderr
    does = "moves by" if found.value_unit.startswith("m") else "turns by"
    return DrawnCurve(
        title=f"what {effect.location} does over the {found.driver}",
        x=x,
        value=value,
        low=value - band,
        high=value + band,
        x_label=f"{found.driver} ({x_unit})" if x_unit else found.driver,
        y_label=f"{effect.location} {does} ({unit})",
    )
