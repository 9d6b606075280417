"""The waterfall: how the error on rows that took no part in the fit falls as effects enter the model."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from armscope.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, SKY, VERMILION, styled
from armscope.report.subject import Drawn, Subject
from armscope.verdict.schema import Verdict, WaterfallStep
from armscope.verdict.wording import plain

CLEAR = {"facecolor": "white", "edgecolor": "none", "pad": 0.8, "alpha": 0.85}
"""Behind numbers, so that the noise's line does not strike them out."""


def draw_waterfall(
    steps: Sequence[tuple[str, float]],
    noise_mm: float | None,
    references: Sequence[tuple[str, float]] = (),
    spreads: Sequence[float] | None = None,
) -> Figure:
    """Held-out RMS as effects enter, the noise floor, and other models fitted to the same rows.

    Args:
        steps: (what entered, held-out RMS in mm with it), the first without any effect.
        noise_mm: the noise per axis, None where unknown.
        references: (model, held-out RMS in mm), for comparison.
        spreads: standard deviation of each step's RMS from fold to fold, mm: drawn as whiskers.

    Returns:
        The figure.
    """
    heights = [rms for _, rms in steps]
    largest = max(heights)
    shown = [(name, rms) for name, rms in references if np.isfinite(rms)]
    limit = 1.24 * max([largest, *(min(rms, 1.6 * largest) for _, rms in shown)])
    n_bars = len(steps) + len(shown)
    with styled():
        figure, axes = plt.subplots(figsize=(8.2, 0.36 * n_bars + (0.6 if shown else 0) + 1.5))
        for place, (_, rms) in enumerate(steps):
            ends = place in (0, len(steps) - 1)
            if ends:
                axes.barh(place, rms, height=0.62, color=VERMILION if place == 0 else BLUE, zorder=3)
            else:
                _drop(axes, place, heights[place - 1], rms)
            if ends and place > 0:
                _gain(axes, place, heights[place - 1], rms)
            error = None if spreads is None or not np.isfinite(spreads[place]) else spreads[place]
            if error:
                axes.errorbar(rms, place, xerr=error, color=BLACK, linewidth=0.9, capsize=2, zorder=4)
            edge = max(rms, heights[place - 1] if place else rms) + (error or 0)
            axes.text(edge + 0.012 * limit, place, _millimetres(rms), va="center", fontsize=8.5, zorder=7, bbox=CLEAR)
            if place + 1 < len(steps):
                axes.plot([rms, rms], [place - 0.31, place + 1.31], color=GREY, linewidth=0.7, zorder=2)
        start = len(steps) + 0.75
        if shown:
            text = "for comparison, fitted to the same rows:"
            axes.text(0, start - 0.72, text, fontsize=8.5, color="#5C6670", zorder=7, bbox=CLEAR)
        for place, (_, rms) in enumerate(shown):
            axes.barh(start + place, min(rms, limit), height=0.62, color="#C9CFD5", zorder=3)
            beyond = rms > limit
            axes.text(
                (0.985 if beyond else 0.012) * limit + (0 if beyond else rms), start + place,
                _millimetres(rms) + (" →" if beyond else ""), va="center", ha="right" if beyond else "left",
                fontsize=8.5, zorder=7, bbox=None if beyond else CLEAR,
            )  # fmt: skip
        if noise_mm is not None:
            axes.axvline(noise_mm, color=GREEN, linewidth=1.6, linestyle="--", zorder=6)
            axes.annotate(
                f"noise {_millimetres(noise_mm)}", (noise_mm, 1), (4, 3), xycoords=("data", "axes fraction"),
                textcoords="offset points", color=GREEN, fontsize=8.5, fontweight="bold", annotation_clip=False,
            )  # fmt: skip
        ticks = [*range(len(steps)), *(start + np.arange(len(shown)))]
        axes.set_yticks(ticks, [name for name, _ in steps] + [name for name, _ in shown])
        axes.set_ylim(start + len(shown) - 0.3 if shown else len(steps) - 0.4, -0.6)
        axes.set_xlim(0, limit)
        whiskers = "\nwhiskers: standard deviation from fold to fold" if _any(spreads) else ""
        axes.set_xlabel(f"RMS on held-out rows, per axis (mm){whiskers}")
        axes.tick_params(axis="y", length=0)
        axes.spines["left"].set_visible(False)
        axes.grid(axis="y", visible=False)
    return figure


def _drop(axes: Axes, place: int, before: float, after: float) -> None:
    """The bar that remains, pale, and what the step took away, or added."""
    axes.barh(place, min(before, after), height=0.62, color=SKY, alpha=0.35, zorder=3)
    colour = SKY if after <= before else ORANGE
    axes.barh(place, before - after, left=after, height=0.62, color=colour, zorder=3)


def _gain(axes: Axes, place: int, before: float, after: float) -> None:
    """What the last step took away, beside the bar of what is left."""
    axes.barh(place, before - after, left=after, height=0.62, color=SKY if after <= before else ORANGE, zorder=3)


def _any(spreads: Sequence[float] | None) -> bool:
    return spreads is not None and bool(np.isfinite(spreads).any())


def _millimetres(value: float) -> str:
    return f"{value:.3f} mm" if value < 1 else f"{value:.2f} mm"


def waterfall_figure(subject: Subject) -> Iterator[Drawn]:
    """The held-out error as effects enter, beside the paper's models; none where nothing was held out."""
    verdict = subject.verdict
    known = gathered([step for step in waterfall_steps(verdict) if np.isfinite(step.held_out_mm)])
    if known:
        noise = verdict.noise_mm if np.isfinite(verdict.noise_mm) else None
        steps, spreads = [(step.label, step.held_out_mm) for step in known], [step.spread_mm for step in known]
        drawn = draw_waterfall(steps, noise, subject.references, spreads)
        yield Drawn("waterfall", drawn, "Held-out error as effects enter the model, with its spread from fold to fold")


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
