"""What every real arm has a little of: small errors everywhere, family by family, allowed for but not named."""

from __future__ import annotations

from armscope.physics import elastic, geometric, transmission
from armscope.physics.effect import Placed
from armscope.recordings import Recordings
from armscope.robot import Arm

FAMILIES = ("geometric", "elastic", "transmission")
"""Geometric errors are measured against the makers' tolerance, the others by what they do at the tool."""


def backgrounds(arm: Arm, recordings: Recordings) -> dict[str, list[Placed]]:
    """By family: D-H constants of all links, give of all joints and bearings, two waves per turn of all gears."""
    give = [
        placed
        for effect in (elastic.JOINT_COMPLIANCE, elastic.BEARING_COMPLIANCE)
        for placed in effect.place(arm, recordings)
        if placed.variant == ""
    ]
    return {
        "geometric": geometric.background(arm),
        "elastic": give,
        "transmission": list(transmission.GEAR_ECCENTRICITY.place(arm, recordings)),
    }
