"""Averages by squares."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array


def rms(values: Array) -> float:
    """Root mean square of all numbers; 0 of none."""
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0


def rms_distance(vectors: Array) -> float:
    """Root mean square of the lengths of vectors (N, 3): the 3D distance, or the angle of rotation vectors."""
    return float(np.sqrt(np.mean(np.sum(vectors**2, axis=1))))
