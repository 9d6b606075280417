"""Sizes of the backgrounds, by family."""

from __future__ import annotations

from armscope.inference.model_space import BackgroundSizes
from armscope.physics.backgrounds import FAMILIES


def sizes(*first: int) -> BackgroundSizes:
    """Numbers of the first families' sizes; the others have none."""
    return (*first, *[0] * (len(FAMILIES) - len(first)))
