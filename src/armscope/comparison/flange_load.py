"""A load at the flange that changed between recordings: all drives turn by it at once, each as it gives way."""

from __future__ import annotations

from dataclasses import replace

from armscope.core.averages import rms
from armscope.physics.effect import Cure, Driver, Placed, Product, motor, term
from armscope.physics.elastic import loaded_joints
from armscope.physics.payload import PAYLOAD_ERROR
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm

ANOTHER_LOAD = replace(
    PAYLOAD_ERROR,
    name="load",
    physics="Another load at the flange (a gripper, a workpiece, a cable) turns all drives at once, as each gives way.",
    cure=Cure(
        "Carry the same load in all recordings, or state payload_kg in each, and compare again: a drive that became "
        "softer at the same time counts to the load.",
        change=PAYLOAD_ERROR.cure.change,
        instruction="Weigh what hangs at the flange; if it is to stay, correct the payload's data in the controller.",
    ),
)


def load_at_the_flange(arm: Arm, table: Recordings) -> Placed | None:
    """Another mass at the flange, told by how far it turns each drive, RMS over all poses.

    The mass by itself would need the drives' compliances, which recordings of one load seldom tell; which of them
    turns how, at which pose, needs neither.

    Returns:
        One effect of a number per drive; None where loads were recorded as torques, or masses are not stated.
    """
    if table.torque is not None or not arm.has_masses:
        return None
    scene = Scene(arm, replace(table, payload=None))
    heavier = {j: Driver("heavier", (Driver("torque", (j,)),)) for j in loaded_joints(scene)}
    sizes = {j: rms(scene.driver(load)) for j, load in heavier.items()}
    drives = tuple(
        term(f"turn_of_joint_{j}", "rad", Product(motor(j), load, 1 / sizes[j]))
        for j, load in heavier.items()
        if sizes[j] > 0
    )
    return Placed(ANOTHER_LOAD, "flange", drives, (1.0,) * len(drives), "payload") if drives else None
