"""Turns of many frames at once, for whom scipy's `Rotation` would cost more in its import than in its work."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array

SMALL_TURN = 1e-4  # Below it (rad) the series of sin(a)/a and (1 - cos(a))/a^2 are exact to all digits after two terms


def turned_by(vectors: Array) -> Array:
    """(..., 3, 3) rotation matrices of rotation vectors (..., 3), rad (Rodrigues 1840)."""
    x, y, z = np.moveaxis(np.asarray(vectors, dtype=float), -1, 0)
    square = x * x + y * y + z * z
    angle = np.sqrt(square)
    small = angle < SMALL_TURN
    safe = np.where(small, 1.0, angle)
    first = np.where(small, 1 - square / 6, np.sin(safe) / safe)
    second = np.where(small, 0.5 - square / 24, 2 * (np.sin(safe / 2) / safe) ** 2)
    turned = np.empty((*square.shape, 3, 3))
    # entry by entry: products of many small matrices take several times as long
    turned[..., 0, 0] = 1 - second * (y * y + z * z)
    turned[..., 1, 1] = 1 - second * (x * x + z * z)
    turned[..., 2, 2] = 1 - second * (x * x + y * y)
    for row, column, one, other, third in ((0, 1, x, y, z), (1, 2, y, z, x), (2, 0, z, x, y)):
        both, across = second * one * other, first * third
        turned[..., row, column], turned[..., column, row] = both - across, both + across
    return turned


def cross(one: Array, other: Array) -> Array:
    """(..., 3) one x other, component by component: on few rows NumPy's own takes several times as long."""
    crossed = np.empty(np.broadcast_shapes(one.shape, other.shape))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        crossed[..., i] = one[..., j] * other[..., k] - one[..., k] * other[..., j]
    return crossed


def cross_matrices(vectors: Array) -> Array:
    """(..., 3, 3) matrices that take the cross product of vectors (..., 3) with what they are multiplied by."""
    vectors = np.asarray(vectors, dtype=float)
    matrices = np.zeros((*vectors.shape, 3))
    for row, column, axis in ((2, 1, 0), (0, 2, 1), (1, 0, 2)):
        matrices[..., row, column] = vectors[..., axis]
        matrices[..., column, row] = -vectors[..., axis]
    return matrices


def turn_onto(points: Array, wanted: Array) -> Array:
    """(3, 3) the rotation about the origin that brings points (N, 3) nearest to wanted ones (N, 3) (Kabsch 1976)."""
    left, _, right = np.linalg.svd(wanted.T @ points)
    proper = np.array([1.0, 1.0, np.sign(np.linalg.det(left @ right)) or 1.0])
    return np.asarray(left * proper @ right)
