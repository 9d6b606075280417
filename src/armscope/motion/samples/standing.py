"""How little a joint moves that stands."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.motion.constants import LIBRARY


def still_span(sliding: NDArray[np.bool_]) -> Array:
    """(m,) rad, or m of joints that slide (m,): whatever spans less stands."""
    return np.where(sliding, LIBRARY.still_m, LIBRARY.still_rad)
