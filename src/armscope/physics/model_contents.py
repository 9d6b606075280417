"""What stands in model.yaml: its keys, their types and bounds, its version."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field, WithJsonSchema

from armscope.core.inputs import Strict
from armscope.robot.description import RobotDescription

Format = Literal["armscope model 1"]
FORMAT: Format = "armscope model 1"
NOT_A_TURN = 1e-6
"""By which the rows of a rotation may fail to be orthonormal: more than rounding, less than any error that matters."""
LARGEST_VALUE = 1e6
"""Of any parameter, SI: none of an arm's comes near it, and squares of larger ones overflow."""
FARTHEST_M = 1e5


def _turn(rows: tuple[Any, ...]) -> tuple[Any, ...]:
    turn = np.array(rows, dtype=float)
    if np.abs(turn @ turn.T - np.eye(3)).max() > NOT_A_TURN or np.linalg.det(turn) < 0:
        raise ValueError("a rotation has three orthogonal rows of length 1 that form a right-handed frame")
    return rows


Word = Annotated[str, Field(max_length=500)]
Name = Annotated[Word, BeforeValidator(lambda value: str(value) if isinstance(value, int) else value)]
Metres = Annotated[float, Field(ge=-FARTHEST_M, le=FARTHEST_M)]
Vector = tuple[Metres, Metres, Metres]
Component = Annotated[float, Field(ge=-2, le=2)]
Row = tuple[Component, Component, Component]
Rotation = Annotated[tuple[Row, Row, Row], AfterValidator(_turn)]
ProductFile = Annotated[
    list[Any],
    Field(min_length=4),
    WithJsonSchema(
        {
            "type": "array",
            "description": "frame, axis, factor, kind of driver, its arguments (a driver again, nested, or numbers)",
            "prefixItems": [{"type": "string"}, {"type": "string"}, {"type": "number"}, {"type": "string"}],
            "minItems": 4,
        }
    ),
]


class BaseFile(Strict):
    """Measurement frame from base frame: measured = rotation @ tool + translation.

    Attributes:
        rotation: its rows.
        translation_m: from the measurement frame's origin to the base, in its axes.
    """

    rotation: Rotation
    translation_m: Vector


class ScannedFile(Strict):
    """A number that was found by trying values: waves per turn, the moment of a jump.

    Attributes:
        name: as its effect calls it.
        unit: of the value; empty for a pure number.
        value: as found.
    """

    name: Word
    unit: Word
    value: int | float


class TermFile(Strict):
    """A linear parameter.

    Attributes:
        name: as its effect calls it.
        unit: in which a verdict tells it.
        si: SI units per such unit.
        value: as fitted, in SI units.
        products: what one SI unit of it does, added up.
    """

    name: Word
    unit: Word
    si: Annotated[float, Field(gt=0, le=1e12)]
    value: Annotated[float, Field(ge=-LARGEST_VALUE, le=LARGEST_VALUE)]
    products: tuple[ProductFile, ...]


class PartFile(Strict):
    """An effect at its place.

    Attributes:
        effect: its name.
        location: where it is.
        driver: what it follows, in words.
        scanned: its numbers that were found by trying values.
        reading: how its values are told: as they are, (sine, cosine) pairs as a wave, or as a free curve.
        variant: which of several forms of the effect at this place it is.
        terms: its linear parameters.
    """

    effect: Word
    location: Word
    driver: Word
    scanned: tuple[ScannedFile, ...]
    reading: Literal["plain", "sine", "curve"]
    variant: Name
    terms: tuple[TermFile, ...]


class ToolTurnFile(Strict):
    """The arm's last frame from a measured tool frame.

    Attributes:
        target: whose orientation was measured.
        run: in which it holds; null: in every run.
        rotation: its rows.
    """

    target: Name
    run: Name | None
    rotation: Rotation


class AsStatedFile(Strict):
    """A tool point that is as stated, since the recordings do not tell it from the base.

    Attributes:
        tool: along which of its axes.
        base: along which axes the base takes what the tool would have.
    """

    tool: Word
    base: Word


class ModelFile(Strict):
    """The content of model.yaml; the attributes of `armscope.physics.model.FittedModel`.

    Attributes:
        format: the file's kind and version.
        robot: the nominal arm.
        bases: the measurement frame by run.
        tools: tool points by target, as offsets of the stated one.
        tool_turns: how measured tool frames are turned, where orientations were measured.
        undetermined: tool points that are as stated, since the recordings do not tell them from the base.
        effects: what was found.
        background: small errors everywhere, which have no name.
    """

    format: Format
    robot: RobotDescription
    bases: dict[Name, BaseFile]
    tools: tuple[PartFile, ...]
    tool_turns: tuple[ToolTurnFile, ...] = ()
    undetermined: tuple[AsStatedFile, ...] = ()
    effects: tuple[PartFile, ...]
    background: tuple[PartFile, ...]
