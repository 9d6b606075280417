"""Bearings and bases softer about one axis than about the other: every arm has a little of it, allowed for, not named.

A tilting bearing gives way by a symmetric 2 x 2 compliance about its x and y. Its mean is the bearing compliance that
may have a name; here are the two values that are left: half the difference, and what is across.
"""

from __future__ import annotations

from collections.abc import Iterator

from armscope.physics.effect import Direction, Driver, Effect, Placed, Product, term
from armscope.physics.elastic import BASE_COMPLIANCE, BEARING_COMPLIANCE, tilt_per_moment
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm

UNEVEN = "uneven"
"""The variant of a bearing's compliance that says by how much it is not the same about x and y."""


def uneven_bearings(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    """By how much each bearing is softer about one axis of its joint than about the other.

    Args:
        arm: with masses; otherwise there are none.
        recordings: the rows.

    Yields:
        One per joint, two values in rad/(N m): the compliance about x is the mean and the difference, about y the mean
        less the difference.
    """
    if arm.has_masses:
        scene = Scene(arm, recordings)
        yield from (_uneven(BEARING_COMPLIANCE, scene, f"joint {j}") for j in range(1, arm.n_joints + 1))


def uneven_base(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    """The same of the base: a pedestal or a machine's bed is not round."""
    if arm.has_masses:
        yield _uneven(BASE_COMPLIANCE, Scene(arm, recordings), "base")


def _uneven(tilts: Effect, scene: Scene, place: str) -> Placed:
    about_x, about_y = (Direction(place, axis) for axis in ("rx", "ry"))
    under_x, under_y = (Driver("moment", (place, n)) for n in (0, 1))
    apart = (Product(about_x, under_x), Product(about_y, under_y, -1.0))
    size = tilt_per_moment(scene, place)
    terms = (
        term("difference", "rad/(N m)", *apart, plausible=size),
        term("across", "rad/(N m)", (about_x, under_y), (about_y, under_x), plausible=size),
    )
    return Placed(tilts, place, terms, (1.0, 1.0), f"moment across {place}", variant=UNEVEN)
