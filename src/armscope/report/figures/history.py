"""How the causes that changed did so from recording to recording."""

from __future__ import annotations

import textwrap
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from armscope.comparison import Change, Comparison, Valued
from armscope.comparison.result import moments_of
from armscope.core.inputs import spelt_out
from armscope.core.words import shown_unit
from armscope.verdict.effects import INTERVAL

MOST_PANELS = 8
ACROSS, LONGEST, LETTERS, OF_A_NUMBER = 60, 28, 60, 18
"""Letters that stand beside each other under the panels, of one name, in a line of a title and of a number's name."""
LINE_INCHES = 0.19  # How high such a line is
COLUMNS = [
    "recording", "effect", "location", "parameter", "unit", "value", "stderr", "since_first", "since_first_stderr",
]  # fmt: skip


def told_numbers(found: Comparison) -> list[tuple[Change, Valued]]:
    """The numbers of every cause that changed, but for those of which the rows leave open how far."""
    return [(each, number) for each in found.changes for number in each.parameters if not number.unknown]


def drawn_numbers(found: Comparison) -> list[tuple[Change, Valued]]:
    """Those of them that have a panel, as many as there is room for: no products with mass moments beside a compliance.

    Of each product hardly anything is known, and the card tells them as one.
    """
    numbers = [(each, number) for each in found.changes for number in _by_themselves(each)]
    return numbers[:MOST_PANELS]


def _by_themselves(change: Change) -> list[Valued]:
    told, moments = [number for number in change.parameters if not number.unknown], moments_of(change)
    return [number for number in told if number not in moments] or told


def history_table(found: Comparison) -> pd.DataFrame:
    """One row per recording and number that is told of every cause that changed."""
    rows = [
        (name, each.effect, each.location, number.name, number.unit, *numbers)
        for each, number in told_numbers(found)
        for name, *numbers in zip(
            found.names, number.values, number.stderrs, number.since_first, number.since_first_stderrs, strict=True
        )
    ]
    return pd.DataFrame(rows, columns=COLUMNS)


def history_figure(found: Comparison) -> Figure:
    """A panel per number: how far it is from the first recording, with a 95 % interval; those that differ filled."""
    numbers = drawn_numbers(found)
    named = [textwrap.fill(number.name.replace("_", " "), OF_A_NUMBER) for _, number in numbers]
    most = max(name.count("\n") for name in named) + 3
    size = (7.0, 1.6 + max(1.4, 0.3 + LINE_INCHES * most) * len(numbers))
    figure, panels = plt.subplots(len(numbers), 1, figsize=size, sharex=True, squeeze=False, layout="constrained")
    at, first = np.arange(len(found.names)), _shortened(found.names[0])
    what = "difference" if found.of_arms else "change"
    for (each, number), name, axes in zip(numbers, named, panels[:, 0], strict=True):
        factor, unit = shown_unit(number.unit, float(np.max(np.abs(number.since_first))))
        values, errors = factor * np.array(number.since_first), factor * INTERVAL * np.array(number.since_first_stderrs)
        differs = np.isin(found.names, each.where)
        axes.errorbar(at, values, errors, fmt="none", ecolor="0.5", capsize=3)
        if not found.of_arms:  # which have no order in time
            axes.plot(at, values, color="0.8", zorder=0)
        axes.plot(at[~differs], values[~differs], "o", markerfacecolor="white", color="#0072B2")
        axes.plot(at[differs], values[differs], "o", color="#D55E00")
        upright: dict[str, Any] = {"rotation": 0, "ha": "right", "va": "center"}  # on its side, it reaches the next one
        axes.set_ylabel(f"{what} of\n{name}\n({unit})", fontsize="small", **upright)
        if number is next(told for change, told in numbers if change is each):
            title = textwrap.fill(spelt_out(f"{each.title}: {found.became(each)}"), LETTERS)
            axes.set_title(title, loc="left", fontsize="medium")
        axes.margins(x=0.1, y=0.2)
    crowded = len(found.names) * max(map(len, found.names)) > ACROSS
    look: dict[str, Any] = {"rotation": 30, "ha": "right", "rotation_mode": "anchor"} if crowded else {}
    panels[-1, 0].set_xticks(at, [_shortened(name) for name in found.names], **look)
    first = f"arm (difference from {first}" if found.of_arms else f"recording (change since {first}"
    figure.supxlabel(f"{first}; bars: 95 %; filled: where it differs)", fontsize="small")
    return figure


def _shortened(name: str) -> str:
    told = spelt_out(name)
    return told if len(told) <= LONGEST else f"{told[: LONGEST // 2]}…{told[-LONGEST // 2 + 1 :]}"
