"""What the families share when they place effects: which joints move, which context varies."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from armscope.core.types import Array
from armscope.recordings import Recordings
from armscope.recordings.motion import moving

if TYPE_CHECKING:
    from armscope.physics.effect import Placed
    from armscope.robot import Arm


def nowhere(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    """Places of what the library does not place: the diagnosis finds them, or it is in every model."""
    return iter(())


def moving_joints(recordings: Recordings) -> list[int]:
    """Motors (1-based) that move."""
    return [int(j) + 1 for j in np.flatnonzero(moving(recordings.motor_angles))]


def varies(values: Array | None, least: float) -> bool:
    """Whether a context column is there and spans more than ``least``."""
    if values is None:
        return False
    known = values[~np.isnan(values)]
    return len(known) > 1 and float(np.ptp(known)) > least


def varying_columns(values: Array | None, least: float) -> Iterator[int]:
    """Numbers (1-based) of the columns that vary."""
    if values is not None:
        for j in range(values.shape[1]):
            if varies(values[:, j], least):
                yield j + 1
