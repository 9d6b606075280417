"""Some rows of many."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array, Indices


def spread_evenly(count: int, most: int) -> Indices:
    """(n,) at most ``most`` of the numbers 0 ... count - 1, ascending, first and last among them."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).astype(np.intp))


def in_one_stretch(numbers: Indices) -> slice | Indices:
    """Ascending numbers as a slice, if they follow one another: what it takes need not be copied."""
    first, last = int(numbers[0]), int(numbers[-1])
    return slice(first, last + 1) if last - first + 1 == len(numbers) else numbers


def spread_over_a_sphere(count: int) -> Array:
    """(count, 3) unit vectors, evenly spread: points on a spiral, each a golden angle further (Swinbank 2006)."""
    at = (np.arange(count) + 0.5) / count
    height, turn = 1 - 2 * at, np.pi * (3 - np.sqrt(5)) * np.arange(count)
    across = np.sqrt(1 - height**2)
    return np.column_stack([across * np.cos(turn), across * np.sin(turn), height])
