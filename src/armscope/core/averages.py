"""Averages by squares, and the scale that bad values do not move."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array

NORMAL_SCALE = 1.4826
"""Standard deviation of normal numbers per median of their distances from the middle: 1 / its 75 % quantile."""


def robust_scale(distances: Array) -> float:
    """Standard deviation of normal numbers that lie so far (N,) from their middle; half of them may be bad."""
    return NORMAL_SCALE * float(np.median(np.abs(distances)))


def rms(values: Array) -> float:
    """Root mean square of all numbers; 0 of none."""
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0


def rms_distance(vectors: Array) -> float:
    """Root mean square of the lengths of vectors (N, 3): the 3D distance, or the angle of rotation vectors."""
    return float(np.sqrt(np.mean(np.sum(vectors**2, axis=1))))
