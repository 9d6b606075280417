"""Rows that belong together: by a label, or because they were taken at the same configuration of the arm."""

from __future__ import annotations

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.core.types import Array, Indices

SAME_CONFIGURATION_DIGITS = 4
"""Angles (rad) that agree to so many digits are the same: controllers repeat better, and nobody plans closer poses."""


def same_configuration(angles: Array, *beside: NDArray[np.generic]) -> Indices:
    """Number the configurations of a table.

    Args:
        angles: (N, m) commanded, rad.
        beside: (N,) or (N, k) what else must agree: run, target, payload, side of approach; not recorded agrees with
            not recorded.

    Returns:
        (N,) number of each row's configuration, from 0.
    """
    number = np.zeros(len(angles), dtype=np.intp)
    for each in (np.round(angles, SAME_CONFIGURATION_DIGITS), *beside):
        for column in each.reshape(len(angles), -1).T:
            known = np.nan_to_num(column) if np.issubdtype(column.dtype, np.number) else column.astype(object)
            code = pd.factorize(known, sort=True)[0]
            # one column after the other: sorting whole rows takes ten times as long
            number = pd.factorize(number * (int(code.max()) + 1) + code, sort=True)[0]
    return number


def visited_by_others(pose: Indices, run: Indices) -> NDArray[np.bool_]:
    """(N,) rows at whose pose (N,) another run (N,) stood, too."""
    runs = int(run.max(initial=-1)) + 1
    visited = np.unique(pose * runs + run) // max(runs, 1)
    return np.asarray((np.bincount(visited) > 1)[pose])


def by_label(labels: NDArray[np.str_]) -> tuple[tuple[str, ...], Indices]:
    """Names in the order of their first row, and each row's number (N,) among them."""
    names, first, number = np.unique(labels, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return tuple(str(name) for name in names[order]), rank[number]


def named_configuration(run: NDArray[np.str_], name: NDArray[np.str_]) -> Indices:
    """(N,) number of each row's configuration where ids say which it is: an id within its run, by its first row."""
    return by_label(np.char.add(np.char.add(run, "\n"), name))[1]


def random_parts(group: Indices, count: int, rng: np.random.Generator) -> Indices:
    """Rows dealt into parts as evenly as whole groups allow.

    Args:
        group: (N,) number of each row's group, from 0; its rows stay together.
        count: how many parts.
        rng: draws them.

    Returns:
        (N,) number of each row's part, 0 ... count - 1.
    """
    return np.asarray((rng.permutation(int(group.max()) + 1) % count)[group])
