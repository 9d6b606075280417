"""Set-ups: runs that stand on one base."""

from __future__ import annotations

import itertools

import numpy as np

from armscope.recordings import Recordings

SetUps = tuple[tuple[str, ...], ...]
"""Runs that share a base, set-up by set-up, in order of time."""


def runs_around(set_ups: SetUps, run: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The runs of a run's set-up that come before and after it."""
    whole = next((runs for runs in set_ups if run in runs), (run,))
    at = whole.index(run)
    return whole[:at], whole[at + 1 :]


def in_order_of_time(recordings: Recordings) -> list[str]:
    """The runs, the earliest first; as they stand in the table where times are not recorded or start anew."""
    runs, first = np.unique(recordings.run, return_index=True)
    in_table = [int(number) for number in np.argsort(first)]
    time = recordings.time
    if time is not None and np.isfinite(time).all():
        spans = [(float(time[recordings.run == run].min()), float(time[recordings.run == run].max())) for run in runs]
        by_time = sorted(in_table, key=lambda number: spans[number])
        if all(spans[a][1] <= spans[b][0] for a, b in itertools.pairwise(by_time)):
            in_table = by_time
    return [str(runs[number]) for number in in_table]
