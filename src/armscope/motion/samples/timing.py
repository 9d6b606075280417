"""Time stamps: told where they are uneven, mended where angle and velocity know better, laid on an even grid."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from armscope.core.averages import robust_scale
from armscope.core.inputs import InputError
from armscope.core.types import Array, Indices
from armscope.motion.samples.constants import READING, TIMING
from armscope.motion.samples.low_pass import mean_about, without_what_is_faster
from armscope.recordings.motions import Motions
from armscope.verdict.schema import Notice


@dataclass(frozen=True, eq=False)
class Stretch:
    """Evenly sampled samples of one run, without a gap; arrays as in `Motions`, ``effort`` in N m (N) or A.

    ``cut``: (N, m) where the effort was cut off at the most that its channel shows; None for nowhere. ``since``: s that
    the arm had run before the first sample, if it ran on from one run of the table to the next; None: not known.
    ``began``: s, when its run began, by the run's own stamps.
    """

    run: str
    rate: float
    time: Array
    q: Array
    effort: Array
    payload: Array | None
    temperature: Array | None
    link: Array | None = None
    cut: NDArray[np.bool_] | None = None
    since: float | None = None
    began: float = 0.0

    def __len__(self) -> int:
        return len(self.time)

    @property
    def running(self) -> Array | None:
        """(N,) s that the arm has run, where that is known."""
        return None if self.since is None else np.asarray(self.since + self.time - self.time[0])

    def cut_about(self, rows: Indices, reach: float) -> NDArray[np.bool_]:
        """(K, m) whether the effort was cut off within a time, s, of some samples (K,)."""
        if self.cut is None:
            return np.zeros((len(rows), self.q.shape[1]), dtype=np.bool_)
        before, samples = np.vstack([np.zeros_like(self.cut[:1], dtype=int), np.cumsum(self.cut, axis=0)]), len(self)
        by = int(np.ceil(reach * self.rate))
        return np.asarray(before[np.minimum(rows + by + 1, samples)] > before[np.maximum(rows - by, 0)])


def _steps(effort: Array) -> Array:
    """(m,) into how many of its smallest steps each channel's range parts."""
    steps = np.abs(np.diff(effort, axis=0))
    steps[steps < READING.rounding * np.ptp(effort, axis=0)] = 0.0
    least = np.min(np.where(steps > 0, steps, np.inf), axis=0, initial=np.inf)
    return np.asarray(np.ptp(effort, axis=0) / least)


def coarse_steps(effort: Array) -> Array:
    """(m,) smallest step of each channel (N, m), where its range holds few of them; 0 where it is fine or dead."""
    few = _steps(effort) < READING.fine
    return np.asarray(np.where(few, np.ptp(effort, axis=0) / np.maximum(_steps(effort), 1e-300), 0.0))


def mended(motions: Motions) -> tuple[Motions, list[Notice]]:
    """The table with repeated samples dropped and, where velocity and angle show it, time stamps rebuilt.

    Raises:
        InputError: time goes back within a run, or its unit can't be seconds.
    """
    rows, time, notices = mended_rows(motions)
    return motions.rows(rows).at_times(time), notices


def mended_rows(motions: Motions) -> tuple[Indices, Array, list[Notice]]:
    """Rows that `mended` keeps, run by run, their time, s, and what was done.

    Raises:
        InputError: as `mended`.
    """
    pieces, notices = [], []
    for run in motions.runs:
        rows = np.flatnonzero(motions.run == run)
        piece, told = _mended_run(motions, rows)
        pieces.append(piece)
        notices += told
    return np.concatenate([rows for rows, _ in pieces]), np.concatenate([time for _, time in pieces]), _once(notices)


def _once(notices: list[Notice]) -> list[Notice]:
    """What is said of many runs is said once, of the first."""
    kinds: dict[str, list[Notice]] = {}
    for notice in notices:
        kinds.setdefault(notice.kind, []).append(notice)
    return [
        alike[0] if len(alike) == 1 else Notice(kind, f"{len(alike)} runs, such as {alike[0].text}")
        for kind, alike in kinds.items()
    ]


def _mended_run(motions: Motions, rows: np.ndarray) -> tuple[tuple[np.ndarray, Array], list[Notice]]:
    time, label = motions.time[rows], f"run {motions.run[rows[0]]}" if motions.run[rows[0]] else "the table"
    steps = np.diff(time)
    if not len(steps):
        rule = "a run is a motion of many samples"
        cure = "Does the column run number the rows? Name one motion in all its rows, or leave the column out."
        raise InputError(motions.source, f"line {int(rows[0]) + 2}, column run", label, rule, cure)
    back = np.flatnonzero(steps < 0)
    if len(back):
        row = int(rows[back[0] + 1])
        rule = f"time does not go back within a run ({time[back[0]]:.6g} stands before)"
        cure = "Sort the rows by time, or give every motion its own name in the column run."
        before = rows[motions.time[rows] == time[back[0] + 1]][0]
        if before < row and np.array_equal(motions.q[before], motions.q[row]):
            cure = f"It is line {int(before) + 2} once more: are rows given twice? Delete those from line {row + 2} on."
        raise InputError(motions.source, f"line {row + 2}, column time_s", float(time[back[0] + 1]), rule, cure)
    usual = float(np.median(steps[steps > 0])) if np.any(steps > 0) else 0.0
    if usual <= 0 or 1 / usual < TIMING.slowest_hz:
        rule = f"a motion is sampled at least {TIMING.slowest_hz:g} times a second"
        cure = "Are these milliseconds? Divide them by 1000." if usual else "All stamps are the same."
        raise InputError(motions.source, f"{label}, column time_s", f"steps of {usual:g} s", rule, cure)
    rows, notices = _once_each(motions, rows, label)
    steps = np.diff(motions.time[rows])
    same = np.r_[False, (np.diff(motions.q[rows], axis=0) == 0).all(1) & _as_fast(motions, rows)]
    twice = same | np.r_[False, steps == 0]
    uneven = float(np.mean(np.abs(steps - usual) > TIMING.uneven * usual))
    kept = rows[~twice]
    mended_time = motions.time[kept]
    if motions.dq is not None and uneven > 0.01:
        period = round(usual, 3) if usual > 5e-4 else usual
        better = _rebuilt(motions, kept, period)
        if better is not None:
            moved = float(np.max(np.abs((better - better[0]) - (mended_time - mended_time[0]))))
            text = (
                f"{label}: time stamps are not those of the samples (steps of {1e3 * steps.min():.3g} to "
                f"{1e3 * steps.max():.3g} ms). Time was rebuilt from angle and velocity in whole steps of "
                f"{1e3 * period:g} ms; {int(twice.sum())} repeated rows were dropped, "
                f"stamps moved by up to {1e3 * moved:.2g} ms."
            )
            return (kept, better), [Notice("time rebuilt", text)]
    if uneven > 0.01:
        text = (
            f"{label}: {100 * uneven:.0f} % of the time steps are uneven ({1e3 * steps.min():.3g} to "
            f"{1e3 * steps.max():.3g} ms, usually {1e3 * usual:.3g} ms); samples were interpolated to an even grid."
        )
        notices.append(Notice("uneven time", text))
    if not 0.01 < float(np.mean(same)) < 0.2:  # few are chance, and standing arms repeat themselves
        kept = rows[np.r_[True, steps > 0]]
        return (kept, motions.time[kept]), notices
    notices.append(Notice("repeated rows", f"{label}: {int(twice.sum())} rows repeat the row before and were dropped."))
    return (kept, mended_time), notices


def _once_each(motions: Motions, rows: np.ndarray, label: str) -> tuple[np.ndarray, list[Notice]]:
    """Rows of a run without those that are the row before once more, time stamp included; and what is said of it."""
    table = np.column_stack([motions.time[rows], motions.q[rows], motions.effort[rows]])
    again = np.r_[False, (table[1:] == table[:-1]).all(axis=1)]
    if not again.any():
        return rows, []
    text = f"{label}: {int(again.sum())} rows are given twice, time stamp included; each was taken once."
    return rows[~again], [Notice("rows given twice", text)]


def _as_fast(motions: Motions, rows: np.ndarray) -> np.ndarray:
    """(N - 1,) whether a sample that stands where the one before stood is a repetition: what moves can't do that."""
    if motions.dq is None:
        return np.asarray((np.diff(motions.effort[rows], axis=0) == 0).all(1))
    steps = np.abs(np.diff(motions.q[rows], axis=0))
    finest = float(steps[steps > 0].min()) if np.any(steps > 0) else 0.0
    usual = float(np.median(np.diff(motions.time[rows])))
    travel = np.abs(motions.dq[rows][1:]).max(axis=1) * usual
    return np.asarray(travel > TIMING.resolved * finest)


def _rebuilt(motions: Motions, rows: np.ndarray, period: float) -> Array | None:
    """Time from dq = speed x step, in whole periods; None where the stamps agree with the motion as well."""
    assert motions.dq is not None
    travelled = np.diff(motions.q[rows], axis=0)
    speed = (motions.dq[rows][1:] + motions.dq[rows][:-1]) / 2
    if not np.isfinite(speed).all():
        return None
    stamped = np.diff(motions.time[rows])
    power = np.sum(speed**2, axis=1)
    step = np.sum(travelled * speed, axis=1) / np.maximum(power, 1e-12)
    rounding = robust_scale(travelled - speed * step[:, None])
    moving = np.sqrt(power) * period * TIMING.told_apart > rounding
    steps = np.clip(np.round(step / period), 1, np.maximum(np.round(stamped / period) + TIMING.gap, 1))
    whole = np.where(moving, steps * period, stamped)
    # by the spread about each: travel that rounding of the recorded angle explains counts for neither
    stamped_misfit = np.sum((travelled - speed * stamped[:, None])[moving] ** 2)
    whole_misfit = np.sum((travelled - speed * whole[:, None])[moving] ** 2)
    if whole_misfit > TIMING.rebuilt * stamped_misfit:
        return None
    return np.asarray(motions.time[rows[0]] + np.r_[0.0, np.cumsum(whole)])


def stretches(motions: Motions) -> Iterator[Stretch]:
    """The runs on even grids, parted where samples are missing; all at one rate, that of the middle one of them."""
    period, pieces = parted(motions)
    began, before, so_far = {}, {}, 0.0
    for run in motions.runs:
        time = motions.time[motions.run == run]
        began[run], before[run] = float(time[0]), so_far
        so_far += float(np.ptp(time))
    for run, rows in pieces:
        if len(rows) > 1:
            since = before[run] + float(motions.time[rows[0]]) - began[run]
            yield replace(_even(motions, rows, run, period), since=since, began=began[run])


def parted(motions: Motions) -> tuple[float, list[tuple[str, Indices]]]:
    """The common period, s, and run and rows of every piece that no gap in time parts."""
    usual = {}
    for run in motions.runs:
        usual[run] = float(np.median(np.diff(motions.time[motions.run == run])))
    period = float(np.percentile(list(usual.values()), 50, method="higher"))
    period = round(period, 4) if period > 5e-4 else period
    pieces = []
    for run in motions.runs:
        rows = np.flatnonzero(motions.run == run)
        gaps = np.flatnonzero(np.diff(motions.time[rows]) > max(TIMING.gap * max(usual[run], period), TIMING.gap_s))
        pieces += [(run, part) for part in np.split(rows, gaps + 1)]
    return period, pieces


def gaps(motions: Motions) -> list[Notice]:
    """Where samples are missing in a run, for how long, and what is left; of mended time."""
    told, pieces = [], parted(motions)[1]
    for run in motions.runs:
        own = [motions.time[rows] for of, rows in pieces if of == run]
        missing = [(one[-1], other[0] - one[-1]) for one, other in pairwise(own)]
        if missing:
            label = f"run {run}" if run else "the table"
            places = ", ".join(f"{length:.3g} s from {since:.6g} s on" for since, length in missing[: TIMING.named])
            more = f", and {len(missing) - TIMING.named} more" if len(missing) > TIMING.named else ""
            left = sum(float(np.ptp(each)) for each in own)
            text = (
                f"{label}: samples are missing for {places}{more}. {left:.4g} s of motion are left; each piece is "
                "taken by itself."
            )
            told.append(Notice("gap in time", text))
    return _once(told)


def _even(motions: Motions, rows: np.ndarray, run: str, period: float) -> Stretch:
    time = motions.time[rows]
    grid = time[0] + period * np.arange(int(np.floor((time[-1] - time[0]) / period + 1e-6)) + 1)

    own = float(np.median(np.diff(time)))

    def laid(values: Array | None) -> Array | None:
        if values is None:
            return None
        columns = values[rows].reshape(len(rows), -1)
        if own * TIMING.slower < period:
            columns = without_what_is_faster(columns, time, own, period)
        return np.column_stack([np.interp(grid, time, column) for column in columns.T])

    q, effort = laid(motions.q), laid(motions.effort)
    if own * TIMING.slower < period:
        effort = mean_about(grid, period, time, motions.effort[rows])
    if own > TIMING.slower * period and len(rows) > 3:
        from scipy.interpolate import make_interp_spline  # takes long to import: a table that is refused needs none

        # straight lines between samples that are far apart have corners: acceleration that the arm never had
        q = np.asarray(make_interp_spline(time, motions.q[rows], k=3)(grid))
    assert q is not None
    beside = laid(None if motions.link is None else motions.link - motions.q)
    assert effort is not None
    payload = (
        None
        if motions.payload is None
        else np.nan_to_num(motions.payload)[rows][np.searchsorted(time, grid).clip(0, len(rows) - 1)]
    )
    return Stretch(
        run, 1 / period, grid, q, effort, payload, laid(motions.temperature), None if beside is None else q + beside
    )
