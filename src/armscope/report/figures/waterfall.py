"""The waterfall: how the error on rows that took no part in the fit falls as effects enter the model."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.report.colours import AFTER, BEFORE, GAIN, GOOD, INK, LINE, LOSS, OTHERS, PALE, QUIET, Key
from armscope.report.sectioning import Drawn, Subject
from armscope.report.svg import LETTER, Drawing, number, ticks
from armscope.verdict.schema import Verdict, WaterfallStep
from armscope.verdict.wording import plain

WIDTH, ROW, BAR, LETTERS = 860.0, 27.0, 17.0, 12.0  # Of the picture, of a row and of its bar, and of the words, px
WIDEST_NAMES = 390.0
NARROW, WITH_NAME = 480.0, 45.0  # Of a picture for telephones, and of a row whose name stands above its bar, px
BEYOND = 1.6  # Other models' errors are drawn up to so many times the largest of the steps
STEPS = (
    Key(PALE, "what remains", "wide"), Key(GAIN, "what the step took away", "wide"), Key(LOSS, "what it added", "wide"),
    Key(AFTER, "what remains at the end", "wide"),
)  # fmt: skip
OTHER_MODELS = Key(OTHERS, "other models", "wide")  # What the colours of the bars stand for


@dataclass(frozen=True)
class Quantity:
    """What the bars are long by: the axis' words, and a value in words."""

    axis: str
    words: Callable[[float], str]


def _millimetres(value: float) -> str:
    return f"{value:.3f} mm" if value < 1 else f"{value:.2f} mm"


POSITIONS = Quantity("RMS on held-out rows, per axis (mm)", _millimetres)


def draw_waterfall(
    steps: Sequence[tuple[str, float]],
    noise: float | None,
    references: Sequence[tuple[str, float]] = (),
    spreads: Sequence[float] | None = None,
    quantity: Quantity = POSITIONS,
    narrow: bool = False,
) -> Drawing:
    """Held-out error as effects enter, the noise floor, and other models fitted to the same rows.

    Args:
        steps: (what entered, held-out error with it, in the unit of the quantity), the first without any effect.
        noise: in that unit, None where unknown.
        references: (model, held-out error), for comparison.
        spreads: standard deviation of each step's error from fold to fold: drawn as whiskers.
        quantity: what the error is.
        narrow: whether names stand above the bars, so that the figure can be read on a telephone.

    Returns:
        The figure.
    """
    shown = [(name, rms) for name, rms in references if np.isfinite(rms)]
    kind = _NarrowBars if narrow else _Bars
    return kind(steps, noise, shown, spreads or [np.nan] * len(steps), quantity).drawn()


class _Bars:
    """Bars under each other, their names beside them; x turns errors into px."""

    width, row = WIDTH, ROW

    def __init__(
        self,
        steps: Sequence[tuple[str, float]],
        noise: float | None,
        others: Sequence[tuple[str, float]],
        spreads: Sequence[float],
        quantity: Quantity,
    ) -> None:
        self.steps, self.noise, self.others, self.spreads = steps, noise, others, spreads
        self.quantity = quantity
        largest = max(rms for _, rms in steps)
        self.limit = 1.2 * max([largest, *(min(rms, BEYOND * largest) for _, rms in others)])
        self.left = self.beside([name for name, _ in [*steps, *others]])
        self.top, gap = 26.0, 30.0 if others else 0.0
        self.bottom = self.top + self.row * (len(steps) + len(others)) + gap
        self.drawing = Drawing(
            self.width, self.bottom + 46, "Held-out error as effects enter the model, with its spread from fold to fold"
        )

    @staticmethod
    def beside(names: Sequence[str]) -> float:
        """Where bars begin, px."""
        return float(min(LETTER * LETTERS * max(map(len, names)) + 14, WIDEST_NAMES))

    def name(self, middle: float, words: str, **look: str) -> None:
        """A bar's name."""
        self.drawing.text((self.left - 8, middle), words, size=LETTERS, anchor="end", **look)

    def x(self, error: float) -> float:
        return self.left + min(error, self.limit) / self.limit * (self.width - self.left - 14)

    def middle(self, top: float) -> float:
        """Of a row's bar."""
        return top + self.row - ROW / 2

    def bar(self, top: float, start: float, end: float, colour: str) -> None:
        low, high = sorted((self.x(start), self.x(end)))
        self.drawing.rectangle((low, self.middle(top) - BAR / 2), (high - low, BAR), colour)

    def drawn(self) -> Drawing:
        self.axis()
        for place, (name, rms) in enumerate(self.steps):
            self.step(place, name, rms)
        start = self.top + self.row * len(self.steps) + 30
        if self.others:
            words = "for comparison, fitted to the same rows:"
            self.drawing.text((self.left, start - 12), words, size=LETTERS, fill=QUIET)
        for place, (name, rms) in enumerate(self.others):
            top, beyond = start + self.row * place, rms > self.limit
            middle = self.middle(top)
            self.name(middle, name, fill=QUIET)
            self.bar(top, 0, rms, OTHERS)
            at = (self.width - 20, middle) if beyond else (self.x(rms) + 6, middle)
            words = self.quantity.words(rms) + (" →" if beyond else "")
            self.drawing.text(at, words, size=LETTERS, anchor="end" if beyond else "start")
        return self.drawing

    def step(self, place: int, name: str, rms: float) -> None:
        top, last = self.top + self.row * place, len(self.steps) - 1
        middle, before = self.middle(top), self.steps[place - 1][1] if place else rms
        self.name(middle, name)
        if place in (0, last):
            self.bar(top, 0, rms, AFTER if place else BEFORE)
        else:
            self.bar(top, 0, min(before, rms), PALE)
        if place:
            self.bar(top, rms, before, GAIN if rms <= before else LOSS)
        spread = self.spreads[place] if np.isfinite(self.spreads[place]) else 0.0
        if spread:
            ends = np.array([[self.x(max(rms - spread, 0)), middle], [self.x(rms + spread), middle]])
            self.drawing.line(ends, INK, 1.2, 2)
        edge = self.x(max(rms + spread, before)) + 6
        self.drawing.text((edge, middle), self.quantity.words(rms), size=LETTERS)

    def axis(self) -> None:
        for tick in ticks(0, self.limit):
            x = self.x(tick)
            self.drawing.line(np.array([[x, self.top - 4], [x, self.bottom]]), LINE, 0.8, -2)
            self.drawing.text((x, self.bottom + 10), number(tick), size=11, anchor="middle", fill=QUIET)
        whiskers = "; whiskers: standard deviation from fold to fold" if np.isfinite(self.spreads).any() else ""
        words = f"{self.quantity.axis}{whiskers}"
        self.drawing.text(((self.left + self.width) / 2, self.bottom + 30), words, size=LETTERS, anchor="middle")
        if self.noise is not None:
            x = self.x(self.noise)
            self.drawing.line(np.array([[x, self.top - 6], [x, self.bottom]]), GOOD, 1.8, 3, "6 4")
            words = f"noise {self.quantity.words(self.noise)}"
            self.drawing.text((x + 3, self.top - 14), words, size=LETTERS, fill=GOOD, weight="bold")


class _NarrowBars(_Bars):
    """Names above the bars."""

    width, row = NARROW, WITH_NAME

    @staticmethod
    def beside(names: Sequence[str]) -> float:
        return 6.0

    def name(self, middle: float, words: str, **look: str) -> None:
        self.drawing.text((self.left, middle - BAR / 2 - 9), words, size=LETTERS, **look)


def waterfall_figure(subject: Subject) -> Iterator[Drawn]:
    """The held-out error as effects enter, beside the paper's models; none where nothing was held out."""
    verdict = subject.verdict
    known = gathered([step for step in waterfall_steps(verdict) if np.isfinite(step.held_out_mm)])
    if known:
        noise = verdict.noise_mm if np.isfinite(verdict.noise_mm) else None
        steps, spreads = [(step.label, step.held_out_mm) for step in known], [step.spread_mm for step in known]
        drawn = draw_waterfall(steps, noise, subject.references, spreads)
        yield Drawn("waterfall", drawn)


def waterfall_steps(verdict: Verdict) -> list[WaterfallStep]:
    """The verdict's steps in plain words, without a last one for tolerances that nobody asked for."""
    steps = list(verdict.waterfall)
    if len(steps) > 1 and not verdict.background.present and steps[-1].label.startswith("tolerances"):
        steps.pop()
    return [
        replace(step, label=f"+ {plain(step.label)}" if number else "base and tool placed, no effect")
        for number, step in enumerate(steps)
    ]


def gathered(steps: Sequence[WaterfallStep]) -> list[WaterfallStep]:
    """The steps with minor effects that follow one another taken as one: together they are hardly to be seen."""
    together: list[WaterfallStep] = []
    for minor, group in itertools.groupby(steps, lambda step: step.minor):
        members = list(group)
        if minor and len(members) > 1:
            members = [replace(members[-1], label=f"+ {len(members)} minor effects")]
        together += members
    return together
