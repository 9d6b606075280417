"""A spring between a point of one link and a point of the next: gas springs and most balancers are mounted so.

With the points at distances 1 and r (the shorter over the longer one) from the joint's axis and x between their
directions, the spring is l = sqrt(1 + r^2 - 2 r cos x) long, and its force has the lever r sin(x) / l (law of cosines;
virtual work).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.motion.library.causes import Moment
from armscope.motion.library.linkage_constants import LINKAGE

BETWEEN_LINKS = "between links"
"""The variant of a balancer that is mounted so."""


def pull(angle: Array, ratio: float | Array, middle: float | Array) -> Array:
    """Torque of such a spring, by its force in the middle of the joint's range, and by how that grows with its length.

    Args:
        angle: (...) rad between its ends' directions.
        ratio: of their distances from the axis, the shorter over the longer one.
        middle: the angle, rad, at which its force is told.

    Returns:
        (..., 2) per N m of force times the shorter distance, and per N m of its growth over the longer one.
    """
    long = length(angle, ratio)
    lever = np.sin(angle) / long
    return np.stack([lever, lever * (long - length(middle, ratio))], axis=-1)


def length(angle: float | Array, ratio: float | Array) -> Array:
    """(...) of the spring, to the longer distance."""
    return np.asarray(np.sqrt(np.maximum(1 + np.square(ratio) - 2 * ratio * np.cos(angle), LINKAGE.shortest**2)))


def pushes_one_way(numbers: Array, angle: Array, ratio: float | Array, middle: float | Array) -> NDArray[np.bool_]:
    """Whether a spring's force keeps its sign, as that of every gas spring and pre-tensioned spring does.

    Args:
        numbers: (..., 2) as `pull` takes them.
        angle: (N, ...) rad between its ends' directions.
        ratio: as `pull` takes it.
        middle: as `pull` takes it.

    Returns:
        (...).
    """
    longer, force, growth = length(angle, ratio) - length(middle, ratio), numbers[..., 0], numbers[..., 1]
    ends = np.stack([force + growth * longer.min(axis=0), force + growth * longer.max(axis=0)])
    return np.asarray(np.all(ends * force > 0, axis=0))


def spring_between_links(m: Moment, joints: tuple[int, ...], phase: float, ratio: float, middle: float) -> Array:
    """Torque of such a spring at a joint's positions.

    Args:
        m: N samples.
        joints: its joint, from 0.
        phase: rad, between its ends' directions where the joint stands at zero.
        ratio: as `pull` takes it.
        middle: position of the joint at which the force is told, rad.

    Returns:
        (N, 2).
    """
    return pull(m.signals.q[:, joints[0]] + phase, ratio, middle + phase)
