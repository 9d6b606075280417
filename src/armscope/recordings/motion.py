"""Which joints move in a table: one answer for all who ask."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array

STANDS_STILL_RAD = 1e-2
"""A joint whose commanded angles span less than this tells nothing about what follows its angle: servo noise."""


def moving(angles: Array) -> NDArray[np.bool_]:
    """(m,) whether each of m joints moves, by its angles (N, m), rad."""
    return np.asarray(np.ptp(angles, axis=0) > STANDS_STILL_RAD)
