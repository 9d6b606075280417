"""From samples to rows: low-pass without lag, derivatives, the same low-pass for torque and model, every n-th row kept.

As in the protocol of ../shared/motions: positions are low-passed at five times the cut-off and derived by central
differences; every column of the model is formed at full rate and goes through the filter that the torque goes through.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.signal import butter, sosfiltfilt

from armscope.core.types import Array, Indices
from armscope.motion.constants import FILTER
from armscope.motion.timing import Stretch


@dataclass(frozen=True)
class Preparation:
    """How samples become rows.

    Attributes:
        rate: samples per second.
        cutoff: of torque and model, Hz.
        position_cutoff: of the positions before they are derived, Hz.
        every: every how many samples a row is kept.
        cutoff_source: why this cut-off.
    """

    rate: float
    cutoff: float
    position_cutoff: float
    every: int
    cutoff_source: str

    @property
    def edge(self) -> int:
        """Samples left out at both ends of a stretch."""
        return int(np.ceil(FILTER.edge_s * self.rate))

    def low_passed(self, values: Array, cutoff: float | None = None) -> Array:
        """Samples (N, ...) through a zero-phase low-pass.

        Args:
            values: at full rate.
            cutoff: Hz; that of torque and model where not given.

        Returns:
            As many samples.
        """
        sections = _sections(self.cutoff if cutoff is None else cutoff, self.rate)
        return np.asarray(sosfiltfilt(sections, values, axis=0, padlen=min(3 * self.every * 5, len(values) - 1)))

    @property
    def words(self) -> str:
        """What was done, in a sentence."""
        kept = f"every {self.every}th row kept" if self.every > 1 else "every row kept"
        return (
            f"{self.rate:g} samples a second; positions low-passed at {self.position_cutoff:.3g} Hz and derived by "
            f"central differences; torque and model low-passed alike at {self.cutoff:.3g} Hz ({self.cutoff_source}) by "
            f"a zero-phase Butterworth filter of order {FILTER.order}; {FILTER.edge_s:g} s left out at the ends; {kept}"
        )


@functools.lru_cache(maxsize=8)
def _sections(cutoff: float, rate: float) -> Array:
    return np.asarray(butter(FILTER.order, min(cutoff, 0.49 * rate), fs=rate, output="sos"))


def preparation(rate: float, cutoff: float, source: str) -> Preparation:
    """How samples of a rate become rows.

    Args:
        rate: samples per second.
        cutoff: Hz; not above `FILTER.nyquist` of half the rate.
        source: why this cut-off.

    Returns:
        The filters and the decimation.
    """
    cutoff = min(cutoff, FILTER.nyquist * rate / 2)
    every = max(int(rate / (FILTER.rows_per_cutoff * cutoff)), 1)
    return Preparation(rate, cutoff, min(FILTER.position_band * cutoff, FILTER.nyquist * rate / 2), every, source)


@dataclass(frozen=True, eq=False)
class Signals:
    """Samples of one stretch, or a part of it, at full rate; every column of the model is a function of them.

    Attributes:
        run: its name.
        stretch: number of the stretch.
        time: (N,) s.
        q, dq, ddq: (N, m) filtered positions and their derivatives.
        effort: (N, m) as recorded, N m (N) or A.
        payload: (N,) kg; temperature: (N, m) deg C; each or None.
        kept: (K,) which samples become rows.
    """

    run: str
    stretch: int
    time: Array
    q: Array
    dq: Array
    ddq: Array
    effort: Array
    payload: Array | None
    temperature: Array | None
    kept: Indices


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
                yield _part(stretch, number, rows, how)


def _part(stretch: Stretch, number: int, rows: Indices, how: Preparation) -> Signals:
    low, high = max(rows[0] - 2 * how.edge, 0), min(rows[-1] + 2 * how.edge + 1, len(stretch))
    inside = slice(low, high)
    q = how.low_passed(stretch.q[inside], how.position_cutoff)
    dq = np.gradient(q, 1 / stretch.rate, axis=0)
    return Signals(
        stretch.run,
        number,
        stretch.time[inside],
        q,
        dq,
        np.gradient(dq, 1 / stretch.rate, axis=0),
        stretch.effort[inside],
        None if stretch.payload is None else stretch.payload[inside],
        None if stretch.temperature is None else stretch.temperature[inside],
        rows - low,
    )
