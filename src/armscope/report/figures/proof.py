"""The proof as figures: aims, power, confusions, scores per effect, outcomes, held-out rows."""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogFormatter

from armscope.proof.scoring import NOTHING
from armscope.report.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    SKY,
    VERMILION,
    YELLOW,
    in_margin,
    legend_above,
    styled,
)
from armscope.verdict.effects import UNKNOWN

HALVES = {"fixed": (GREY, "s"), "fresh": (BLUE, "o")}  # Colour and marker of worlds with fixed and with fresh seeds
FOUND = {"seen": (ORANGE, "s", "a mismatch is stated"), "right": (BLUE, "o", "named right")}
OUTCOME_COLOURS = {
    "named": BLUE, "acceptable": SKY, "listed": GREEN, "located": YELLOW, "missed": VERMILION,
}  # fmt: skip
OUTSIDE_COLOURS = {
    "located": BLUE, "acceptable": SKY, "partly named": GREEN, "elsewhere": YELLOW, "cannot tell": GREY,
    "missed": ORANGE, "misnamed": VERMILION, "failed": BLACK,
}  # fmt: skip
SCORES = ("recall", "precision", "location", "coverage")
NOISE_OF_TEXT = 0.55  # Share of a matrix row from which its number stands white on dark


def draw_all(tables: Path) -> dict[str, Figure]:
    """Every figure by name, from the tables of `armscope proof score`."""
    drawing: dict[str, Callable[[dict[str, pd.DataFrame]], Figure]] = {
        "aims": aims, "power": power, "confusion": confusion, "per_effect": per_effect, "outcomes": outcomes,
        "outside": outside, "held_out": held_out,
    }  # fmt: skip
    read = {path.stem: _read(path) for path in tables.glob("*.csv")}
    with styled():
        return {name: draw(read) for name, draw in drawing.items()}


def _read(path: Path) -> pd.DataFrame:
    try:
        return pd.read_csv(path, keep_default_na=True)
    except pd.errors.EmptyDataError:
        return pd.DataFrame()


def aims(tables: dict[str, pd.DataFrame]) -> Figure:
    """Each aim's estimate with its 95 % interval, fixed and fresh seeds, over the range that the aim asks for."""
    table = tables["aims"]
    rates, limit = table[table["most"] <= 1], table[table["most"] > 1]
    height = 1.0 + 0.42 * rates["aim"].nunique()
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, height), width_ratios=[4, 1], layout="constrained")
    _aim_rows(left, rates)
    left.set(xlim=(-2, 102), xlabel="share of cases, %")
    _aim_rows(right, limit, percent=1.0, name="detected at\n90 %")
    right.set(
        xlabel="multiples of the\noracle's threshold", xlim=(0, max(2.0, np.nanmax([2.0, *limit["high"]]) * 1.05))
    )
    handles = [Line2D([], [], color=c, marker=m, ls="-", label=f"{half} seeds") for half, (c, m) in HALVES.items()]
    legend_above(figure, [*handles, Patch(color=GREEN, alpha=0.25, label="the aim")], columns=3)
    return figure


def _aim_rows(axes: Axes, table: pd.DataFrame, percent: float = 100.0, name: str = "") -> None:
    texts = list(dict.fromkeys(table["aim"]))
    for row, text in enumerate(texts):
        for shift, (half, (colour, marker)) in zip((-0.16, 0.16), HALVES.items(), strict=True):
            for _, case in table[(table["aim"] == text) & (table["seeds"] == half)].iterrows():
                y = row + shift
                least, most = case["least"] * percent, case["most"] * percent
                # an aim of exactly 100 % is still to be seen
                axes.barh(row, max(most - least, 0.8), left=least, height=0.8, color=GREEN, alpha=0.12, zorder=0)
                if not np.isfinite(case["estimate"]):
                    in_margin(axes, y, f"{int(case['cases'])} cases: too few", colour, x=0.02)
                    continue
                axes.plot([case["low"] * percent, case["high"] * percent], [y, y], color=colour, lw=1.6)
                axes.plot(case["estimate"] * percent, y, marker=marker, color=colour, ms=5)
                if percent != 1:
                    in_margin(axes, y, f"n = {int(case['cases'])}", colour)
    labels = [name] if name else [textwrap.fill(text, 45) for text in texts]
    axes.set_yticks(range(len(texts)), labels if texts else [])
    axes.set_ylim(len(texts) - 0.4, -0.6)
    axes.grid(axis="y", visible=False)


def power(tables: dict[str, pd.DataFrame]) -> Figure:
    """Share found over size: against the oracle's threshold, and against the noise of one reading."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 3.8), sharey=True, layout="constrained")
    _curves(left, tables["power"], "size")
    left.axvline(1, color=GREY, lw=0.8, ls=":")
    left.set(xlabel="size in multiples of the oracle's 90 % threshold in the same poses", ylabel="share found, %")
    _curves(right, tables["strength"], "strength")
    right.set(xlabel="RMS at the tool in multiples of the noise of one reading")
    for axes in (left, right):
        axes.set(xscale="log", ylim=(-3, 103))
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
        axes.xaxis.set_minor_formatter(LogFormatter())  # 3, 4, 5 within one decade, not 3 x 10^0
    handles = [Line2D([], [], color=c, marker=m, label=label) for c, m, label in FOUND.values()]
    handles.append(Line2D([], [], color=BLACK, ls="--", label="oracle that knows what to test (1 % false alarms)"))
    legend_above(figure, handles, columns=3)
    return figure


def _curves(axes: Axes, table: pd.DataFrame, over: str) -> None:
    if table.empty:
        return
    rows = table[table["seeds"] == "all"]
    for shift, (found, (colour, marker, _)) in zip((0.97, 1.03), FOUND.items(), strict=True):
        curve = rows[rows["found"] == found]
        y = curve["estimate"] * 100
        errors = np.array([y - curve["low"] * 100, curve["high"] * 100 - y])
        axes.errorbar(curve[over] * shift, y, errors, color=colour, marker=marker, ms=4, capsize=2)
    oracle = rows[rows["found"] == "seen"]
    axes.plot(oracle[over], oracle["oracle"] * 100, color=BLACK, ls="--")


def confusion(tables: dict[str, pd.DataFrame]) -> Figure:
    """What was concealed against what was said, counts; shaded by the share of the row."""
    table = tables["confusion"]
    names = sorted({*table["true"], *table["said"]} - {UNKNOWN, NOTHING})
    names += [UNKNOWN, NOTHING]
    counts = table.pivot_table(index="true", columns="said", values="effects", aggfunc="sum").reindex(
        index=names, columns=names
    )
    counts = counts.fillna(0).astype(int)
    share = counts.to_numpy() / np.maximum(counts.to_numpy().sum(axis=1, keepdims=True), 1)
    size = 1.6 + 0.36 * len(names)
    figure, axes = plt.subplots(figsize=(size + 1.4, size + 0.4), layout="constrained")
    axes.imshow(share, cmap="Blues", vmin=0, vmax=1, aspect="equal")
    for i, j in zip(*np.nonzero(counts.to_numpy()), strict=True):
        colour = "white" if share[i, j] > NOISE_OF_TEXT else BLACK
        axes.text(j, i, str(counts.iat[i, j]), ha="center", va="center", color=colour, fontsize=7)
    words = [name.replace("_", " ") for name in names]
    axes.set_xticks(range(len(names)), words, rotation=60, ha="right", rotation_mode="anchor")
    axes.set_yticks(range(len(names)), words)
    axes.set(xlabel="said by the diagnosis", ylabel="concealed")
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    return figure


def per_effect(tables: dict[str, pd.DataFrame]) -> Figure:
    """Recall, precision, right location and coverage of each effect with 95 % intervals, all seeds."""
    table = tables["per_effect"]
    table = table[(table["seeds"] == "all") & table["score"].isin(SCORES)]
    names = sorted(set(table["effect"]), key=lambda name: (name == UNKNOWN, name))
    figure, panels = plt.subplots(
        1, len(SCORES), figsize=(9.6, 1.3 + 0.25 * len(names)), sharey=True, layout="constrained"
    )
    for axes, score in zip(panels, SCORES, strict=True):
        rows = table[table["score"] == score].set_index("effect").reindex(names)
        y = np.arange(len(names))
        axes.hlines(y, rows["low"] * 100, rows["high"] * 100, color=BLUE, lw=1.4)
        axes.plot(rows["estimate"] * 100, y, "o", color=BLUE, ms=4)
        for at, cases in zip(y, rows["cases"], strict=True):
            in_margin(axes, float(at), f"{cases:.0f}" if cases > 0 else "–")
        axes.set(title=score, xlim=(-4, 104), xlabel="%")
    panels[-1].axvspan(93, 97, color=GREEN, alpha=0.2, lw=0)
    panels[0].set_yticks(range(len(names)), [name.replace("_", " ") for name in names])
    panels[0].set_ylim(max(len(names), 1) - 0.5, -0.5)
    return figure


def outcomes(tables: dict[str, pd.DataFrame]) -> Figure:
    """How the concealed effects of each category ended, fresh beside fixed seeds."""
    table = tables["effect_outcomes"]
    return _stacked(table, "category", "outcome", "effects", OUTCOME_COLOURS, "share of concealed effects, %")


def outside(tables: dict[str, pd.DataFrame]) -> Figure:
    """How worlds with an effect outside the library were answered, by its shape."""
    return _stacked(tables["outside"], "shape", "outside", "worlds", OUTSIDE_COLOURS, "share of worlds, %")


def _stacked(table: pd.DataFrame, group: str, part: str, count: str, colours: dict[str, str], label: str) -> Figure:
    groups = list(dict.fromkeys(table[group]))
    figure, panels = plt.subplots(
        1, 2, figsize=(9.6, 1.5 + 0.3 * max(len(groups), 1)), sharey=True, layout="constrained"
    )
    for axes, half in zip(panels, HALVES, strict=True):
        rows = table[table["seeds"] == half]
        wide = rows.pivot_table(index=group, columns=part, values=count, aggfunc="sum").reindex(groups).fillna(0)
        total = wide.sum(axis=1)
        start = np.zeros(len(groups))
        for name, colour in colours.items():
            if name in wide:
                width = 100 * (wide[name] / total.where(total > 0)).fillna(0).to_numpy()
                axes.barh(range(len(groups)), width, left=start, color=colour, edgecolor="white", lw=0.5)
                start += width
        for at, number in enumerate(total):
            in_margin(axes, at, f"{number:.0f}")
        axes.set(title=f"{half} seeds", xlabel=label, xlim=(0, 100))
        axes.grid(axis="y", visible=False)
    panels[0].set_yticks(range(len(groups)), [name.replace("_", " ") for name in groups])
    panels[0].set_ylim(max(len(groups), 1) - 0.5, -0.5)
    used = [name for name in colours if name in set(table[part])]
    legend_above(figure, [Patch(color=colours[name], label=name) for name in used], columns=max(len(used), 1))
    return figure


def held_out(tables: dict[str, pd.DataFrame]) -> Figure:
    """Held-out RMS over the true model's in every world, by category."""
    worlds = tables["worlds"]
    groups = list(dict.fromkeys(worlds["category"]))
    figure, axes = plt.subplots(figsize=(9.6, 3.8), layout="constrained")
    rng = np.random.default_rng(0)
    axes.axhspan(-100, 5, color=GREEN, alpha=0.15, lw=0)
    for at, group in enumerate(groups):
        for fresh, half in ((False, "fixed"), (True, "fresh")):
            colour, marker = HALVES[half]
            ratio = worlds[(worlds["category"] == group) & (worlds["fresh"] == fresh)]["held_out_ratio"].astype(float)
            excess = 100 * (ratio - 1)
            x = at + (0.18 if fresh else -0.18) + rng.uniform(-0.13, 0.13, len(ratio))
            axes.plot(x, excess, marker, color=colour, ms=3, alpha=0.6, mew=0)
            left = at + (0.03 if fresh else -0.33)
            axes.hlines(excess.median(), left, left + 0.3, color=BLACK)
    # linear around the true model's, logarithmic far above it
    axes.set_yscale("symlog", linthresh=10)
    axes.set_ylabel("held-out RMS above the true model's, %")
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    ticks = [-5, 0, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000]
    excesses = 100 * (worlds["held_out_ratio"][np.isfinite(worlds["held_out_ratio"])] - 1)
    top = max(20.0, 1.3 * float(excesses.max()))
    axes.set_yticks([tick for tick in ticks if tick < top])
    axes.set_ylim(-9, top)
    axes.set_xticks(range(len(groups)), [group.replace("_", " ") for group in groups])
    axes.grid(axis="x", visible=False)
    dots = [Line2D([], [], color=c, marker=m, ls="", label=f"{half} seeds") for half, (c, m) in HALVES.items()]
    rest = [Line2D([], [], color=BLACK, label="median"), Patch(color=GREEN, alpha=0.25, label="within 5 %")]
    legend_above(figure, [*dots, *rest], columns=4)
    return figure
