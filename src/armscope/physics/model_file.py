"""model.yaml: the fitted model as a file, and its JSON schema; the one place that writes and reads them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from armscope.core.files import write_yaml
from armscope.core.inputs import InputError, format_of, read_yaml, validate
from armscope.physics.effect import Driver, Part
from armscope.physics.model import AsStated, Base, FittedModel
from armscope.physics.model_check import Reader
from armscope.physics.model_contents import (
    FORMAT,
    AsStatedFile,
    BaseFile,
    ModelFile,
    PartFile,
    ScannedFile,
    TermFile,
    ToolTurnFile,
)
from armscope.robot.arm import build_arm


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
        undetermined=tuple(AsStatedFile(tool=each.tool, base=each.base) for each in model.undetermined),
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
        undetermined=tuple(AsStated(each.tool, each.base) for each in file.undetermined),
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
