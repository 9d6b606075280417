"""What every real arm has a little of: small errors everywhere, family by family, allowed for but not named."""

from __future__ import annotations

from dataclasses import replace

from armscope.physics import elastic, geometric, transmission
from armscope.physics.drift import wander
from armscope.physics.effect import Placed
from armscope.physics.set_ups import SetUps
from armscope.recordings import Recordings
from armscope.robot import Arm

FAMILIES = ("geometric", "elastic", "transmission", "drift")
"""Geometric errors are measured against the makers' tolerance, the others by what they do at the tool."""
TOLERANCE = 1.0e-3
"""Geometric tolerance of an industrial arm: 1 mm and 1 mrad per D-H value."""

BEARINGS = 1 / 2
"""A joint's bearing gives less than its drive: the gear's teeth or flexible spline are the softest part of it.

That it is less is physics; a half rather than a third was settled with the iiwa's run 2016-11-18 in view.
"""


def backgrounds(arm: Arm, recordings: Recordings, set_ups: SetUps = ()) -> dict[str, list[Placed]]:
    """By family: D-H constants of all links, give of all joints and bearings, two waves per turn of all gears, wander.

    Args:
        arm: the nominal arm.
        recordings: the table.
        set_ups: runs that share a base, which stands a little elsewhere in each of them.

    Returns:
        What every real arm and set-up has a little of, by family, in the order of `FAMILIES`.
    """
    give = [placed for placed in elastic.JOINT_COMPLIANCE.place(arm, recordings) if placed.variant == ""]
    give += [
        replace(placed, prior_scale=tuple(BEARINGS * size for size in placed.prior_scale))
        for placed in elastic.BEARING_COMPLIANCE.place(arm, recordings)
    ]
    return {
        "geometric": geometric.background(arm),
        "elastic": give,
        "transmission": list(transmission.GEAR_ECCENTRICITY.place(arm, recordings)),
        "drift": wander(recordings, set_ups),
    }
