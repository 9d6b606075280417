"""From samples to rows: low-pass without lag, derivatives, the same low-pass for torque and model, every n-th row kept.

Positions are low-passed where their own noise begins, so that noise of the acceleration does not make inertias look
small, and derived by a spline of the fifth degree: central differences lose half a percent of an acceleration at a
fiftieth of the sampling rate. Every column of the model is formed at full rate and goes through the filter that the
torque goes through.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from armscope.core.types import Array, Indices
from armscope.motion.samples.constants import CUTOFF, FILTER, READING
from armscope.motion.samples.ends import turned_about
from armscope.motion.samples.link_band import link_bands
from armscope.motion.samples.low_pass import low_pass_sections, without_lag
from armscope.motion.samples.timing import Stretch


@dataclass(frozen=True)
class Preparation:
    """How samples become rows."""

    rate: float  # samples per second; cutoff: of torque and model, Hz
    cutoff: float
    position_cutoff: float  # of the positions before they are derived, Hz, of a run that is in none of ``of_runs``
    every: int  # every how many samples a row is kept; cutoff_source: why this cut-off
    cutoff_source: str
    of_runs: tuple[tuple[str, float], ...] = ()  # (run, Hz) of runs whose positions show less of a motion

    @property
    def stride(self) -> int:
        """The model is formed at every so many samples: the motion, low-passed, holds nothing faster."""
        most = max(int(self.rate / (FILTER.formed_per_cutoff * self.position_cutoff)), 1)
        return max(step for step in range(1, min(most, self.every) + 1) if self.every % step == 0)

    @property
    def edge(self) -> int:
        """Samples left out at both ends of a stretch."""
        return int(np.ceil(FILTER.edge_s * self.rate))

    def rows_of(self, samples: int) -> int:
        """How many rows a stretch of samples gives."""
        return len(range(self.edge, samples - self.edge, self.every))

    def position_cutoff_of(self, run: str) -> float:
        """Hz, of a run's positions."""
        return dict(self.of_runs).get(run, self.position_cutoff)

    def low_passed(self, values: Array, kept: Indices, stride: int = 1) -> Array:
        """The rows that are kept of samples (N, ...) through the zero-phase low-pass of torque and model.

        Args:
            values: at every ``stride``-th sample.
            kept: (K,) which of them become rows, `every` samples apart.
            stride: of the values.

        Returns:
            (K, ...).
        """
        weights, reach = _weights(self.cutoff, self.rate, self.every, stride)
        flat = turned_about(values.reshape(len(values), -1), reach)
        found = np.empty((len(kept), flat.shape[1]))
        for first in range(0, len(kept), len(weights)):
            some = kept[first : first + len(weights)]
            window = flat[some[0] : some[-1] + 2 * reach + 1]
            found[first : first + len(some)] = weights[: len(some), : len(window)] @ window
        return found.reshape(len(kept), *values.shape[1:])

    @property
    def motion_hz(self) -> float:
        """Hz above which the samples show nothing of the motion for noise."""
        beyond = CUTOFF.close_to_motion if self.position_cutoff < self.cutoff else CUTOFF.beyond_motion
        return min(self.cutoff, self.position_cutoff / beyond)

    @property
    def words(self) -> str:
        """What was done, in a sentence."""
        kept = f"every {self.every}th row kept" if self.every > 1 else "every row kept"
        slower = f" ({min(hz for _, hz in self.of_runs):.3g} Hz in the slowest run)" if self.of_runs else ""
        return (
            f"{self.rate:g} samples a second; positions low-passed at {self.position_cutoff:.3g} Hz{slower} and "
            f"derived by a spline of the fifth degree; torque and model low-passed alike at {self.cutoff:.3g} Hz "
            f"({self.cutoff_source}) by a zero-phase Butterworth filter of order {FILTER.order}; "
            f"{FILTER.edge_s:g} s left out at the ends; {kept}"
        )


@functools.lru_cache(maxsize=8)
def _weights(cutoff: float, rate: float, every: int, stride: int) -> tuple[Array, int]:
    """(B, n) weights of every ``stride``-th sample in B rows `every` apart, and by how many they reach beyond a row."""
    reach = int(np.ceil(FILTER.reach * rate / cutoff))
    impulse = np.zeros(6 * reach + 1)
    impulse[3 * reach] = 1.0
    from scipy.signal import sosfiltfilt

    response = sosfiltfilt(low_pass_sections(cutoff, rate), impulse, padlen=0)[2 * reach : 4 * reach + 1]
    response = response[reach % stride :: stride]
    response /= response.sum()
    reach, every = reach // stride, every // stride
    rows = np.zeros((FILTER.rows_at_once, (FILTER.rows_at_once - 1) * every + 2 * reach + 1))
    for number in range(len(rows)):
        rows[number, number * every : number * every + 2 * reach + 1] = response
    return rows, reach


def preparation(rate: float, cutoff: float, source: str, position_cutoff: float = np.inf) -> Preparation:
    """How samples of a rate become rows.

    Args:
        rate: samples per second.
        cutoff: Hz; not above `FILTER.nyquist` of half the rate.
        source: why this cut-off.
        position_cutoff: of the positions, Hz; at most `FILTER.position_band` times that of the torques.

    Returns:
        The filters and the decimation.
    """
    cutoff = min(cutoff, FILTER.nyquist * rate / 2)
    every = max(int(rate / (FILTER.rows_per_cutoff * cutoff)), 1)
    smooth = min(position_cutoff, FILTER.position_band * cutoff, FILTER.nyquist * rate / 2)
    stride = max(int(rate / (FILTER.formed_per_cutoff * smooth)), 1)
    return Preparation(rate, cutoff, smooth, max(every // stride, 1) * stride if every > stride else every, source)


def thinned(how: Preparation, samples: int) -> Preparation:
    """With fewer rows kept where there would be more than are needed: neighbours say the same."""
    times = -(-samples // (how.every * FILTER.most_rows))
    return replace(how, every=how.every * max(times, 1))


@dataclass(frozen=True, eq=False)
class Signals:
    """Samples of one stretch, or a part of it; every column of the model is a function of them."""

    run: str  # its name
    stretch: int  # number of the stretch
    time: Array  # (N,) s
    # q, dq, ddq: (N, m) filtered positions and their derivatives
    q: Array
    dq: Array
    ddq: Array
    effort: Array  # (K, m) of the rows, low-passed, N m (N) or A; none where every sample is kept
    payload: Array | None  # (N,) kg; temperature: (N, m) deg C; each or None
    temperature: Array | None
    kept: Indices  # (K,) which samples become rows; stride: of the samples, to the recorded ones
    stride: int = 1
    # (N, m) links less motors, less the middle of it in the stretch, with two derivatives; 0 of joints whose link has
    # no encoder, or one that tells noise. None where no link has one
    shift: tuple[Array, Array, Array] | None = None
    # (K, m) link less motor of the rows, low-passed, NaN of joints without such an encoder; or None
    twist: Array | None = None
    cut: NDArray[np.bool_] | None = None  # (K, m) rows that hold some effort that was cut off; or None
    running: Array | None = None  # (N,) s that the arm has run, or None
    began: float = 0.0  # s, when the run began

    def some_time_ago(self, joint: int, delay: float) -> tuple[Array, Array]:
        """(N,) velocity and acceleration of a joint's motor some time ago, s: a cubic by both between samples."""
        at = np.clip(np.arange(len(self.time)) - delay / self.period, 0, len(self.time) - 1)
        low = np.minimum(at.astype(np.intp), len(self.time) - 2)
        x, v, a = at - low, self.dq[:, joint], self.ddq[:, joint] * self.period
        apart = v[low + 1] - v[low]
        speed = v[low] + x * (a[low] + x * (3 * apart - 2 * a[low] - a[low + 1]))
        speed += x**3 * (a[low] + a[low + 1] - 2 * apart)
        change = a[low] + 2 * x * (3 * apart - 2 * a[low] - a[low + 1]) + 3 * x**2 * (a[low] + a[low + 1] - 2 * apart)
        return speed, change / self.period

    @property
    def of_links(self) -> tuple[Array, Array, Array]:
        """(N, m) positions of the links and their derivatives: the motors' where no link is recorded."""
        if self.shift is None:
            return self.q, self.dq, self.ddq
        q, dq, ddq = (motor + more for motor, more in zip((self.q, self.dq, self.ddq), self.shift, strict=True))
        return q, dq, ddq

    @property
    def period(self) -> float:
        """Between two samples, s."""
        return float(self.time[-1] - self.time[0]) / (len(self.time) - 1)


def parts(stretches: Sequence[Stretch], how: Preparation, every_sample: bool = False) -> Iterator[Signals]:
    """The stretches in parts of limited length, which overlap by what the filter needs.

    Args:
        stretches: even samples.
        how: the filters.
        every_sample: keep them all, those at the ends, too.

    Yields:
        Samples at full rate, with the rows that are kept of them; too short a stretch has none.
    """
    for number, stretch in enumerate(stretches):
        kept = np.arange(how.edge, len(stretch) - how.edge, how.every)
        if every_sample:
            kept = np.arange(len(stretch))
        for rows in np.array_split(kept, max(-(-len(stretch) // FILTER.chunk), 1)):
            if len(rows):
                yield _part(stretch, number, rows, how, every_sample)


def _part(stretch: Stretch, number: int, rows: Indices, how: Preparation, every_sample: bool) -> Signals:
    stride = 1 if every_sample else how.stride
    low = rows[0] - min(int(rows[0]), 2 * how.edge) // stride * stride
    high = min(rows[-1] + 2 * how.edge + 1, len(stretch))
    inside = slice(low, high)
    cutoff = how.position_cutoff_of(stretch.run)
    q = without_lag(stretch.q[inside], cutoff, how.rate, 15 * how.every, every_sample)
    path = make_interp_spline(np.arange(len(q)) / stretch.rate, q, k=5)
    times = path.t[0] + np.arange(len(q))[::stride] / stretch.rate
    shift, twist = _beside(stretch, inside, how, times, every_sample)
    return Signals(
        stretch.run,
        number,
        stretch.time[inside][::stride],
        q[::stride],
        path.derivative(1)(times),
        path.derivative(2)(times),
        q[:0] if every_sample else how.low_passed(stretch.effort[inside], rows - low),
        None if stretch.payload is None else stretch.payload[inside][::stride],
        None if stretch.temperature is None else stretch.temperature[inside][::stride],
        (rows - low) // stride,
        stride,
        shift,
        None if twist is None or every_sample else how.low_passed(twist, rows - low),
        stretch.cut_about(rows, READING.cut_reach / how.cutoff),
        None if stretch.running is None else stretch.running[inside][::stride],
        stretch.began,
    )


def _beside(
    stretch: Stretch, inside: slice, how: Preparation, times: Array, going: bool
) -> tuple[tuple[Array, Array, Array] | None, Array | None]:
    """What `Signals.shift` is at some times, s from the first sample inside, and link less motor of all samples."""
    if stretch.link is None:
        return None, None
    beside = stretch.link - stretch.q
    recorded = np.isfinite(beside).all(axis=0)
    about = np.where(recorded, beside - np.median(np.where(recorded, beside, 0.0), axis=0), 0.0)
    smooth = np.zeros_like(about[inside])
    for j in np.flatnonzero(bands := np.minimum(link_bands(beside, how.rate), how.position_cutoff)):
        smooth[:, j] = without_lag(about[inside, j], float(bands[j]), how.rate, 15 * how.every, going)
    path = make_interp_spline(np.arange(len(smooth)) / stretch.rate, smooth, k=5)
    return (path(times), path.derivative(1)(times), path.derivative(2)(times)), beside[inside]
