"""What a calibration of the geometry leaves, and whose it is.

Zeros and D-H rows hold most of an arm's error, and to calibrate them is routine: beside them a joint with play of a
third of a milliradian is one per cent, and all that is left once they are right. So what no zero and no row mends is
measured there, too: the tool's displacement by it without the part that zeros, rows, base and tool take up, as they do
when they are fitted to what was measured.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.types import Array
from armscope.physics.backgrounds import GEOMETRIC
from armscope.physics.geometric import JOINT_OFFSET, LINK_GEOMETRY, background
from armscope.verdict.constants import CALIBRATED
from armscope.verdict.contributions import Ground
from armscope.verdict.effects import Cause, FoundEffect

ENTERED = (JOINT_OFFSET.name, LINK_GEOMETRY.name)
"""What `armscope calibrate` finds: an axis that wobbles has no number among zeros and rows, and bars have none."""


@dataclass(frozen=True, eq=False)
class Calibrated:
    """Rows of a verdict once zeros and D-H rows are right and fitted."""

    ground: Ground  # the rows; what geometry takes up, frames take up
    start: Array  # (n, 3) mm, with nothing else cured
    end: Array  # (n, 3) mm, with everything cured
    whole: Array  # (n, 3) mm, what the whole error is beside base and tool

    def share(self, moved: Array) -> float:
        """Of the squared error there, by a contribution (n, 3) at the tool."""
        return float(np.sum(self.ground.free(moved) * (self.start + self.end)) / np.sum(self.start**2))

    def of_scatter(self, share: float) -> float:
        """The same of what no model moves, by its share of the whole."""
        return float(min(share * np.sum(self.whole**2) / np.sum(self.start**2), 1.0))


def mended_by_calibration(effect: FoundEffect) -> bool:
    """Whether zeros and D-H rows fitted afresh mend an effect."""
    return effect.effect in ENTERED


def once_calibrated(
    ground: Ground, left: Array, moved: Iterable[tuple[FoundEffect, Array]], small: Mapping[str, Array]
) -> Calibrated | None:
    """What a calibration of the geometry leaves.

    Args:
        ground: rows, and what base and tool take up there.
        left: (n, 3) mm with everything cured.
        moved: the effects with their contributions, (n, 3) mm.
        small: by family, (n, 3) mm of the small errors without a name.

    Returns:
        It; None where no geometry is off, or where so few rows leave nothing beside it.
    """
    off = [its for effect, its in moved if mended_by_calibration(effect)]
    if GEOMETRIC not in small and not off:
        return None
    wider = replace(ground, taken_up=_with_geometry(ground))
    if wider.taken_up.shape[1] > CALIBRATED.most_taken_up * left.size:
        return None
    _, before = ground.left_and_before()
    start = wider.free(before - sum(off, small.get(GEOMETRIC, np.zeros_like(before))))
    return Calibrated(wider, start, wider.free(left), before) if np.any(start) else None


def _with_geometry(ground: Ground) -> Array:
    """(3 n, f) orthonormal: what base, tool, zeros and rows take up together."""
    terms = [term for placed in background(ground.verdict.model.arm) for term in placed.terms]
    columns = np.stack([ground.posture.column(term).reshape(-1) for term in terms], axis=1)
    columns -= ground.taken_up @ (ground.taken_up.T @ columns)
    scale = np.linalg.norm(columns, axis=0)
    kept = scale > CALIBRATED.same_column * scale.max()
    directions, size, _ = np.linalg.svd(columns[:, kept] / scale[kept], full_matrices=False)
    return np.hstack([ground.taken_up, directions[:, size > CALIBRATED.same_column * size[0]]])


def stands_out(told: FoundEffect | Cause) -> bool:
    """Whether it is a substantial part of what a calibration leaves."""
    return told.share_after_calibration >= CALIBRATED.stands_out  # NaN: not asked


def share_beside_its_like(told: FoundEffect) -> float:
    """Of what a calibration leaves, where that is known: by the whole, causes of one family would differ by what
    geometry hides of them.
    """
    after = told.share_after_calibration
    return after if math.isfinite(after) else told.share
