"""Steps of Newton's method towards where a tool should be, for many rows at once."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.robot.constants import SEARCH


def damping(distance: Array, least: float) -> Array:
    """(N,) what keeps steps finite where an arm is stretched out, m^2 per rad^2; it vanishes with the gap.

    Args:
        distance: (N,) size of the gap, m.
        least: that is always there, m^2 per rad^2.

    Returns:
        (N,) to add to the diagonal of J J'.
    """
    return np.asarray(SEARCH.far_damping * np.minimum(distance**2, SEARCH.farthest_m2) + least)


def least_turns(jacobian: Array, gap: Array, damped: Array) -> Array:
    """(N, m) the smallest turns of the motors that close gaps to first order: J' (J J' + damping)^-1 gap, rad.

    Args:
        jacobian: (N, k, m) how k numbers of the tool move by the motors, m/rad.
        gap: (N, k) what is missing, m.
        damped: (N,) from `damping`.

    Returns:
        (N, m) rad.
    """
    gram = jacobian @ np.swapaxes(jacobian, 1, 2)
    gram += damped[:, None, None] * np.eye(gram.shape[1])
    return np.asarray(np.einsum("nij,ni->nj", jacobian, np.linalg.solve(gram, gap[..., None])[..., 0]))


def shortened(step: Array, largest: float) -> Array:
    """(N, m) steps, each row's shrunk until none of its motors turns further than ``largest``, rad."""
    share: Array = np.minimum(1.0, largest / np.maximum(np.abs(step).max(axis=1), SEARCH.no_turn_rad))
    return step * share[:, None]


def smallest_singular_value(jacobian: Array) -> Array:
    """(N,) of Jacobians (N, k, m): what a unit turn of the motors moves the tool at least, m/rad."""
    gram = jacobian @ np.swapaxes(jacobian, 1, 2)
    return np.asarray(np.sqrt(np.maximum(np.linalg.eigvalsh(gram)[:, 0], 0)))
