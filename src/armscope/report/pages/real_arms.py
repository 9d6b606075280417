"""docs/real-arms.md: what is wrong with each real arm and how well it is predicted where nobody fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from armscope.core.files import write_text
from armscope.core.words import table_lines
from armscope.physics.registry import EFFECTS
from armscope.real.constants import PROTOCOL
from armscope.real.curves import shared
from armscope.real.protocol import ARMSCOPE, ORIENTED, UNCORRECTED
from armscope.real.reference import Reference, ReferenceRun, load_reference
from armscope.real.transfer import GEOMETRY_HERE, WITH_CURVES
from armscope.report.html import significant
from armscope.report.text.compliances import compliance_lines
from armscope.report.text.regions import PLUS, region_lines, regions_won
from armscope.verdict.filenames import VERDICT
from armscope.verdict.files import read_verdict
from armscope.verdict.schema import Verdict

LEVELS = ("nominal", "offsets", "geometric", "compliance")
TOLD = 3
AGREED = 0.6  # Share of the splits in which a name must be given to be listed
INTRODUCTION = """\
What armscope says about public recordings of real arms, in the protocol of the figures that stand beside it:
configurations split at random (70 % to learn from), RMS of the 3D distance in mm on the rest, mean ± standard deviation
over the splits; in brackets what others reached. *nominal* fits base and tool only, *offsets* every joint's zero,
*geometric* every D-H value, *+ compliance* one spring per joint. *armscope* is the whole diagnosis, repeated from the
beginning on the rows of every split; it sees points alone, as the figures beside it did. *orientations too* is the same
where the tool's orientation was recorded and is learned from, too: again the distance of points, and what is left of
the angle between predicted and measured orientation. No row of a test part is seen by the diagnosis that is tested on
it. What that does not exclude: these recordings were in view while armscope was built, and one constant (a joint's
bearing is expected to give half as much as its drive, not a third) was settled on the iiwa's 2016-11-18. The recordings
are not part of this repository: `snakemake -j2 fetch_recordings`.

The sentence below each arm's name gives an effect's size at the tool (RMS per axis) and its share of the squared error
that base and tool leave: what goes when it is cured as found, averaged over the orders in which all can be cured.
Shares need not add up to 100 %: something may be left without a name, and what is not listed may have a share below
zero, because it hides part of what others do."""
PAPER = "The paper's models at 85 identification rows (chosen as in the paper, least squares; the rest tests them):"
JUMPS = [effect.name for effect in EFFECTS if effect.jumps]


@dataclass(frozen=True)
class RealArm:
    """One set: what it is called, where its results are, and what others reached on it.

    ``diagnosed``: the run, and its first id, that the verdict in the folder is about.
    """

    name: str
    title: str
    folder: Path
    reference: Path
    diagnosed: tuple[str | None, int | None] = (None, None)


def write_real_arms(path: Path, arms: Sequence[RealArm], figures: str, of: str) -> None:
    """Write the page.

    Args:
        path: where to.
        arms: in their order on the page.
        figures: folder of the figures as the page names it; real-<name>.svg in it.
        of: what the results are of: a commit.
    """
    parts = [_head(arms, figures, of), *(_section(arm, figures) for arm in arms)]
    write_text(path, "\n\n".join(parts) + "\n")


def _head(arms: Sequence[RealArm], figures: str, of: str) -> str:
    head = ("arm", "run", "armscope", "best figure of others", "armscope beside it", "orientations too")
    rows = []
    for arm in arms:
        table, reference = _read(arm)
        for run in reference.runs:
            ours = _row(table, run.name, ARMSCOPE)
            others = run.lowest
            verdict = "at or below" if ours["mean_mm"] <= others.mm else "**above**"
            best = f"{others.mm:g} ({others.what})"
            rows.append((arm.title, run.name, _spread(ours, run.splits), best, verdict, _oriented(table, run)))
    won = regions_won([arm.folder for arm in arms])
    return "\n".join(
        [
            "# Real arms",
            "",
            "<!-- written by `snakemake -j1 real_arms` from results; edits here are lost -->",
            "",
            INTRODUCTION,
            "",
            f"Measured at {of}. Known effects, concealed in these recordings: [real-concealed.md](real-concealed.md).",
            "",
            *table_lines(head, rows),
            "",
            *(won, "")[: 2 * bool(won)],
            f"![Every run from the nominal arm to armscope, beside the figures of others]({figures}/real-protocol.png)",
        ]
    )


def _section(arm: RealArm, figures: str) -> str:
    table, reference = _read(arm)
    run = next((each for each in reference.runs if (each.run, each.first_id) == arm.diagnosed), reference.runs[0])
    verdict = read_verdict(arm.folder / VERDICT)
    parts = [
        f"## {arm.title}",
        _what_is_wrong(verdict) + " " + _how_well(table, run),
        f"![{arm.title}: the arm coloured by share of the mismatch]({figures}/real-{arm.name}.svg)",
        _levels(table, reference.runs),
        _agreement(arm, reference.runs),
        region_lines(arm.folder),
        PAPER,
        _paper(table, reference.runs),
    ]
    parts += [compliance_lines(arm.folder, arm.title, f"{figures}/real-{arm.name}-compliances.png")]
    transfers = pd.read_csv(arm.folder / "transfer.csv")
    if len(transfers):
        parts += ["Learned on one run, applied to another, where only the frames named are fitted again:"]
        parts += [_transfers(transfers[~transfers["model"].isin([GEOMETRY_HERE, WITH_CURVES])])]
        parts += [_curves(arm, transfers, figures)]
    return "\n\n".join(part for part in parts if part)


def _read(arm: RealArm) -> tuple[pd.DataFrame, Reference]:
    return pd.read_csv(arm.folder / "protocol.csv"), load_reference(arm.reference)


def _row(table: pd.DataFrame, run: str, model: str) -> Any:
    found = table[(table["run"].astype(str) == run) & (table["model"] == model)]
    return found.iloc[0] if len(found) else None


def _oriented(table: pd.DataFrame, run: ReferenceRun) -> str:
    """The diagnosis that learned from orientations, too; a dash where none were recorded."""
    row = _row(table, run.name, ORIENTED)
    return _spread(row, run.splits) if row is not None else "–"


def _spread(row: Any, splits: int | None = None) -> str:
    """Mean and standard deviation; how many splits, where these are not ``splits``."""
    if row is None:
        return "–"
    if row["splits"] == 1:
        return f"{significant(row['mean_mm'])} (one split)"
    fewer = "" if splits in (None, row["splits"]) else f" ({row['splits']:.0f} splits)"
    return f"{significant(row['mean_mm'])} ± {significant(row['std_mm'], 2)}{fewer}"


def _what_is_wrong(verdict: Verdict) -> str:
    """The largest effects of the verdict and its small errors, in one sentence, in order of their shares."""
    main = [effect for effect in verdict.effects if not effect.minor]
    if not main:
        return verdict.headline
    sized = [(e.share, f"{e.title} ({e.rms_at_tool_mm:.2g} mm, {100 * e.share:.0f} %)") for e in main[:TOLD]]
    if verdict.background.present:
        share = verdict.background.share
        sized.append((share, f"small errors allowed for everywhere in the arm ({100 * share:.0f} %)"))
    told = [words for _, words in sorted(sized, key=lambda one: one[0], reverse=True)]
    if len(main) > TOLD:
        told.append(f"besides, {len(main) - TOLD} smaller effect{'s' if len(main) > TOLD + 1 else ''}")
    before = f"{verdict.residual_before_mm:.2g} mm per axis, base and tool fitted"
    return f"What the nominal arm misses ({before}) is, the largest share first: {'; '.join(told)}."


def _how_well(table: pd.DataFrame, run: ReferenceRun) -> str:
    before, after, turned = (_row(table, run.name, model) for model in ("nominal", ARMSCOPE, ORIENTED))
    become = f"{significant(before['mean_mm'])} mm become {significant(after['mean_mm'])} mm"
    count = "one split" if after["splits"] == 1 else f"{after['splits']:.0f} splits"
    too = "" if turned is None else f"; learned from points – from orientations, too, {_spread(turned)} mm"
    return f"On configurations that took no part, {become} (3D, {run.name}, {count}{too})."


def _levels(table: pd.DataFrame, runs: Sequence[ReferenceRun]) -> str:
    turned = ORIENTED in set(table["model"])
    head = ["run", *(PLUS.get(level, level) for level in LEVELS), "armscope"]
    head += ["orientations too", "angle left (mrad)"] if turned else []
    rows = []
    for run in runs:
        cells = []
        for level in LEVELS:
            row = _row(table, run.name, level)
            known = run.figure(level)
            cells.append(_spread(row) + (f" ({known[0]:g} ± {known[1]:g})" if known and row is not None else ""))
        cells.append(f"**{_spread(_row(table, run.name, ARMSCOPE), run.splits)}**")
        if turned:
            row = _row(table, run.name, ORIENTED)
            cells += [_oriented(table, run), "–" if row is None else significant(row["turn_mrad"])]
        rows.append((run.name, *cells, f"{run.lowest.mm:g}"))
    return "\n".join(table_lines([*head, "best of others"], rows))


def _agreement(arm: RealArm, runs: Sequence[ReferenceRun]) -> str:
    """Which names the splits agree on, and where set-ups changed."""
    names = pd.read_csv(arm.folder / "names.csv")
    splits = pd.read_csv(arm.folder / "splits.csv")
    sentences = []
    for run in runs:
        for model, learned in ((ARMSCOPE, ""), (ORIENTED, ", orientations too")):
            count = int(((splits["run"].astype(str) == run.name) & (splits["model"] == model)).sum())
            mine = names[(names["run"].astype(str) == run.name) & (names["model"] == model)]
            if count:
                sentences.append(f"- {run.name}{learned}: {_steady(mine, count)}")
    return "Named in most splits (how often):\n\n" + "\n".join(sentences)


def _steady(names: pd.DataFrame, count: int) -> str:
    """What most of so many splits name."""
    name = names["effect"].str.replace("_", " ") + " " + names["location"]
    steady = names[~names["effect"].isin(JUMPS)].groupby(name)["split"].nunique()
    steady = steady[steady >= AGREED * count].sort_values(ascending=False, kind="stable")
    told = [f"{name} ({times}/{count})" for name, times in steady.items()]
    jumps = names[names["effect"].isin(JUMPS) & names["row"].notna()]
    text = ", ".join(told) if told else "no name in most splits"
    return text + ("; set-up changes: " + ", ".join(_jumps(jumps, count)) if len(jumps) else "")


def _jumps(jumps: pd.DataFrame, count: int) -> list[str]:
    """Rows at which base or tool jumped, those of different splits within ten rows of each other together."""
    ordered = jumps.sort_values("row")
    cluster = (ordered["row"].diff() > 10).cumsum()
    found = []
    for _, group in ordered.groupby(cluster):
        times = group["split"].nunique()
        if times >= AGREED * count:
            low, high = group["row"].min(), group["row"].max()
            span = f"{low:.0f}" if low == high else f"{low:.0f}–{high:.0f}"
            what = " and ".join(sorted({name.partition("_")[0] for name in group["effect"]}))
            found.append(f"{what} at id {span} ({times}/{count})")
    return found or ["none in most splits"]


def _paper(table: pd.DataFrame, runs: Sequence[ReferenceRun]) -> str:
    models = [m for m in table["model"].unique() if m not in (*LEVELS, ARMSCOPE, ORIENTED)]
    names = {UNCORRECTED: "none (frames only)"}
    rows = []
    for run in runs:
        found = [_row(table, run.name, model) for model in models]
        rows.append((run.name, *("–" if row is None else significant(row["mean_mm"]) for row in found)))
    return "\n".join(table_lines(["run", *(names.get(model, model) for model in models)], rows))


def _transfers(table: pd.DataFrame) -> str:
    keys = ["learned", "applied", "refitted"]
    models = list(dict.fromkeys(table["model"]))
    rows = []
    for key, group in table.groupby(keys, sort=False):
        cells = []
        for model in models:
            row = group[group["model"] == model]
            if row.empty:
                cells.append("–")
                continue
            known = row["reference_mm"].iloc[0]
            cells.append(significant(row["rms_mm"].iloc[0]) + (f" ({known:g})" if np.isfinite(known) else ""))
        rows.append((*key, *cells))
    return "\n".join(table_lines(["learned on", "applied to", "refitted", *models], rows))


def _curves(arm: RealArm, transfers: pd.DataFrame, figures: str) -> str:
    """Whether curves of joints' own angles are the same on two runs, and what the other run's are worth."""
    lines = []
    for (learned, applied), group in transfers.groupby(["learned", "applied"], sort=False):
        values = group.set_index("model")["rms_mm"]
        if WITH_CURVES in values:
            without, with_them = significant(values[GEOMETRY_HERE]), significant(values[WITH_CURVES])
            lines.append(f"on {applied} with the curves of {learned} {without} mm become {with_them} mm")
    if not lines:
        return ""
    text = (
        "Curves of joints' own angles, learned on one run and used unchanged on another beside a geometry that is "
        f"fitted there (held out, {len(PROTOCOL.curve_splits)} splits): {'; '.join(lines)}. A curve is known only at "
        "the angles where it was learned; beyond, it keeps its end's value."
    )
    both = shared(pd.read_csv(arm.folder / "curves_by_run.csv"))
    if both:
        told = [f"{c.joint} {c.correlation:.2f} over {np.degrees(c.in_common):.0f}°" for c in both]
        text += f" Where both runs know it, the two curves of a joint correlate by: {', '.join(told)}."
        text += f"\n\n![{arm.title}: curves of joints as two runs show them]({figures}/real-{arm.name}-curves.png)"
    return text
