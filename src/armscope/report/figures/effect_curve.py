"""What is left: curves that no effect of the library explains, with their bands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from armscope.core.numerals import shown_unit
from armscope.core.types import Array
from armscope.report.style import BLACK, BLUE, styled
from armscope.report.subject import Drawn, Subject
from armscope.verdict.schema import INTERVAL, FoundEffect
from armscope.verdict.schema import Curve as FoundCurve


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


def effect_curves(subject: Subject) -> Iterator[Drawn]:
    """A curve of every effect whose shape says more than a number, named by the effect's number."""
    for number, effect in enumerate(subject.verdict.effects, start=1):
        if effect.curve is not None and worth_drawing(effect):
            alt = f"What happens at {effect.location} over the {effect.curve.driver}, with its 95 % band"
            yield Drawn(f"curve_{number}", draw_curves([curve_of(effect, effect.curve)]), alt)


def worth_drawing(effect: FoundEffect) -> bool:
    """Whether an effect's curve says more than its one number does."""
    return effect.curve is not None and (effect.effect == "unknown" or len(effect.parameters) > 1)


def curve_of(effect: FoundEffect, found: FoundCurve) -> Curve:
    """An effect's curve in the units of a figure: degrees for angles, µrad or mm for what it does."""
    x, x_unit = (np.degrees(found.at), "deg") if found.driver_unit == "rad" else (found.at, found.driver_unit)
    size = float(np.max(np.abs(found.value), initial=0.0))
    factor, unit = shown_unit(found.value_unit, size)
    value, band = factor * found.value, INTERVAL * factor * found.stderr
    does = "moves by" if found.value_unit.startswith("m") else "turns by"
    return Curve(
        title=f"what {effect.location} does over the {found.driver}",
        x=x,
        value=value,
        low=value - band,
        high=value + band,
        x_label=f"{found.driver} ({x_unit})" if x_unit else found.driver,
        y_label=f"{effect.location} {does} ({unit})",
    )
