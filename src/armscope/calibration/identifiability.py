"""Which constants the poses can tell apart: rank-revealing QR, the frames first, then the arm, betas last."""

from __future__ import annotations

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from armscope.core.types import Array

SMALLEST_TRACE = 1e-3
"""A constant counts as identifiable if a change of it leaves at least this share (per metre, or per radian and metre of
reach) at the tool, beyond what the others can imitate. At a thousandth, 1 mm shows as 1 micrometre: no less helps."""


def identifiable(jacobian: Array, tiers: NDArray[np.intp], scales: Array) -> Array:
    """The columns that can be told apart, chosen tier by tier by QR with column pivoting (Golub 1965).

    Within a tier the column with the largest part beyond those chosen enters next, until what is left of every column
    is below `SMALLEST_TRACE`: the diagonal of the triangular factor reveals the rank. A lower tier enters first, so
    that a redundancy between the base frame and the first joint is settled for the base.

    Args:
        jacobian: (M, P).
        tiers: (P,) order of preference.
        scales: (P,) size of a unit in each column's own unit (1 m; 1 rad / reach), so that columns compare.

    Returns:
        (P,) boolean.
    """
    triangular = np.linalg.qr(jacobian, mode="r") if len(jacobian) > jacobian.shape[1] else jacobian
    remaining = triangular * scales / np.sqrt(len(jacobian) / 3)
    chosen = np.zeros(jacobian.shape[1], dtype=bool)
    for tier in np.unique(tiers):
        members = np.flatnonzero(tiers == tier)
        basis, factor, order = scipy.linalg.qr(remaining[:, members], mode="economic", pivoting=True)
        rank = int(np.sum(np.abs(np.diag(factor)) > SMALLEST_TRACE))
        chosen[members[order[:rank]]] = True
        span = basis[:, :rank]
        remaining = remaining - span @ (span.T @ remaining)
    return chosen
