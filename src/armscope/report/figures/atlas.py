"""The atlas: how much of the mismatch each place could explain with each driver, as a table of coloured cells."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from armscope.core.types import Array
from armscope.report.colours import SHARES, share_level
from armscope.verdict.diagnosis import Atlas, Diagnosis
from armscope.verdict.effects import FoundEffect
from armscope.verdict.sentences import atlas_column

WORTH_A_NUMBER = 0.03  # Cells below this share are coloured but carry no number
LEAST_END = 0.05  # The colours' end is never below this share


@dataclass(frozen=True)
class AtlasCell:
    """A share's text ("" for none), its colour's step (None: there is no such effect), and whether it was named."""

    text: str
    level: int | None
    named: bool = False

    @property
    def dark(self) -> bool:
        """Whether its colour is of the darker half."""
        return self.level is not None and self.level > 0.45 * len(SHARES)


@dataclass(frozen=True)
class Map:
    """Drivers in words, and by location its cells before any effect and after the fitted model."""

    drivers: tuple[str, ...]
    rows: tuple[tuple[str, tuple[AtlasCell, ...], tuple[AtlasCell, ...]], ...]


def attribution(verdict: Diagnosis) -> bool:
    """Whether there is anything in the atlas."""
    return verdict.atlas is not None and bool(np.isfinite(verdict.atlas.share).any())


def cell_of(effect: FoundEffect) -> tuple[str, str]:
    """Location and driver of the cell in which an effect shows."""
    return effect.location, atlas_column(effect)


def atlas_map(atlas: Atlas, effects: Sequence[Any], cell: Callable[[Any], tuple[str, str]] = cell_of) -> Map:
    """The best direction's share of every location and driver that exist, and which cells the named effects are in.

    Args:
        atlas: of poses or of a motion.
        effects: the named ones.
        cell: location and driver of the cell in which such an effect shows.

    Returns:
        The cells as they are shown.
    """
    share, left = (_best_direction(values) for values in (atlas.share, atlas.left))
    there = np.isfinite(share)
    rows, columns = (np.flatnonzero(there.any(axis=axis)).tolist() for axis in (1, 0))
    named = set(map(cell, effects))
    end = max(LEAST_END, float(np.nanmax(share, initial=0.0)))

    def cells(values: Array, row: int, frames: bool) -> tuple[AtlasCell, ...]:
        return tuple(
            _cell(values[row, column], end, frames and (atlas.locations[row], atlas.drivers[column]) in named)
            for column in columns
        )

    return Map(
        tuple(atlas.drivers[column] for column in columns),
        tuple((atlas.locations[row], cells(share, row, True), cells(left, row, False)) for row in rows),
    )


def _cell(share: float, end: float, named: bool) -> AtlasCell:
    if not np.isfinite(share):
        return AtlasCell("", None, named)
    return AtlasCell(f"{100 * share:.0f}" if share >= WORTH_A_NUMBER else "", share_level(share / end), named)


def _best_direction(values: Array) -> Array:
    """(locations, drivers) the largest over directions; NaN where there is no effect."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # all directions NaN: there is no such effect
        return np.asarray(np.nanmax(values, axis=1))
