"""Which constants the poses can tell apart: rank-revealing QR, the frames first, then the arm, betas last."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.calibration.constants import IDENTIFYING
from armscope.core.types import Array, Indices
from armscope.design.independence import independent_columns


def identifiable(jacobian: Array, tiers: Indices, scales: Array) -> NDArray[np.bool_]:
    """The columns that can be told apart, a lower tier first (`armscope.design.independence`).

    Args:
        jacobian: (M, P).
        tiers: (P,) order of preference: what base frame and first joint have in common is settled for the base.
        scales: (P,) size of a unit in each column's own unit (1 m; 1 rad / reach), so that columns compare.

    Returns:
        (P,) boolean.
    """
    triangular = np.linalg.qr(jacobian, mode="r") if len(jacobian) > jacobian.shape[1] else jacobian
    return independent_columns(triangular * scales / np.sqrt(len(jacobian) / 3), tiers, IDENTIFYING.smallest_trace)
