"""How an effect is taken out, once, with its sign: the words of a card and the same formula as code.

Signs: actual = commanded + what the effect adds, so a cure is its opposite: commanded = wanted - offset -
compliance x load, a load being positive along gravity's pull. What no motor can undo (a tilt across an axis, a bend, a
base that moved) is cured in the model: the inverse kinematics of the corrected model reaches the wanted point.
"""

from __future__ import annotations

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.physics.effect import Cure, Part
from armscope.physics.loaded_arm import LoadedArm

INSTRUCTION_WORDS = (
    "location", "zero", "ratio", "size", "soft_turn", "coefficient", "jump", "row", "correction", "bars",
)  # fmt: skip
"""What the instruction of a work order may name (`armscope.verdict.tasks`)."""


def from_commands(scene: LoadedArm, part: Part) -> Array:
    """(N, m) motor angles to command so that a part leaves nothing at the scene's wanted angles, rad; first order."""
    angles = scene.recordings.motor_angles.copy()
    for value, term in zip(part.values, part.placed.terms, strict=True):
        for product in term.products:
            motor = Location.of(product.direction.location)
            if motor.kind == "motor":
                angles[:, motor.index] -= value * product.factor * scene.driver(product.driver)
    return angles


def command(mend: str, change: str = "", instruction: str = "", otherwise: str = "", needs: str = "") -> Cure:
    """A cure by other commands: the motors' angles less what the effect adds to them.

    Args:
        mend: as in `Cure`.
        change: as in `Cure`.
        instruction: as in `Cure`.
        otherwise: as in `Cure`.
        needs: as in `Cure`.

    Returns:
        The cure.
    """
    return Cure(mend, otherwise=otherwise, commanded=from_commands, change=change, instruction=instruction, needs=needs)
