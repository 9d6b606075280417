"""model.yaml: the fitted model as a file, its version, its JSON schema; the one place that writes and reads them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, Field, WithJsonSchema

from armscope.core.files import write_yaml
from armscope.core.inputs import InputError, nearest, read_yaml, validate
from armscope.physics.effect import Direction, Driver, Effect, Placed, Product, Term
from armscope.physics.frames import BASE_FRAME, TOOL_FRAME
from armscope.physics.geometric import BACKGROUND
from armscope.physics.model import Base, FittedModel
from armscope.physics.registry import effects
from armscope.physics.scene import Part
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription

Format = Literal["armscope model 1"]
FORMAT: Format = "armscope model 1"
Vector = tuple[float, float, float]
Rotation = tuple[Vector, Vector, Vector]
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


class BaseFile(BaseModel):
    """Measurement frame from base frame: measured = rotation @ tool + translation."""

    rotation: Rotation
    translation_m: Vector


class ScannedFile(BaseModel):
    """A number that was found by trying values: waves per turn, the moment of a jump."""

    name: str
    unit: str
    value: int | float


class TermFile(BaseModel):
    """A linear parameter: its value in SI units, SI units per file unit, and what one SI unit of it does."""

    name: str
    unit: str
    si: float
    value: float
    products: tuple[ProductFile, ...]


class PartFile(BaseModel):
    """An effect at its place."""

    effect: str
    location: str
    driver: str
    scanned: tuple[ScannedFile, ...]
    reading: Literal["plain", "sine", "curve"]
    variant: str
    terms: tuple[TermFile, ...]


class ToolTurnFile(BaseModel):
    """The arm's last frame from a measured tool frame; ``run`` null: in every run."""

    target: str
    run: str | None
    rotation: Rotation


class ModelFile(BaseModel):
    """The content of model.yaml; the attributes of `armscope.physics.model.FittedModel`."""

    format: Format
    robot: RobotDescription
    bases: dict[str, BaseFile]
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
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        found = content.get("format", "no key format") if isinstance(content, dict) else "no mapping"
        raise InputError(
            path, "format", found, f"a model file says `format: {FORMAT}`", "`armscope diagnose` writes one."
        )
    file = validate(ModelFile, content, path)
    return FittedModel(
        arm=build_arm(file.robot),
        bases={run: Base(np.array(base.rotation), np.array(base.translation_m)) for run, base in file.bases.items()},
        tools=tuple(_part_in(part, path) for part in file.tools),
        parts=tuple(_part_in(part, path) for part in file.effects),
        background=tuple(_part_in(part, path) for part in file.background),
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


def _part_in(file: PartFile, path: Path | str) -> Part:
    terms = tuple(
        Term(
            term.name,
            term.unit,
            term.si,
            tuple(Product(Direction(p[0], p[1]), _driver_in(p[3:]), float(p[2])) for p in term.products),
        )
        for term in file.terms
    )
    known = _definitions()
    if file.effect not in known:
        raise InputError(path, "effect", file.effect, "this effect is not known here", nearest(file.effect, known))
    placed = Placed(
        known[file.effect],
        file.location,
        terms,
        (1.0,) * len(terms),
        file.driver,
        tuple((each.name, each.unit, float(each.value)) for each in file.scanned),
        variant=file.variant,
        parametrisation=file.reading,
    )
    return Part(placed, np.array([term.value for term in file.terms]))


def _driver_out(driver: Driver) -> list[Any]:
    return [driver.kind, *[_driver_out(a) if isinstance(a, Driver) else a for a in driver.arguments]]


def _driver_in(content: Iterable[Any]) -> Driver:
    kind, *arguments = content
    return Driver(kind, tuple(_driver_in(a) if isinstance(a, list) else a for a in arguments))


def _definitions() -> Mapping[str, Effect]:
    return {effect.name: effect for effect in (BASE_FRAME, TOOL_FRAME, BACKGROUND, *effects())}
