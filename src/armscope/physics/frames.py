"""The frames that are always free: where the instrument stands (per set-up), where and how the tool is (per target)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from armscope.physics.drift import six_terms
from armscope.physics.effect import AXES, Cure, Driver, Effect, Placed
from armscope.physics.placing import nowhere
from armscope.physics.set_ups import SetUps
from armscope.recordings import Recordings

BASE_FRAME = Effect(
    "base_frame",
    "frame",
    nowhere,
    "Where the arm's base stands in the measurement frame.",
    "It is fitted anew for every recording.",
    Cure("Nothing to cure."),
)
TOOL_FRAME = Effect(
    "tool_frame",
    "frame",
    nowhere,
    "Where the measured point sits in the arm's last frame.",
    "It is fitted anew for every target.",
    Cure("Nothing to cure."),
)


TOOL_TURN = Effect(
    "tool_turn",
    "frame",
    nowhere,
    "How the measured tool frame is turned against the arm's last frame.",
    "It is fitted anew for every target whose orientation was measured.",
    Cure("Nothing to cure."),
)


def free_frames(recordings: Recordings, tool_per_run: bool) -> list[Placed]:
    """A base twist per run, and per target (and run, where asked) a tool translation, and its turn where measured."""
    return [*bases_and_tools(recordings, tool_per_run), *tool_turns(recordings, tool_per_run)]


def bases_and_tools(recordings: Recordings, tool_per_run: bool) -> Iterator[Placed]:
    """A base twist per run, and a tool translation per target (and run, where asked)."""
    yield from _bases(recordings)
    yield from _tools(recordings, tool_per_run)


def _bases(recordings: Recordings) -> Iterator[Placed]:
    for run in np.unique(recordings.run):
        yield _base((str(run),))


def _base(runs: tuple[str, ...]) -> Placed:
    terms = six_terms("base", Driver("in run", runs))
    return Placed(BASE_FRAME, "base", terms, (1.0,) * 6, "run", variant=", ".join(runs))


def _tools(recordings: Recordings, per_run: bool) -> Iterator[Placed]:
    for key in tool_keys(recordings, per_run):
        terms = six_terms("tool", _with_tool(key), axes=AXES[:3])
        yield Placed(TOOL_FRAME, "tool", terms, (1.0,) * 3, "target", variant=key[0])


def sharing_bases(frames: Iterable[Placed], set_ups: SetUps) -> list[Placed]:
    """Free frames with one base for all runs of a set-up in place of one for each of them."""
    whole = {run: runs for runs in set_ups for run in runs}
    shared: dict[tuple[str, ...], Placed] = {}
    others: list[Placed] = []
    for placed in frames:
        if placed.effect is BASE_FRAME:
            runs = whole.get(placed.variant, (placed.variant,))
            shared.setdefault(runs, _base(runs))
        else:
            others.append(placed)
    return [*shared.values(), *others]


def set_ups_of(frames: Iterable[Placed]) -> SetUps:
    """The runs of every base among free frames."""
    return tuple(runs_of(placed.terms[0].products[0].driver) for placed in frames if placed.effect is BASE_FRAME)


def runs_of(driver: Driver) -> tuple[str, ...]:
    """The runs that an "in run" driver is of."""
    return tuple(str(run) for run in driver.arguments)


def tool_turns(recordings: Recordings, per_run: bool) -> Iterator[Placed]:
    """A turn of the tool per target (and run, where asked) whose orientation was measured."""
    oriented = recordings.rows(np.flatnonzero(recordings.oriented))
    for key in tool_keys(oriented, per_run):
        terms = six_terms("tool", _with_tool(key), axes=AXES[3:])
        yield Placed(TOOL_TURN, "tool", terms, (1.0,) * 3, "target", variant=key[0])


ToolKey = tuple[str, str | None]
"""(target, run) of a tool; run is None where it is the same in all runs."""


def _with_tool(key: ToolKey) -> Driver:
    target, run = key
    return Driver("on target", (target,)) if run is None else Driver("on target in run", (target, run))


def tool_key(driver: Driver) -> ToolKey:
    """The tool that a free frame's driver stands for."""
    target, *run = driver.arguments
    return str(target), str(run[0]) if run else None


def tool_keys(recordings: Recordings, per_run: bool) -> list[ToolKey]:
    """The tools of a table."""
    if not per_run:
        return [(str(target), None) for target in np.unique(recordings.target)]
    return sorted({(str(t), str(r)) for t, r in zip(recordings.target, recordings.run, strict=True)})
