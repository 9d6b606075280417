"""How a name comes about: the three pictures and the measured rates of docs/why-a-name.md.

    python -m tools.why_a_name                                   # draws the pictures, from a simulated arm
    python -m tools.why_a_name --rates results/bench/figures.json   # fills the tables of the page and of README.md

The arm is one of the proof's (another engine than the diagnosis', seeded): D-H errors and some give everywhere, and
four effects that stand out of them. No recording of a real arm takes part.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from armscope.core.types import Array, Indices
from armscope.diagnosis.constants import NAMING
from armscope.diagnosis.held_out import split_rows
from armscope.diagnosis.held_out_worth import held_out_gains, without_members
from armscope.diagnosis.selection import select
from armscope.diagnosis.state import Selected
from armscope.fitting.linearisation import LinearisedTable
from armscope.fitting.registration import fit_frames
from armscope.inference.additions import best_additions
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.prices import negative_log_prior
from armscope.inference.problem import Problem, SelectedEffect
from armscope.inference.search import Search
from armscope.measurement.channel import CHANNELS, nuisances, supported
from armscope.measurement.noise import known_noise
from armscope.physics.backgrounds import FAMILIES
from armscope.physics.form_constants import FORM
from armscope.recordings import read_recordings
from armscope.report.style import BLUE, GREY, ORANGE, VERMILION, save_figure, styled
from armscope.robot import load_arm
from armscope.world.folder import build
from armscope.world.spec import EffectSpec, WorldSpec
from tools import bench

ROOT = Path(__file__).parents[1]
FIGURES = ROOT / "docs" / "figures"
SEED, ROWS, NOISE_MM = 13, 250, 0.03
STORY = (
    EffectSpec(kind="backlash", strength=3.0, location="joint 4"),
    EffectSpec(kind="link_geometry", strength=20.0, location="link 2"),
    EffectSpec(kind="joint_compliance", strength=5.0, location="joint 2"),
    EffectSpec(kind="gear_eccentricity", strength=4.0, location="joint 1"),
)
EVERYWHERE = {
    "joint_offset": (1.5, 4.0),
    "link_geometry": (1.5, 4.0),
    "joint_compliance": (0.3, 1.0),
    "bearing_compliance": (0.2, 0.6),
}
"""Sizes between which what every joint and link has is drawn, as a multiple of the noise."""
WORDS = {"geometric": "small D-H errors everywhere", "elastic": "a little give everywhere"}


def world() -> WorldSpec:
    """The arm of the pictures: what it conceals, the story first."""
    rng = np.random.default_rng(SEED)
    effects = list(STORY)
    taken = {(asked.kind, asked.location) for asked in STORY}
    for kind, (low, high) in EVERYWHERE.items():
        for number in range(1, 7):
            place = f"{'link' if kind.startswith('link') else 'joint'} {number}"
            if (kind, place) not in taken:
                size = round(float(rng.uniform(low, high)), 3)
                effects.append(EffectSpec(kind=kind, strength=size, location=place, minor=True))
    return WorldSpec(
        id="arm", category="real", arm="six-axis", seed=SEED, fresh=False, rows=ROWS, sigma_mm=NOISE_MM,
        effects=tuple(effects),
    )  # fmt: skip


def diagnosed(spec: WorldSpec) -> Selected:
    """What the rounds of the diagnosis end with on an arm's recordings."""
    with tempfile.TemporaryDirectory() as folder:
        seen = build(spec, Path(folder), ROOT / "config" / "robots") / "visible"
        arm = load_arm(seen / "robot.yaml")
        rows = read_recordings(seen / "recordings.csv", arm.n_motors)
    channels = supported(rows, CHANNELS)
    layout = split_rows(rows, np.random.default_rng(0))
    table = LinearisedTable(rows, channels)
    frames = nuisances(channels, rows, False)
    start = fit_frames(arm, rows, False)
    return select(start, table, known_noise(arm, rows), frames, layout.of_row, lambda text, share: None)


@dataclass(frozen=True)
class Step:
    """One step of the search: what was added, what it pays and what evidence it brings, nats."""

    words: str
    price: float
    evidence: float


def _step(words: str, problem: Problem, before: Hypothesis, after: Hypothesis) -> Step:
    price = _price(problem, after) - _price(problem, before)
    return Step(words, price, after.log_posterior - before.log_posterior + price)


def _price(problem: Problem, hypothesis: Hypothesis) -> float:
    return negative_log_prior(problem, hypothesis.chosen, hypothesis.background, np.empty(0))  # halves: evidence


def steps(found: Selected) -> list[Step]:
    """From frames alone to what the search ended with, what helps most first; and the best that was not worth it."""
    problem, end, search = found.problem, found.found, Search.on(found.problem)
    at, told = search.start((0,) * len(end.background)), []
    for family, size in enumerate(end.background):
        if size:
            grown = tuple(s if n <= family else 0 for n, s in enumerate(end.background))
            told.append(_step(WORDS[FAMILIES[family]], problem, at, at := evaluate(problem, (), grown, at.noise)))
    left = list(end.chosen)
    while left:
        options = [evaluate(problem, (*at.chosen, each), at.background, at.noise) for each in left]
        best = int(np.argmax([option.log_posterior for option in options]))
        told.append(_step(_label(found, left.pop(best).candidate), problem, at, at := options[best]))
    number, tried = _next(found)
    return [*told, _step(f"{_label(found, number)}?", problem, end, tried)]


def _next(found: Selected) -> tuple[int, Hypothesis]:
    """The best name that the search left out, of what no family holds, and the hypothesis with it."""
    search = Search.on(found.problem)
    gain, size = best_additions(found.problem, search.groups, found.found)
    inside = [n for n in range(len(gain)) if search.in_background(found.found, n)]
    gain[inside] = -np.inf
    number = int(np.argmax(gain))
    added = SelectedEffect(number, int(size[number]))
    end = found.found
    return number, evaluate(found.problem, (*end.chosen, added), end.background, end.noise)


def _label(found: Selected, number: int) -> str:
    candidate = found.space.candidates[number]
    return f"{candidate.kind} at {candidate.location}".replace("_", " ")


def _listed(panel: Axes, words: Sequence[str], size: int | None, measure: str) -> None:
    """One row per name, the first on top."""
    panel.set_yticks(range(len(words)), words, fontsize=size)
    panel.invert_yaxis()
    panel.grid(visible=False, axis="y")
    panel.set_xlabel(measure)


def evidence_figure(told: Sequence[Step]) -> Figure:
    """Evidence of each step beside its price."""
    with styled():
        figure, panel = plt.subplots(figsize=(6.4, 0.5 + 0.42 * len(told)))
        for y, step in enumerate(told):
            pays = step.evidence > step.price
            panel.barh(y, step.evidence, color=BLUE if pays else ORANGE, height=0.6, hatch=None if pays else "///")
            panel.plot([step.price] * 2, [y - 0.42, y + 0.42], color=VERMILION, lw=2.5)
            text = f"{step.evidence:.0f}" if pays else f"{step.evidence:.1f}, price {step.price:.1f}: stays out"
            panel.text(max(step.evidence, step.price) * 1.15, y, text, va="center", fontsize=8)
        panel.set_axisbelow(True)
        panel.set_xscale("symlog", linthresh=1.0)
        panel.set_xlim(0, 12 * max(step.evidence for step in told))
        measure = "evidence that the step brings (nats, logarithmic); red mark: its price"
        _listed(panel, [step.words for step in told], None, measure)
    return figure


@dataclass(frozen=True)
class Member:
    """A D-H value, mm or mrad, with its standard error, and how far it is out of its family."""

    words: str
    unit: str
    value: float
    stderr: float
    beyond: float
    named: bool


def members(found: Selected) -> tuple[list[Member], float]:
    """The D-H values as the search leaves them, and the share of its tolerance that the family was found to have."""
    at, problem = found.found, found.problem
    family, size, variance = problem.space.families[0], at.background[0], np.zeros(len(problem.scale))
    variance[family.columns] = family.prior_variance(size, problem.scale)
    names = {found.space.placed[c.candidate].key for c in found.best.chosen}
    told: list[Member] = []
    seen: set[int] = set()
    for number, candidate in enumerate(found.space.candidates):
        columns = candidate.columns
        if not set(columns) <= set(family.columns) or seen & set(columns):
            continue
        seen |= set(columns)
        # mm at the tool by 1 mm or 1 mrad
        unit = np.sqrt(variance[columns]) / family.label(size) / (1e3 * FORM.tolerance)
        beyond = _beyond(at, family.columns, columns, variance)
        for k, term in enumerate(found.space.placed[number].terms):
            words = f"{candidate.location}: {term.name.replace('_', ' ')}"
            value, error = at.means(columns)[k], np.sqrt(at.variances(columns)[k])
            shown = "mm" if term.unit == "mm" else "mrad"
            told.append(Member(words, shown, value / unit[k], error / unit[k], beyond[k], candidate.key in names))
    return told, family.label(size)


def _beyond(at: Hypothesis, family: Indices, own: Indices, variance: Array) -> Array:
    """How many times the usual value of the rest of the family each value is: the rule of `diagnosis.naming`."""
    others = np.setdiff1d(family, own)
    usual = np.mean((at.means(others) ** 2 + at.variances(others)) / variance[others])
    return np.asarray(np.abs(at.means(own)) / np.sqrt(usual * variance[own]))


def family_figure(told: Sequence[Member]) -> Figure:
    """Each D-H value in units of what is usual in this arm, with the limit beyond which one may have a name."""
    with styled():
        figure, panel = plt.subplots(figsize=(6.4, 0.6 + 0.19 * len(told)))
        panel.axvspan(0, NAMING.beyond_family, color=GREY, alpha=0.12, lw=0)
        panel.axvline(NAMING.beyond_family, color=VERMILION, ls="--", label=f"{NAMING.beyond_family} times the usual")
        for y, each in enumerate(told):
            error = each.beyond / abs(each.value) * 1.96 * each.stderr if each.value else 0.0
            colour = BLUE if each.named else GREY
            panel.errorbar(each.beyond, y, xerr=[[min(error, each.beyond)], [error]], fmt="D" if each.named else "o",
                           color=colour, ms=5 if each.named else 4, capsize=2, elinewidth=1)  # fmt: skip
            if each.beyond > NAMING.beyond_family:
                text = f"{each.value:+.2f} {each.unit}"
                panel.annotate(text, (each.beyond, y), (0, 7), textcoords="offset points", ha="center", fontsize=8)
        panel.plot([], [], "D", color=BLUE, label="of a link that gets a name")
        panel.plot([], [], "o", color=GREY, label="stays in the family")
        panel.set_xlim(left=0)
        measure = "size of the D-H error, in usual values of its family (bars: 95 %)"
        _listed(panel, [each.words for each in told], 7, measure)
        panel.legend(loc="lower right", frameon=True)
    return figure


def worth(found: Selected) -> list[tuple[str, float]]:
    """By how much the error on held-out rows is larger without each cause, um; last the name that was left out."""
    search, best = Search.on(found.problem), found.best
    own = [each.candidate for each in best.chosen]
    kinds = {each: found.space.candidates[each].family for each in own}
    named = [each for each in own if kinds[each] not in WORDS]
    readings = [without_members(search, best, [each], []) for each in named]
    words = [_label(found, each) for each in named]
    for number, family in enumerate(FAMILIES):
        if best.background[number]:
            inside = [each for each in own if kinds[each] == family]
            readings.append(without_members(search, best, inside, [number]))
            words.append("\n".join([f"{family} family:", *(_label(found, n) for n in inside), "and small ones"]))
    gains = [float(gain) for gain in held_out_gains(found.problem, found.blocks, best, readings)]
    number, tried = _next(found)
    (gain,) = held_out_gains(found.problem, found.blocks, tried, [(found.found.chosen, found.found.background)])
    told = sorted(zip(words, gains, strict=True), key=lambda each: -each[1])
    told.append((f"{_label(found, number)}?", float(gain)))
    noise = best.noise
    return [(text, 1e3 * (float(np.sqrt(noise**2 * (1 + gain / found.problem.n))) - noise)) for text, gain in told]


def worth_figure(told: Sequence[tuple[str, float]]) -> Figure:
    """What each cause is worth on rows that took no part in fitting it."""
    with styled():
        figure, panel = plt.subplots(figsize=(6.4, 0.6 + 0.62 * len(told)))
        for y, (_, size) in enumerate(told):
            panel.barh(y, size, color=BLUE if size > 0 else VERMILION, height=0.55)
            text = f"{size:+.0f}" if abs(size) > 1 else f"{size:+.2f}"
            panel.text(max(size, 0) + 0.01 * told[0][1], y, text, va="center", fontsize=8)
        panel.set_axisbelow(True)
        panel.axvline(0, color="black", lw=0.8)
        panel.set_xlim(min(0.0, *(size for _, size in told)), 1.25 * told[0][1])
        _listed(panel, [text for text, _ in told], 8, "held-out error without it: growth (µm RMS per axis)")
    return figure


def main() -> None:
    """Draw the pictures, or fill the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rates", type=Path, help="figures.json of the bench: fill the tables instead")
    chosen = parser.parse_args()
    if chosen.rates is not None:
        bench.fill(chosen.rates)
        return
    found = diagnosed(world())
    values, share = members(found)
    tolerance = f"{1e3 * FORM.tolerance:g}"
    print(f"D-H values are {share:g} of their tolerance ({tolerance} mm, {tolerance} mrad) in this arm")
    for name, figure in (
        ("evidence", evidence_figure(steps(found))),
        ("family", family_figure(values)),
        ("held-out", worth_figure(worth(found))),
    ):
        save_figure(figure, FIGURES / f"why-{name}.png", ("png",))


if __name__ == "__main__":
    main()
