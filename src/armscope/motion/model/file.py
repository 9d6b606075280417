"""model.yaml of an arm in motion, and its JSON schema; the one place that writes and reads it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from armscope.core.files import write_yaml
from armscope.core.inputs import InputError, format_of, read_yaml, validate
from armscope.core.types import Array
from armscope.motion.library.laws import Law
from armscope.motion.library.layout import OWN_NAMES
from armscope.motion.library.sides import sharp_width
from armscope.motion.model.constants import MODEL_FILE
from armscope.motion.model.file_check import CauseReader
from armscope.motion.model.file_contents import (
    FORMAT,
    CauseFile,
    InertialFile,
    JointFile,
    LawFile,
    LinkFile,
    MotionModelFile,
    ParameterFile,
    PreparationFile,
    ScannedFile,
)
from armscope.motion.model.fitted import MotionModel
from armscope.motion.model.fitted_cause import FittedCause
from armscope.motion.samples.preparation import Preparation
from armscope.robot.dynamics import PARAMETERS, MovingArm, build_moving_arm


def schema() -> dict[str, Any]:
    """The JSON schema of model.yaml of a motion."""
    return MotionModelFile.model_json_schema(mode="serialization")


def save_motion_model(path: Path | str, model: MotionModel) -> None:
    """Write model.yaml; the robot's description is part of it (a URDF by its path)."""
    how = model.how
    file = MotionModelFile(
        format=FORMAT,
        robot=model.arm.description,
        recorded=model.kind,
        preparation=PreparationFile(
            rate_hz=how.rate,
            cutoff_hz=how.cutoff,
            position_cutoff_hz=how.position_cutoff,
            every=how.every,
            cutoff_source=how.cutoff_source,
        ),
        joints=tuple(
            JointFile(
                joint=f"joint {j + 1}",
                **dict(zip(OWN_NAMES, map(float, own), strict=True)),
                gain=float(gain),
                width=width,
                order=0 if model.order_of_sides is None else int(model.order_of_sides[j]),
                **_range_of(model, j),
            )
            for j, (own, gain, width) in enumerate(zip(model.joints, model.gains, _widths(model), strict=True))
        ),
        links=tuple(
            LinkFile(link=f"link {n + 1}", **dict(zip(PARAMETERS, map(float, values), strict=True)))
            for n, values in enumerate(model.inertial.reshape(-1, len(PARAMETERS)))
        ),
        causes=tuple(cause_out(cause) for cause in model.causes),
        response_s2=model.response,
        twists=tuple(cause_out(cause) for cause in model.links),
    )
    robot = model.arm.description.model_dump(mode="json", exclude_none=True)
    write_yaml(path, {**file.model_dump(mode="json"), "robot": robot})


def _range_of(model: MotionModel, joint: int) -> dict[str, float]:
    """Least and largest position of a joint, where they are known."""
    return {} if model.positions is None else dict(zip(("least", "most"), model.positions[joint].tolist(), strict=True))


def _widths(model: MotionModel) -> list[float] | list[None]:
    """Speed within which each joint's friction changes sides; None where it does so as sharply as fits take it to."""
    return [None] * len(model.joints) if model.width_of_sides is None else model.width_of_sides.tolist()


def cause_out(cause: FittedCause) -> CauseFile:
    """A cause as the file holds it."""
    placed, law = cause.placed, cause.placed.columns
    assert law is None or isinstance(law, Law)
    return CauseFile(
        effect=placed.cause.name,
        location=placed.location,
        driver=placed.driver,
        variant=placed.variant,
        runs=placed.runs,
        parameters=tuple(
            ParameterFile(name=name, unit=unit, value=float(value), stderr=_told(float(error)))
            for (name, unit), value, error in zip(placed.parameters, cause.values, cause.stderr, strict=True)
        ),
        scanned=tuple(ScannedFile(name=name, unit=unit, value=value) for name, unit, value in placed.scanned),
        law=None if law is None else LawFile(kind=law.kind, joints=[j + 1 for j in law.joints], numbers=law.numbers),
        inertial=() if placed.inertial is None else tuple(_inertial_out(placed.inertial)),
    )


def _told(error: float) -> float | None:
    """A standard error; none where the motion does not tell the number at all."""
    return error if error <= MODEL_FILE.largest else None


def _inertial_out(inertial: Array) -> list[InertialFile]:
    return [
        InertialFile(
            parameter=int(column) + 1,
            link=int(row) // len(PARAMETERS) + 1,
            what=PARAMETERS[int(row) % len(PARAMETERS)],
            per_unit=float(inertial[row, column]),
        )
        for column, row in np.argwhere(inertial.T != 0)
    ]


def is_motion_model(content: Any) -> bool:
    """Whether the content of a YAML file is a model of a motion, of whichever version."""
    return isinstance(content, dict) and str(content.get("format")).rpartition(" ")[0] == FORMAT.rpartition(" ")[0]


def load_motion_model(path: Path | str) -> MotionModel:
    """Read model.yaml of a motion.

    Raises:
        InputError: it is no model of this format, or says what its arm can't have.
    """
    content = read_yaml(path)
    if not is_motion_model(content) or content["format"] != FORMAT:
        found = format_of(content)
        rule = f"a model of a motion says `format: {FORMAT}`"
        raise InputError(path, "format", found, rule, "`armscope diagnose motions.csv` of today writes one.")
    file = validate(MotionModelFile, content, path)
    arm = build_moving_arm(file.robot, path)
    for place, count, wanted in (("joints", len(file.joints), arm.n_motors), ("links", len(file.links), arm.n_links)):
        if count != wanted:
            raise InputError(path, place, f"{count} {place}", f"the model's arm has {wanted}")
    how = file.preparation
    own = [[getattr(joint, name) for name in OWN_NAMES] for joint in file.joints]
    return MotionModel(
        arm=arm,
        how=Preparation(how.rate_hz, how.cutoff_hz, how.position_cutoff_hz, how.every, how.cutoff_source),
        kind=file.recorded,
        joints=np.array(own, dtype=float),
        inertial=np.array([[getattr(link, name) for name in PARAMETERS] for link in file.links], dtype=float).ravel(),
        gains=np.array([joint.gain for joint in file.joints], dtype=float),
        causes=CauseReader(arm, path).causes(file.causes),
        response=file.response_s2,
        links=CauseReader(arm, path).causes(file.twists, "twists"),
        width_of_sides=_width_of_sides(file, arm),
        order_of_sides=np.array([joint.order for joint in file.joints], dtype=np.intp),
        positions=_positions(file),
    )


def _width_of_sides(file: MotionModelFile, arm: MovingArm) -> Array | None:
    """(m,) as the file has it; None where it has none of any joint."""
    told = [joint.width for joint in file.joints]
    if all(width is None for width in told):
        return None
    return np.array([own if width is None else width for width, own in zip(told, sharp_width(arm), strict=True)])


def _positions(file: MotionModelFile) -> Array | None:
    """(m, 2) least and largest of each joint; None where the file lacks one."""
    told = [(joint.least, joint.most) for joint in file.joints]
    return None if any(None in each for each in told) else np.array(told, dtype=float)
