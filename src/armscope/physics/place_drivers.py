"""What effects of the instrument follow: where in its measuring volume the nominal tool stands."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial.legendre import legval

from armscope.core.types import Array
from armscope.physics.effect import DriverKind

if TYPE_CHECKING:
    from armscope.physics.scene import Scene


DEGREE = 3
"""Of the polynomials of the place: a lens bends space with the cube of the distance from its axis."""


def legendre_product(points: Array, degrees: tuple[int, ...], centre: tuple[float, ...], width: float) -> Array:
    """Product of Legendre polynomials of the coordinates of points; beyond the volume as on its border.

    Args:
        points: (N, 3) in base axes, m.
        degrees: along x, y and z.
        centre: of the volume, x, y, z, m.
        width: half of its width, m.

    Returns:
        (N,) values, -1 ... 1.
    """
    inside = np.clip((points - np.array(centre)) / width, -1.0, 1.0)
    along = [legval(inside[:, axis], np.eye(DEGREE + 1)[degree]) for axis, degree in enumerate(degrees)]
    return np.asarray(np.prod(along, axis=0))


# by name, as model.yaml is checked: a degree, a place and a width are different kinds of numbers
def _place(
    scene: Scene, degree_x: int, degree_y: int, degree_z: int, x: float, y: float, z: float, width: float
) -> Array:
    return legendre_product(scene.nominal.tool, (degree_x, degree_y, degree_z), (x, y, z), width)


PLACES: dict[str, DriverKind] = {"place": DriverKind(_place)}
"""Kinds of drivers by name."""
