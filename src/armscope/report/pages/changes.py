"""changes.html: what changed between recordings of one arm, or which of several is unlike the others, on one page."""

from __future__ import annotations

import importlib.metadata
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from armscope.comparison import Change, Comparison, Valued
from armscope.comparison.bad_shots import told_of_shots
from armscope.comparison.constants import COMPARING, SHARED
from armscope.comparison.noisier import Noisier
from armscope.comparison.remedies import Remedy, difference_of, remedy_of
from armscope.comparison.result import moments_in_words, moments_of
from armscope.comparison.valued import wave_part
from armscope.core.files import write_json, write_table
from armscope.core.words import enumerated, shown_unit
from armscope.report.figures.history import drawn_numbers, history_figure, history_table, told_numbers
from armscope.report.html import write_page
from armscope.report.style import save_figure
from armscope.verdict.wording import capitalised, decimals_for, millimetres, places_in_words, read_parameter

PAGE, DATA, TABLE, FIGURE = "changes.html", "comparison.json", "history.csv", "history.png"
IN_WORDS = {
    "stderr": "its standard error",
    "since_first": "difference from the first",
    "since_first_stderr": "the difference's standard error",
}
"""What columns of the history are called on the page; history.csv keeps their names."""
FILES = (PAGE, DATA, TABLE, FIGURE, "history.svg")
LEFT_OPEN = "left open by these poses, unlike the difference"
UNKNOWN = "left open by these poses"
SMALLEST = 1e-6  # Smaller probabilities are not told apart: no test's assumptions hold so far out
MOST_LISTED = 4  # Of more recordings the first and the last are named
MOST_SHOTS = 20  # Bad shots that the page names
RARE = 0.01  # Below it a probability is told as one in so many


@dataclass(frozen=True)
class ChangedNumber:
    """A number of a change: what it is, before and after, and its difference with the 95 % interval."""

    label: str
    before: str
    after: str
    difference: str
    also: str
    interval: str


@dataclass(frozen=True)
class ChangeCard:
    """What a change's card shows."""

    title: str
    became: str
    where: str
    others: str
    means: bool
    size: str
    rows: tuple[ChangedNumber, ...]
    moments: tuple[ChangedNumber, ...]
    moments_are: str
    remedy: Remedy
    alternatives: tuple[str, ...]


def write_changes(found: Comparison, folder: Path) -> Path:
    """Write changes.html, comparison.json, history.csv and, where something changed, history.png and .svg."""
    history = history_table(found)
    write_json(folder / DATA, found.to_json())
    write_table(folder / TABLE, history)
    numbers = len(told_numbers(found))
    if numbers:
        save_figure(history_figure(found), folder / FIGURE, formats=("png", "svg"))
    tag, answer = _answer(found)
    first = f"{found.told}." if found.changes else found.headline.replace("p = ", "p\u00a0=\u00a0")
    write_page(
        folder / PAGE,
        "changes.html.j2",
        version=importlib.metadata.version("armscope"),
        found=found,
        headline=first,
        recorded=first_to_last(found.names),
        rest=found.told_beside if found.changes else found.would_be_seen,
        tag=tag,
        answer=answer,
        tiles=_tiles(found),
        cards=[_card(found, change) for change in found.changes],
        figure=folder / "history.svg" if numbers else None,
        left_out=numbers - len(drawn_numbers(found)),
        history=history.rename(columns=IN_WORDS),
        recordings=recordings_table(found),
        points=measured_points_table(found),
        shots=capitalised(f"{shots}.") if (shots := told_of_shots(found.bad_shots, MOST_SHOTS)) else "",
        seen=seen_table(found),
        power=COMPARING.power,
        prior_mm=SHARED.prior_mm,
        files=FILES[1:] if numbers else (DATA, TABLE),
    )
    return folder / PAGE


def _answer(found: Comparison) -> tuple[str, str]:
    """Colour and words of the answer."""
    if not found.tried:
        return "depends", "cannot be told"
    if found.changes:
        return "fails", "unlike the others" if found.of_arms else "changed"
    if found.p_nothing_changed <= found.level:
        return "depends", "no cause found"
    if found.noisier:
        return "depends", "more is left"
    if found.told_of_points:
        return "depends", "the measured point moved"
    return "holds", "no difference seen" if found.of_arms else "no change seen"


def _tiles(found: Comparison) -> list[tuple[str, str, str]]:
    """(number, what it is, details) for the strip under the headline."""
    changes = len(found.changes)
    tiles = [(str(sum(found.rows)), "rows that were used", f"in {len(found.names)} recordings")]
    tiles.append((millimetres(found.noise_mm), "left unexplained", "standard deviation per axis, all recordings"))
    if not found.tried:
        return tiles
    what = "difference" if found.of_arms else "change"
    tried, counted = f"surest of {found.tried} possible {what}s, all counted", f"{what}{'s' * (changes != 1)}"
    if not changes:
        least = f"named is what chance gives in less than {100 * found.level:g} % of comparisons"
        chance = f"of comparisons in which nothing {'differs' if found.of_arms else 'changed'} look like this one"
        none = (f"none of {found.tried}", f"possible {what}s stands out", least)
        surest = (in_odds(found.p_nothing_changed), chance, "by the surest of them, all counted")
        return [none, _more_is_left(found.noisier[0]) if found.noisier else surest, *tiles]
    named = (str(changes), counted, f"named where p is below {found.level:g}")
    return [named, (in_odds(found.p_nothing_changed), "is how often chance alone gives this", tried), *tiles]


def _more_is_left(noisier: Noisier) -> tuple[str, str, str]:
    """In the place of how likely it is that nothing changed, where no cause did and still one recording is unlike."""
    times = f"{noisier.left_mm / noisier.usual_mm:.2g} times"
    return times, f'as much is left of "{noisier.name}" as of "{noisier.than}"', "by the median row, each fitted alone"


def recordings_table(found: Comparison) -> pd.DataFrame:
    """What was compared with what, and what is left of each recording (RMS per axis, mm)."""
    rows = []
    for number, name in enumerate(found.names):
        family = next((each for each in found.same_poses if name in each), found.names)
        row = {"recording": name, "rows": found.rows[number]}
        others = [each for each in family if each != name]
        every = len(others) == len(found.names) - 1 > 1
        row["compared with"] = "all others" if every else first_to_last(others) or "none: other poses or payload"
        if found.left:
            left = found.left[number]
            row["base and tool placed (mm)"] = left.frames_mm
            row["and what all share (mm)"] = left.shared_mm
            if found.changes:
                row[f"and the {'differences' if found.of_arms else 'changes'} (mm)"] = left.changes_mm
        rows.append(row)
    return pd.DataFrame(rows)


def measured_points_table(found: Comparison) -> pd.DataFrame:
    """Where the measured point of each recording sits in the last frame, as `tool_mm` states it, mm."""
    rows = []
    for each in found.points:
        named = {"target": each.target} if any(other.target for other in found.points) else {}
        place = {f"{axis} (mm)": value for axis, value in zip("xyz", each.point_mm, strict=True)}
        moved = f"{millimetres(each.moved_mm)} than in {each.than}" if each.than else ""
        rows.append({"recording": each.recording, **named, **place, "elsewhere by": moved})
    return pd.DataFrame(rows)


def seen_table(found: Comparison) -> pd.DataFrame:
    """How far the zero of each joint must move to be seen."""
    sizes = [(each.location, each.least_rad) for each in found.seen]
    rows = [(joint, 1e3 * size, math.degrees(size)) for joint, size in sizes if math.isfinite(size)]
    rows += [(joint, math.nan, math.nan) for joint, size in sizes if not math.isfinite(size)]
    return pd.DataFrame(rows, columns=["zero of", "mrad", "°"])


def first_to_last(names: Sequence[str]) -> str:
    """Recordings by name; of many, the first and the last."""
    return enumerated(names) if len(names) <= MOST_LISTED else f"{names[0]} … {names[-1]} ({len(names)} recordings)"


def in_odds(p: float) -> str:
    """A probability as one reads it: "47 %", "1 in 19 000"."""
    if p < SMALLEST:
        return "less than 1 in a million"
    return f"{100 * p:.0f} %" if p >= RARE else f"1 in {float(f'{1 / p:.2g}'):,.0f}".replace(",", "\u00a0")


def _alike(titles: Sequence[str]) -> list[str]:
    """Causes of one kind together: "link geometry at links 2 and 3"."""
    kinds: dict[str, list[str]] = {}
    for title in titles:
        kind, _, place = title.partition(" at ")
        kinds.setdefault(kind, []).append(place)
    told = {kind: places_in_words(places) for kind, places in kinds.items()}
    # "instrument scale at instrument" says its place twice
    return [kind if place in kind else f"{kind} at {place}" for kind, place in told.items()]


def _card(found: Comparison, change: Change) -> ChangeCard:
    moments = moments_of(change)
    return ChangeCard(
        title=capitalised(change.title_with_doubt),
        became=found.became(change),
        where=enumerated(change.where),
        others=first_to_last(change.against),
        means=len(found.names) > 2,
        size=millimetres(change.rms_mm),
        rows=tuple(_row(found, change, number) for number in change.parameters if number not in moments),
        moments=tuple(_row(found, change, number) for number in moments),
        moments_are=moments_in_words(change.location, len(moments)),
        remedy=remedy_of(found, change),
        alternatives=tuple(_alike(change.alternatives)),
    )


def _row(found: Comparison, change: Change, number: Valued) -> ChangedNumber:
    """A number before and after: the mean over the recordings without and with the change."""
    difference = difference_of(number)
    reading = read_parameter(difference, change.effect)
    label = wave_part(number.name) or reading.label
    if number.unknown:
        return ChangedNumber(label, UNKNOWN, UNKNOWN, "–", "", "–")
    before = float(np.mean(np.array(number.values)[np.isin(found.names, change.against)]))
    after = before + number.difference
    factor, unit = shown_unit(number.unit, max(abs(before), abs(after), abs(number.difference)))
    digits = decimals_for(factor * difference.stderr)

    def told(value: float) -> str:
        shown = f"{round(factor * value, digits) + 0.0:.{digits}f} {unit}".replace("-", "−")
        return LEFT_OPEN if number.left_open else shown

    plus = "+" if number.difference > 0 else ""
    also = f"{plus}{reading.also}" if reading.also.endswith("°") else ""  # a change of stiffness is no 1 / compliance
    return ChangedNumber(label, told(before), told(after), f"{plus}{reading.value}", also, reading.interval)
