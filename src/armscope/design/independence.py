"""Which columns of a Jacobian poses can tell apart: rank-revealing QR, tier by tier."""

from __future__ import annotations

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from armscope.core.types import Array, Indices


def independent_columns(columns: Array, tiers: Indices, least: float) -> NDArray[np.bool_]:
    """The columns that can be told apart, by QR with column pivoting (Golub 1965).

    Within a tier the column with the largest part beyond those chosen enters next, until what is left of every column
    is small: the diagonal of the triangular factor reveals the rank. A lower tier enters first, so that a redundancy
    between columns of two tiers is settled for the lower one.

    Args:
        columns: (M, P), in units that compare.
        tiers: (P,) order of preference.
        least: norm of what must be left of a column beyond those chosen.

    Returns:
        (P,) whether each is chosen.
    """
    left = columns
    chosen = np.zeros(columns.shape[1], dtype=bool)
    for tier in np.unique(tiers):
        members = np.flatnonzero(tiers == tier)
        basis, factor, order = scipy.linalg.qr(left[:, members], mode="economic", pivoting=True)
        rank = int(np.sum(np.abs(np.diag(factor)) > least))
        chosen[members[order[:rank]]] = True
        span = basis[:, :rank]
        left = left - span @ (span.T @ left)
    return chosen
