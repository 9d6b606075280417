"""How samples go on beyond their ends, so that a low-pass has something to go through there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import legvander

from armscope.core.constants import Constants
from armscope.core.types import Array


@dataclass(frozen=True)
class EndRules(Constants):
    """How a path goes on where it ends."""

    degree: int = 4
    """of the polynomial by which a path goes on beyond its end [1]; measured: 16 paths of 8 simulated arms,
    accelerations in the last 0.15 s: 1 % off in the middle case (12 % at most); turned about the end point, 35 % (more
    than all of it)"""
    cycles: float = 2.0
    """of the low-pass's frequency, to which that polynomial is fitted [cycles]; measured: as the degree"""


ENDS = EndRules()


def turned_about(values: Array, reach: int) -> Array:
    """Samples (N, c) with `reach` more at both ends, turned about the end points, as far as there are any."""
    turned, count = min(reach, len(values) - 1), len(values)
    whole = np.empty((count + 2 * reach, values.shape[1]))
    whole[reach : reach + count] = values
    whole[reach - turned : reach] = 2 * values[0] - values[turned:0:-1]
    whole[reach + count : reach + count + turned] = 2 * values[-1] - values[-2 : -turned - 2 : -1]
    whole[: reach - turned], whole[reach + count + turned :] = whole[reach - turned], whole[reach + count + turned - 1]
    return whole


def going_on(values: Array, cutoff: float, rate: float) -> tuple[Array, int]:
    """Samples (N, ...) with more at both ends, as a polynomial through the last ones has them; and how many more.

    Turned about its end point, a path would not speed up there: a low-pass takes an arm's acceleration away.

    Args:
        values: at least two.
        cutoff: of the low-pass, Hz.
        rate: samples per second.

    Returns:
        As said; the polynomial is of no higher degree than the samples can tell.
    """
    reach = max(int(ENDS.cycles * rate / cutoff), ENDS.degree + 2)
    window = min(reach, len(values))
    degree = min(ENDS.degree, max(window - 2, 1))
    inside = np.linalg.pinv(legvander(np.linspace(-1, 1, window), degree))
    beyond = legvander(1 + 2 * np.arange(1, reach + 1) / max(window - 1, 1), degree) @ inside
    after = np.tensordot(beyond, values[-window:], axes=1)
    before = np.tensordot(beyond, values[:window][::-1], axes=1)[::-1]
    return np.concatenate([before, values, after]), reach
