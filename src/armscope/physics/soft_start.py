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
from armscope.physics.effect import Driver, Placed, motor, term
from armscope.physics.elastic import JOINT_COMPLIANCE, loaded_joints
from armscope.physics.scene import Scene
from armscope.physics.transmission import is_pulled_both_ways
from armscope.recordings import Recordings
from armscope.robot import Arm

SOFT_START = "soft start"
"""The variant of a joint's compliance that is complete under small loads; a name only where it stands out of all."""

TURNED = f"tanh({1 / PLAUSIBLE.knee_share:g} x load / largest load in these recordings)"
"""The share of its soft turn by which a drive is turned; that it hardens at a share of the largest load is assumed."""
HARDENING = replace(
    JOINT_COMPLIANCE,
    cure=replace(
        JOINT_COMPLIANCE.cure,
        otherwise=f"or compensate for it in the command: commanded = wanted - soft_turn x {TURNED} (load: gravity's "
        "torque on this motor, positive along its pull; where it hardens is assumed).",
    ),
)
"""The same effect, with a rule of its own by which it is commanded away."""


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
            knee = PLAUSIBLE.knee_share * float(np.abs(scene.torques[:, j - 1]).max())
            turn = term("soft_turn", "rad", (motor(j), Driver("soft start", (j, knee))), plausible=size)
            driver = f"load of joint {j}, while it is small"
            yield Placed(HARDENING, f"joint {j}", (turn,), (1.0,), driver, variant=SOFT_START)
