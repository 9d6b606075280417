"""Curves over a joint's own torque that hold only beside another model than the one that they are part of.

Such a curve is formed of what the last round's model says of the torque. Where most of that is friction, the curve and
the friction beside it can trade most of it between them: the rows are met, and the torque of which the curve is formed
is no longer what the model says. Written into a file it would be formed of the model's own, and miss.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from armscope.core.types import Array, Indices
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library import catalogue
from armscope.motion.library.laws import Law, higher_powers
from armscope.motion.library.layout import CAUSES_OF_OWN, OWN


def of_another_model(selected: SelectedCauses) -> Iterator[int]:
    """Numbers of the curves that, formed of the model's own torque, say otherwise by more than the fit leaves."""
    rows, layout = selected.rows, selected.rows.layout
    for number in selected.best.candidates:
        placed = layout.placed[number]
        if (
            placed.cause is not catalogue.CURVE
            or placed.driver != catalogue.SCALE
            or not isinstance(placed.columns, Law)
        ):
            continue
        j = placed.joints[0]
        moving = np.flatnonzero(rows.moving[:, j])
        powers = layout.columns[number][1:]
        fitted = _torque(selected, powers)[moving, j]
        own = (rows.nominal + _torque(selected, OWN * j + np.arange(CAUSES_OF_OWN)))[moving, j]
        said = higher_powers(own, *placed.columns.numbers) @ selected.coefficients[powers]
        left = (rows.torque - rows.nominal - rows.modelled(selected.coefficients))[moving, j]
        if np.linalg.norm(said - fitted) > np.linalg.norm(left):
            yield number


def _torque(selected: SelectedCauses, columns: Indices) -> Array:
    """(K, m) that some columns make."""
    coefficients = np.zeros(selected.rows.layout.width)
    coefficients[columns] = selected.coefficients[columns]
    return selected.rows.modelled(coefficients)
