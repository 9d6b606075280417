"""model.yaml: the fitted model as a file, its version, its JSON schema; the one place that writes and reads them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field, WithJsonSchema

from armscope.core.files import write_yaml
from armscope.core.inputs import InputError, Strict, format_of, read_yaml, validate
from armscope.physics.effect import Driver, Part
from armscope.physics.model import Base, FittedModel
from armscope.physics.model_check import Reader
from armscope.robot.arm import build_arm
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


class ModelFile(Strict):
    """The content of model.yaml; the attributes of `armscope.physics.model.FittedModel`.

    Attributes:
        format: the file's kind and version.
        robot: the nominal arm.
        bases: the measurement frame by run.
        tools: tool points by target, as offsets of the stated one.
        tool_turns: how measured tool frames are turned, where orientations were measured.
        effects: what was found.
        background: small errors everywhere, which have no name.
    """

    format: Format
    robot: RobotDescription
    bases: dict[Name, BaseFile]
    tools: tuple[PartFile, ...]
    tool_turns: tuple[ToolTurnFile, ...] = ()
    effects: tuple[PartFile, ...]
    background: tuple[PartFile, ...]


def schema() -> dict[str, Any]:
    """The JSON schema of model.yaml."""
    return ModelFile.model_json_schema(mode="serialization")


def save_model(path: Path | str, model: FittedModel) -> None:
    """Write model.yaml; the robot's description is part of it (a URDF by its path)."""
    file = ModelFile(
        format=FORMAT,
        robot=model.arm.description,
        bases={
            run: BaseFile(rotation=base.rotation.tolist(), translation_m=base.translation.tolist())
            for run, base in model.bases.items()
        },
        tools=tuple(_part_out(part) for part in model.tools),
        tool_turns=tuple(
            ToolTurnFile(target=target, run=run, rotation=turn.tolist())
            for (target, run), turn in model.tool_turns.items()
        ),
        effects=tuple(_part_out(part) for part in model.parts),
        background=tuple(_part_out(part) for part in model.background),
    )
    # the description leaves out what it does not state; elsewhere nothing is a value
    robot = model.arm.description.model_dump(mode="json", exclude_none=True)
    write_yaml(path, {**file.model_dump(mode="json"), "robot": robot})


def load_model(path: Path | str) -> FittedModel:
    """Read model.yaml.

    Raises:
        InputError: it is no model of this format.
    """
    content = read_yaml(path)
    if (found := format_of(content)) != FORMAT:
        cure = "`armscope diagnose` writes one."
        if "motion" in str(found):
            cure = "It is of an arm in motion: `armscope predict` gives the torques of a table of motions by it."
        raise InputError(path, "format", found, f"a model file says `format: {FORMAT}`", cure)
    file = validate(ModelFile, content, path)
    reader = Reader(arm := build_arm(file.robot), path)
    return FittedModel(
        arm=arm,
        bases={run: Base(np.array(base.rotation), np.array(base.translation_m)) for run, base in file.bases.items()},
        tools=reader.parts(file.tools, "tools"),
        parts=reader.parts(file.effects, "effects"),
        background=reader.parts(file.background, "background"),
        tool_turns={(turn.target, turn.run): np.array(turn.rotation) for turn in file.tool_turns},
    )


def _part_out(part: Part) -> PartFile:
    placed = part.placed
    return PartFile(
        effect=placed.name,
        location=placed.location,
        driver=placed.driver,
        scanned=tuple(ScannedFile(name=name, unit=unit, value=value) for name, unit, value in placed.scanned),
        reading=placed.parametrisation,
        variant=placed.variant,
        terms=tuple(
            TermFile(
                name=term.name,
                unit=term.unit,
                si=term.si,
                value=float(value),
                products=tuple(
                    [p.direction.location, p.direction.axis, p.factor, *_driver_out(p.driver)] for p in term.products
                ),
            )
            for term, value in zip(placed.terms, part.values, strict=True)
        ),
    )


def _driver_out(driver: Driver) -> list[Any]:
    return [driver.kind, *[_driver_out(a) if isinstance(a, Driver) else a for a in driver.arguments]]
