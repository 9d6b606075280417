"""How an effect is taken out, once, with its sign: the words of a card and the same formula as code.

Signs: actual = commanded + what the effect adds, so a cure is its opposite: commanded = wanted - offset -
compliance x load, a load being positive along gravity's pull. What no motor can undo (a tilt across an axis, a bend, a
base that moved) is cured in the model: the inverse kinematics of the corrected model reaches the wanted point.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from armscope.core.location import Location

if TYPE_CHECKING:
    from armscope.core.types import Array
    from armscope.physics.scene import Part, Scene


def from_commands(scene: Scene, part: Part) -> Array:
    """(N, m) motor angles to command so that a part leaves nothing at the scene's wanted angles, rad; first order."""
    angles = scene.recordings.motor_angles.copy()
    for value, term in zip(part.values, part.placed.terms, strict=True):
        for product in term.products:
            motor = Location.of(product.direction.location)
            if motor.kind == "motor":
                angles[:, motor.index] -= value * product.factor * scene.driver(product.driver)
    return angles


@dataclass(frozen=True)
class Cure:
    """What to do about an effect.

    Attributes:
        mend: what to do, with the sign ("," or ";" or ".") after which `otherwise` goes on; what names a formula names
            it with its sign.
        otherwise: what else can be done, as the same sentence or the next one goes on: "or compensate for it in the
            command: ...".
        change: what is changed, in two words, for a work order.
        instruction: how, as a work order says it: a template over {location} and what is known of the effect
            (`armscope.verdict.work_order`).
        commanded: (scene at the wanted angles, fitted part) -> (N, m) angles to command, rad.
        statement: (scene, part) -> the scene with what was stated wrongly put right.
        readings: ((N, 3) readings in base axes, part) -> corrected readings.

    Where none of the three is given, the cure is the corrected model: command what its inverse kinematics asks for.
    """

    mend: str
    otherwise: str = field(default="", kw_only=True)
    change: str = field(default="", kw_only=True)
    instruction: str = field(default="", kw_only=True)
    commanded: Callable[[Scene, Part], Array] | None = None
    statement: Callable[[Scene, Part], Scene] | None = None
    readings: Callable[[Array, Part], Array] | None = None

    @property
    def words(self) -> str:
        """The whole of it, for the card."""
        return f"{self.mend} {self.otherwise}".rstrip()

    @property
    def rule(self) -> str:
        """What a work order says beside its instruction, which is the first half at length: what else can be done."""
        said = self.otherwise if self.instruction else ""
        return said[:1].upper() + said[1:] or self.words


def command(mend: str, change: str = "", instruction: str = "", otherwise: str = "") -> Cure:
    """A cure by other commands: the motors' angles less what the effect adds to them.

    Args:
        mend: as in `Cure`.
        change: as in `Cure`.
        instruction: as in `Cure`.
        otherwise: as in `Cure`.

    Returns:
        The cure.
    """
    return Cure(mend, otherwise=otherwise, commanded=from_commands, change=change, instruction=instruction)
