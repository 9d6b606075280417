"""What poses were refused by, in words: what the body was taken for, and which links have less room than they need."""

from __future__ import annotations

from armscope.poses.obstacles import Surroundings, thinned
from armscope.robot import Arm


def body_in_words(arm: Arm, around: Surroundings) -> str:
    """What the arm's body is taken to be."""
    radius = f"{around.radius_of(arm) * 1e3:.0f} mm radius"
    shapes = around.shapes_of(arm)
    if shapes:
        return (
            f"{len(shapes)} collision shapes of the URDF as capsules; links without one, and what lies between the "
            f"last shape and the tool point, as capsules of {radius}"
        )
    return f"links as capsules of {radius} around the lines between their joints"


def body_notes(arm: Arm, around: Surroundings) -> list[str]:
    """What a command says beside poses or a motion: what the body is taken for, and what was not checked."""
    notes = [f"the arm's body: {body_in_words(arm, around)}; links that share a joint are not checked"]
    notes += [
        f"thicker than half the gap that there ever is between them, and checked less: {each}"
        for each in thinned(arm, around)
    ]
    return notes


def surroundings_notes(arm: Arm, around: Surroundings) -> list[str]:
    """The same, and what was not looked at for want of an option."""
    notes = body_notes(arm, around)
    notes += ["no --tracker: every pose counts as visible"] if around.tracker is None else []
    notes += ["no --floor-mm: the arm may reach below its base"] if around.floor is None else []
    return notes
