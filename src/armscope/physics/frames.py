"""The two frames that are always free: where the instrument stands (per run), where the tool point is (per target)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from armscope.physics.drift import six_terms
from armscope.physics.effect import AXES, Driver, Effect, Placed
from armscope.recordings import Recordings

BASE_FRAME = Effect(
    "base_frame",
    "frame",
    lambda arm, recordings: iter(()),
    "Where the arm's base stands in the measurement frame.",
    "It is fitted anew for every recording.",
    "Nothing to cure.",
)
TOOL_FRAME = Effect(
    "tool_frame",
    "frame",
    lambda arm, recordings: iter(()),
    "Where the measured point sits in the arm's last frame.",
    "It is fitted anew for every target.",
    "Nothing to cure.",
)


def free_frames(recordings: Recordings, tool_per_run: bool) -> list[Placed]:
    """A base twist per run, and a tool translation per target (and run, where asked)."""
    return [*_bases(recordings), *_tools(recordings, tool_per_run)]


def _bases(recordings: Recordings) -> Iterator[Placed]:
    for run in np.unique(recordings.run):
        yield Placed(
            BASE_FRAME, "base", six_terms("base", Driver("in run", (str(run),))), (1.0,) * 6, "run", variant=str(run)
        )


def _tools(recordings: Recordings, per_run: bool) -> Iterator[Placed]:
    axes = AXES[:3]
    for target, run in tool_keys(recordings, per_run):
        driver = Driver("on target", (target,)) if run is None else Driver("on target in run", (target, run))
        yield Placed(TOOL_FRAME, "tool", six_terms("tool", driver, axes=axes), (1.0,) * 3, "target", variant=target)


def tool_keys(recordings: Recordings, per_run: bool) -> list[tuple[str, str | None]]:
    """(target, run) of every tool offset; run is None where a tool is the same in all runs."""
    if not per_run:
        return [(str(target), None) for target in np.unique(recordings.target)]
    return sorted({(str(t), str(r)) for t, r in zip(recordings.target, recordings.run, strict=True)})
