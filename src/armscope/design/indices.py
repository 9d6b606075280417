"""Observability indices: numbers that say how well a set of poses shows parameters, from its singular values.

J stacks what each pose shows: three rows per pose, one column per parameter, each in units that compare. Its singular
values s_1 >= ... >= s_p are the semi-axes of the ellipsoid of tool displacements that the unit ball of parameters
makes. For n poses:

| index | formula | source | alphabet |
|---|---|---|---|
| O1 | (s_1 ... s_p)^(1/p) / sqrt(n) | Borm & Menq 1989, 1991 | D |
| O2 | s_p / s_1 | Driels & Pathre 1990 | |
| O3 | s_p | Nahvi, Hollerbach & Hayward 1994 | E |
| O4 | s_p^2 / s_1 | Nahvi & Hollerbach 1996 | |
| O5 | 1 / (1/s_1 + ... + 1/s_p) | Sun & Hollerbach 2008 | A (which takes the squares) |

The more the better, for all five. O1 orders sets of poses alike whatever the parameters' units are; the others do not.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from armscope.core.types import Array

SOURCES: Mapping[str, str] = MappingProxyType(
    {
        "O1": "Borm & Menq (1989, 1991): volume of the ellipsoid; D-optimality",
        "O2": "Driels & Pathre (1990): inverse condition number",
        "O3": "Nahvi, Hollerbach & Hayward (1994): smallest singular value; E-optimality",
        "O4": "Nahvi & Hollerbach (1996): noise amplification index",
        "O5": "Sun & Hollerbach (2008): inverse sum of the inverse singular values; close to A-optimality",
    }
)
"""Where each index comes from."""


def observability(index: str, singular: Array, poses: int) -> Array:
    """An index (..) from singular values (.., p) of the stacked Jacobian of so many poses; 0 where one of them is 0.

    Args:
        index: O1 ... O5.
        singular: (.., p) singular values in units that compare.
        poses: how many poses they are of.

    Returns:
        (..) the index, of the unit of the singular values (O2 has none).
    """
    s = np.sort(np.asarray(singular, dtype=float), axis=-1)[..., ::-1]
    smallest, largest = s[..., -1], s[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        formulas: dict[str, Callable[[], Array]] = {
            "O1": lambda: np.exp(np.mean(np.log(s), axis=-1)) / np.sqrt(poses),
            "O2": lambda: smallest / largest,
            "O3": lambda: smallest,
            "O4": lambda: smallest**2 / largest,
            "O5": lambda: 1 / np.sum(1 / s, axis=-1),
        }
        value = formulas[index]()
    return np.where(smallest > 0, np.nan_to_num(value), 0.0)


def observability_slopes(index: str, singular: Array) -> Array:
    """(p,) slope of the index's logarithm by each eigenvalue s^2 of the information J'J, singular values descending."""
    weight = 0.5 / singular**2  # of log s by s^2
    first, last = np.eye(len(singular))[0], np.eye(len(singular))[-1]
    by_log_s: Array = {
        "O1": np.full(len(singular), 1 / len(singular)),
        "O2": last - first,
        "O3": last,
        "O4": 2 * last - first,
        "O5": (1 / singular) / np.sum(1 / singular),
    }[index]
    return by_log_s * weight


def all_indices(jacobian: Array) -> dict[str, float]:
    """O1 to O5 of poses (n, 3, p)."""
    singular = np.asarray(np.linalg.svd(jacobian.reshape(-1, jacobian.shape[2]), compute_uv=False), dtype=float)
    if len(singular) < jacobian.shape[2]:
        return dict.fromkeys(SOURCES, 0.0)
    return {index: float(observability(index, singular, len(jacobian))) for index in SOURCES}
