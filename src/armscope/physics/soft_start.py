"""Drives that are softer under small loads than under large ones: what every strain-wave gear has a little of.

Makers state the wind-up in sections: a stiffness K1 up to the torque T1, some tenth of the rated one, and a larger one
beyond. Beside a spring of the larger stiffness stands a turn that is complete soon after T1: odd in the load, and
tanh(torque / knee) within what such sections say. It looks like play, which closes at once.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import Driver, Effect, Placed, motor, term
from armscope.physics.elastic import JOINT_COMPLIANCE, loaded_joints
from armscope.physics.scene import Scene
from armscope.physics.transmission import is_pulled_both_ways
from armscope.recordings import Recordings
from armscope.robot import Arm

SOFT_START = "soft start"
"""The variant of a joint's compliance that is complete under small loads; a name only where it stands out of all."""


def hardening(largest_nm: float) -> Effect:
    """The same effect, with a rule of its own by which it is commanded away.

    Args:
        largest_nm: the joint's largest load in the recordings, N m; that it hardens at a share of it is assumed.

    Returns:
        The effect, whose words print that load: without it nobody could compute the rule.
    """
    turned = f"tanh({1 / PLAUSIBLE.knee_share:g} x load / {largest_nm:.4g} N m)"
    cure = JOINT_COMPLIANCE.cure
    rule = (
        f"or compensate for it in the command: commanded = wanted - soft_turn x {turned} (load: gravity's torque on "
        f"this motor, positive along its pull; {largest_nm:.4g} N m: the largest in these recordings; where it hardens "
        "is assumed)."
    )
    instruction = cure.instruction.replace("{size}", f" (minus {{soft_turn}} × {turned.replace(' x ', ' × ')})")
    return replace(JOINT_COMPLIANCE, cure=replace(cure, otherwise=rule, instruction=instruction))


def soft_starts(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    """The soft start of every motor that gravity loads from both sides; from one side it is a constant, or hardly more.

    Args:
        arm: the arm.
        recordings: the rows, with torques where the masses are not stated.

    Yields:
        One per motor, rad.
    """
    if not arm.has_masses and recordings.torque is None:
        return
    scene = Scene(arm, recordings)
    size = PLAUSIBLE.soft_share * PLAUSIBLE.drive_rad
    for j in loaded_joints(scene):
        if is_pulled_both_ways(scene, j):
            largest = float(np.abs(scene.torques[:, j - 1]).max())
            load = Driver("soft start", (j, PLAUSIBLE.knee_share * largest))
            turn = term("soft_turn", "rad", (motor(j), load), plausible=size)
            driver = f"load of joint {j}, while it is small"
            yield Placed(hardening(largest), f"joint {j}", (turn,), (1.0,), driver, variant=SOFT_START)
