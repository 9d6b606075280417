"""Another load at the flange, which looks like drives of another stiffness or play: nobody may have written it down."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.comparison.flange_load import ANOTHER_LOAD
from armscope.comparison.result import Change
from armscope.comparison.valued import Valued
from armscope.core.types import Array
from armscope.physics.registry import effect_named
from armscope.robot import Arm, chain
from armscope.robot.gravity import gravity_torques
from armscope.verdict.effects import INDISTINGUISHABLE_NATS, INTERVAL

LOOKS_LIKE_PLAY = ("backlash", "load")
"""Of a joint that gravity loads from either side: by side alone, where what gives way goes with the load itself."""


def follows_loads(effect: str, variant: str) -> bool:
    """Whether a change of an effect goes with what gravity does to the arm, so that another load would show as it.

    Play on the side from which the joint came does not: no load knows that.
    """
    known = effect_named(effect)
    return (effect, variant) == LOOKS_LIKE_PLAY or (known is not None and known.family == "elastic")


def other_load(arm: Arm, angles: Array, changes: Sequence[Change], worse_by: float | None = None) -> str:
    """That a changed load at the flange would look like some of the changes, and how large it would have to be.

    Args:
        arm: the nominal arm.
        angles: (N, m) of all recordings, rad.
        changes: what was found.
        worse_by: evidence, nats, by which another load in their place explains less; None where it was not asked.

    Returns:
        A sentence; "" where no change follows loads.
    """
    if any(each.effect == ANOTHER_LOAD.name for each in changes):
        return (
            "One load at the flange turns all drives like this at once: was another gripper, workpiece or cable on it? "
            "Then the drives need not have changed."
        )
    alike = [each for each in changes if follows_loads(each.effect, each.variant)]
    if not alike:
        return ""
    if worse_by is not None and worse_by > INDISTINGUISHABLE_NATS:
        return "Another load at the flange alone would not look like it."
    mass = _mass(arm, angles, alike)
    size = "" if mass is None else f", by about {mass:+.1f} kg".replace("-", "−")
    what = {True: "None of it need have", False: "The rest stands, but that need not have"}[len(alike) == len(changes)]
    whose = "" if len(alike) == len(changes) else f" ({'; '.join(each.title for each in alike)})"
    return (
        f"{what} changed in the arm{whose}: another load at the flange{size} (a gripper, a workpiece, a cable) can "
        "look the same. Was it the same in all recordings? If not, record payload_kg and compare again."
    )


def _mass(arm: Arm, angles: Array, changes: Sequence[Change]) -> float | None:
    """kg that turn the drives as their changed compliances do; None where these are not known in all recordings."""
    known = [(int(each.location.rpartition(" ")[2]) - 1, n) for each in changes if (n := _compliance(each)) is not None]
    if not known or not arm.has_masses:
        return None
    frames = chain(arm, angles)
    now = gravity_torques(arm, frames)
    by_a_kilogram = gravity_torques(arm, frames, np.ones(len(angles))) - now
    turned = np.concatenate([number.difference * now[:, joint] for joint, number in known])
    turns = np.concatenate([number.values[0] * by_a_kilogram[:, joint] for joint, number in known])
    return float(turned @ turns / (turns @ turns))


def _compliance(change: Change) -> Valued | None:
    """How a joint gives way, where its size in the first recording stands out of its uncertainty."""
    number = next((each for each in change.parameters if each.name == "compliance"), None)
    joint = change.effect == "joint_compliance"
    return number if joint and number and number.values[0] > 2 * INTERVAL * number.stderrs[0] else None
