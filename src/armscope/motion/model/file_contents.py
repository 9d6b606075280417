"""What stands in model.yaml of an arm in motion: its keys, their types and bounds, its version."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from armscope.core.inputs import Strict
from armscope.motion.model.constants import MODEL_FILE
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import InertialName

Format = Literal["armscope motion model 2"]
FORMAT: Format = "armscope motion model 2"
Word = Annotated[str, Field(max_length=500)]
Number = Annotated[float, Field(ge=-MODEL_FILE.largest, le=MODEL_FILE.largest)]
Positive = Annotated[float, Field(gt=0, le=MODEL_FILE.largest)]
JointNumber = Annotated[int, Field(ge=1, le=1000)]


class PreparationFile(Strict):
    """How samples became rows."""

    rate_hz: Positive
    cutoff_hz: Positive
    position_cutoff_hz: Positive
    every: Annotated[int, Field(ge=1, le=1_000_000)]
    cutoff_source: Word


class JointFile(Strict):
    """Friction and rotor of one motor, SI: torque = offset + coulomb side(dq) + viscous dq + inertia ddq.

    ``blunter``, ``rounder``, ``later``: over which speed (N m) and time (N m s^2) friction changes sides, and when (N m
    s); ``gain``: share by which recorded torque is too large; ``width``: speed within which friction changes sides,
    rad/s (m/s), where the motion says so; ``order``: of the low-pass by which it does so late, 0 where it is shifted;
    ``least``, ``most``: positions of the motion that was fitted, rad (m): turning joints are taken in that turn.
    """

    joint: Word
    offset: Number
    coulomb: Number
    viscous: Number
    inertia: Number
    blunter: Number = 0.0
    rounder: Number
    later: Number
    gain: Number
    width: Positive | None = None
    order: Annotated[int, Field(ge=0, le=2)] = 0
    least: Number | None = None
    most: Number | None = None


class LinkFile(Strict):
    """Inertial parameters of a link about its joint's frame: kg, kg m, kg m^2."""

    link: Word
    m: Number
    mx: Number
    my: Number
    mz: Number
    Ixx: Number
    Ixy: Number
    Iyy: Number
    Ixz: Number
    Iyz: Number
    Izz: Number


class ParameterFile(Strict):
    """A number of a cause with its standard error; null where the motion does not tell it."""

    name: Word
    unit: Word
    value: Number
    stderr: Number | None


class ScannedFile(Strict):
    """A number that was found by trying values."""

    name: Word
    unit: Word
    value: Number


class InertialFile(Strict):
    """By how much one unit of the cause's parameter (from 1) changes an inertial parameter of a link (from 1)."""

    parameter: JointNumber
    link: JointNumber
    what: InertialName
    per_unit: Number


class LawFile(Strict):
    """A law of torque: its kind, the motors (from 1) whose torque it is, its numbers."""

    kind: Word
    joints: tuple[JointNumber, ...]
    numbers: tuple[Number, ...]


class CauseFile(Strict):
    """A cause at its place: by a law, by inertial parameters, or, with neither, part of its joint's numbers above."""

    effect: Word
    location: Word
    driver: Word
    variant: Word
    runs: tuple[Word, ...]
    parameters: Annotated[tuple[ParameterFile, ...], Field(min_length=1, max_length=100)]
    scanned: tuple[ScannedFile, ...]
    law: LawFile | None
    inertial: tuple[InertialFile, ...]


class MotionModelFile(Strict):
    """The content of model.yaml; the attributes of `armscope.motion.model.fitted.MotionModel`."""

    format: Format
    robot: RobotDescription
    recorded: Literal["torque", "current"]
    preparation: PreparationFile
    joints: tuple[JointFile, ...]
    links: tuple[LinkFile, ...]
    causes: tuple[CauseFile, ...]
    response_s2: Number = 0.0
    twists: tuple[CauseFile, ...] = ()
