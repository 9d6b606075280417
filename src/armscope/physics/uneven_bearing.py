"""Bearings that are softer about one axis than about the other: what every arm has a little of, allowed for, not named.

A tilting bearing gives way by a symmetric 2 x 2 compliance about its x and y. Its mean is the bearing compliance that
may have a name; here are the two values that are left: half the difference, and what is across.
"""

from __future__ import annotations

from collections.abc import Iterator

from armscope.physics.effect import Direction, Driver, Placed, Product, term
from armscope.physics.scene import Scene
from armscope.physics.tilting import BEARING_COMPLIANCE, tilt_per_moment, tilting_joints
from armscope.recordings import Recordings
from armscope.robot import Arm

UNEVEN_BEARING = "uneven"
"""The variant of a bearing's compliance that says by how much it is not the same about x and y."""


def uneven_bearings(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    """By how much each bearing is softer about one axis of its joint than about the other.

    Args:
        arm: with masses; otherwise there are none.
        recordings: the rows.

    Yields:
        One per joint whose load varies, two values in rad/(N m): the compliance about x is the mean and the
        difference, about y the mean less the difference.
    """
    if not arm.has_masses:
        return
    scene = Scene(arm, recordings)
    for place in tilting_joints(scene):
        about_x, about_y = (Direction(place, axis) for axis in ("rx", "ry"))
        under_x, under_y = (Driver("moment", (place, n)) for n in (0, 1))
        apart = (Product(about_x, under_x), Product(about_y, under_y, -1.0))
        size = tilt_per_moment(scene, place)
        terms = (
            term("difference", "rad/(N m)", *apart, plausible=size),
            term("across", "rad/(N m)", (about_x, under_y), (about_y, under_x), plausible=size),
        )
        yield Placed(BEARING_COMPLIANCE, place, terms, (1.0, 1.0), f"moment across {place}", variant=UNEVEN_BEARING)
