"""Which joints move in a table: one answer for all who ask."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.recordings.constants import READING


def moving(angles: Array) -> NDArray[np.bool_]:
    """(m,) whether each of m joints moves, by its angles (N, m), rad."""
    return np.asarray(np.ptp(angles, axis=0) > READING.still_rad)
