"""Drift: a base that moves with time, or a base or tool that jumps."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from armscope.core.words import rounded
from armscope.physics.clause import Told
from armscope.physics.effect import AXES, Cure, Direction, Driver, Effect, Placed, Product, Term, term
from armscope.physics.form_constants import FORM
from armscope.physics.placing import nowhere, varies
from armscope.physics.set_ups import SetUps, in_order_of_time
from armscope.recordings import Recordings
from armscope.robot import Arm

OF_RUNS = {"run ": " in ", "in run ": " ", "between runs ": " ", "from run ": " "}
"""How it begins to be told in which runs something is otherwise, and what comes before."""


def six_terms(location: str, driver: Driver, per: str = "", axes: tuple[str, ...] = AXES) -> tuple[Term, ...]:
    """One term per direction of a frame, named x, y, z, rx, ry, rz, mm and rad.

    Args:
        location: a frame of the chain.
        driver: what each term follows.
        per: what stands below the fraction of the unit, such as "/h".
        axes: which directions.

    Returns:
        One term per direction.
    """
    return tuple(
        term(
            axis.removeprefix("t"),
            ("mm" if axis[0] == "t" else "rad") + per,
            (Direction(location, axis), driver),
            si=1e-3 if axis[0] == "t" else 1.0,
        )
        for axis in axes
    )


def _place_drift(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    if recordings.time is not None and varies(recordings.time, FORM.least_span_s):
        start = float(recordings.time[recordings.time == recordings.time].min())
        yield Placed(BASE_DRIFT, "base", six_terms("base", Driver("hours", (start,)), "/h"), (1.0,) * 6, "time")
    elif len(recordings) >= FORM.fewest_ordered_rows:
        # assumed: rows stand in the order in which they were measured
        terms = six_terms("base", Driver("rows"), "/1000 rows")
        yield Placed(BASE_DRIFT, "base", terms, (1.0,) * 6, "order of rows", variant="rows")


@dataclass(frozen=True)
class Pause:
    """Time that passed before a row, in which nothing was measured, as rows that would have filled it."""

    row: float  # the first row afterwards, as `Recordings.number` counts
    run: str  # its run
    rows: float  # how many rows would have filled it
    later: tuple[str, ...] = ()  # runs on the same base that come after it


def drift_with_pauses(pauses: Sequence[Pause], multiplicity: int) -> Placed:
    """A base that moves steadily in time, of which only the order of rows is known, and where it paused."""
    terms = tuple(
        replace(
            each,
            products=(
                *each.products,
                *(
                    Product(each.products[0].direction, Driver("after pause", (p.row, p.run, *p.later)), p.rows / 1e3)
                    for p in pauses
                ),
            ),
        )
        for each in six_terms("base", Driver("rows"), "/1000 rows")
    )
    rows = ", ".join(f"{p.row:g}" for p in pauses)
    told = f"order of rows, with a pause before row{'s' if len(pauses) > 1 else ''} {rows}"
    variant = " ".join(["rows", *(f"{p.row:g}/{p.run}+{p.rows:.1f}" for p in pauses)])
    return Placed(BASE_DRIFT, "base", terms, (1.0,) * 6, told, multiplicity=multiplicity, variant=variant)


def pauses_of(placed: Placed) -> list[Pause]:
    """The pauses of a drift that follows the order of rows."""
    steps = [product for product in placed.terms[0].products if product.driver.kind == "after pause"]
    return [
        Pause(p.driver.number(0), str(p.driver.arguments[1]), p.factor * 1e3, tuple(map(str, p.driver.arguments[2:])))
        for p in steps
    ]


def _length(told: Told) -> str:
    return rounded(math.hypot(told.numbers["x"].value, *(told.numbers[a].value for a in "yz" if a in told.numbers)))


def _drifts(told: Told) -> str:
    in_rows = any("rows" in number.unit for number in told.numbers.values())
    _, comma, paused = told.driver.partition(", ")
    return f"the base drifts by {_length(told)} mm per {'1000 rows' if in_rows else 'hour'}{comma}{paused}"


def when(told: Told) -> str:
    """When a jump happened, to be put behind what jumped."""
    at = f" at {told.numbers['time'].value:.0f} s" if "time" in told.numbers else ""
    at = f" at row {told.numbers['row'].value:.0f}" if "row" in told.numbers else at
    return next((f"{before}{told.driver}" for start, before in OF_RUNS.items() if told.driver.startswith(start)), at)


def _jumped(told: Told) -> str:
    return f"the {told.location} jumped by {_length(told)} mm{when(told)}"


def _base_jumped(told: Told) -> str:
    """Points of two runs do not tell a base that moved from an instrument that was set up again."""
    of_runs = told.driver.startswith(tuple(OF_RUNS))
    return _jumped(told) + (", or the instrument was set up again" if of_runs else "")


BASE_DRIFT = Effect(
    "base_drift",
    "drift",
    _place_drift,
    "The base (or the instrument) moves steadily during the recording.",
    "Measure fixed reference points on the base at the start and the end.",
    Cure(
        "Let the set-up settle and warm up; measure references in between and correct. Until then the base frame is, "
        "at each time, stated frame + drift x time: let the corrected model's inverse kinematics compute the commands.",
        change="set-up",
        instruction="Fix base and instrument, and measure again.",
    ),
    clauses=(_drifts, "the base drifts"),
    atlas="time",
    needs=("time_s, or rows in order",),
    contained_in=("time",),
)


def _place_tool_of_run(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    """A tool that stands elsewhere in a whole run, or from one on, where others measured the same target."""
    runs = in_order_of_time(recordings)
    targets = {run: set(recordings.target[recordings.run == run].tolist()) for run in runs}
    for number, run in enumerate(runs):
        others = set().union(*(seen for other, seen in targets.items() if other != run))
        if number and targets[run] & others:
            yield _in_runs(TOOL_SHIFT, "tool", _axes_of_tool(recordings), (run,), f"run {run}")
            if run != runs[-1]:
                later = tuple(runs[number:])
                yield _in_runs(TOOL_SHIFT, "tool", _axes_of_tool(recordings), later, f"from run {run} on")


def base_shifts_of_runs(set_ups: SetUps) -> Iterator[Placed]:
    """A base that stands elsewhere in one run of a set-up alone, or from one of its runs on."""
    for runs in set_ups:
        for number, run in enumerate(runs[1:], 1):
            yield _in_runs(BASE_SHIFT, "base", AXES, runs[number:], f"between runs {runs[number - 1]} and {run}")
            if run != runs[-1]:
                yield _in_runs(BASE_SHIFT, "base", AXES, (run,), f"in run {run} alone")


def _in_runs(effect: Effect, location: str, axes: tuple[str, ...], runs: tuple[str, ...], when: str) -> Placed:
    terms = six_terms(location, Driver("during run", runs), axes=axes)
    return Placed(effect, location, terms, (1.0,) * len(terms), when, variant=when)


def _axes_of_tool(recordings: Recordings) -> tuple[str, ...]:
    """How a tool that moved on the flange is seen to have moved: its point, and its turn where that was measured."""
    return AXES if recordings.oriented.any() else AXES[:3]


def shift(effect: Effect, recordings: Recordings, row: int, multiplicity: int, later: tuple[str, ...] = ()) -> Placed:
    """Base or tool jumps before a row (0-based) and stays so until the end of the row's run, and in later runs.

    Args:
        effect: `BASE_SHIFT` or `TOOL_SHIFT`.
        recordings: the table.
        row: the first after the jump.
        multiplicity: how many moments compete.
        later: runs that share the base, or the tool, and come after the row's run.

    Returns:
        The effect in place.
    """
    location, axes = ("base", AXES) if effect is BASE_SHIFT else ("tool", _axes_of_tool(recordings))
    start = moment(recordings, row, later)
    terms = six_terms(location, start.driver, axes=axes)
    return from_then_on(Placed(effect, location, terms, (1.0,) * len(axes), "", multiplicity=multiplicity), start)


@dataclass(frozen=True)
class Moment:
    """From when on something is otherwise."""

    driver: Driver  # one from then on, until its run's end and in later runs, zero before
    scanned: tuple[str, str, float]  # its name, unit and value, as the verdict tells it
    run: str  # in which it lies
    words: str  # by what it is told, time or rows, and in which run where there are several


def moment(recordings: Recordings, row: int, later: tuple[str, ...]) -> Moment:
    """The moment before a row (0-based) of a table, by its time where that is recorded.

    Args:
        recordings: the table.
        row: the first afterwards.
        later: runs that come after the row's run and are as it is after the moment.

    Returns:
        The moment.
    """
    run = str(recordings.run[row])
    several = f", run {run}" if len(np.unique(recordings.run)) > 1 else ""
    if recordings.time is not None:
        time = float(recordings.time[row])
        return Moment(Driver("after time", (time, run, *later)), ("time", "s", time), run, "time" + several)
    number = float(recordings.number[row])
    return Moment(Driver("after row", (number, run, *later)), ("row", "", number), run, "order of rows" + several)


def from_then_on(placed: Placed, start: Moment) -> Placed:
    """What jumps in place, with its moment told."""
    variant = f"{start.run} {start.scanned[2]:g}"
    return replace(placed, driver=start.words, scanned=(start.scanned,), variant=variant)


BASE_SHIFT = Effect(
    "base_shift",
    "drift",
    nowhere,  # its time is scanned by the diagnosis
    "The base or the instrument jumped during the recording.",
    "Look into the log for what happened at that time; measure reference points on the base.",
    Cure(
        "Fasten the base and the instrument and register again;",
        otherwise="or move the base frame by the jump for all that comes after it (base = stated base + jump) and "
        "let the corrected model's inverse kinematics compute the commands.",
        change="set-up",
        instruction="Fasten base and instrument, and register the base again from the jump on{jump}.",
    ),
    clauses=(_base_jumped, "the {location} jumped"),
    jumps=True,
    several=True,
)

TOOL_SHIFT = Effect(
    "tool_shift",
    "drift",
    _place_tool_of_run,  # within a run its time is scanned by the diagnosis
    "The tool or its reflector moved on the flange during the recording or between runs.",
    "Look into the log for what happened at that time; measure the tool point again.",
    Cure(
        "Fasten the tool and calibrate the tool point again;",
        otherwise="or move the tool point by the jump for all that comes after it (tool = stated tool + jump) and "
        "let the corrected model's inverse kinematics compute the commands.",
        change="fastening",
        instruction="Fasten the tool, and measure its tool point again from the jump on{jump}.",
    ),
    clauses=(_jumped, "the {location} jumped"),
    jumps=True,
    several=True,
)

base_shift, tool_shift = partial(shift, BASE_SHIFT), partial(shift, TOOL_SHIFT)
EFFECTS = [BASE_DRIFT, BASE_SHIFT, TOOL_SHIFT]
