"""errormodel.json and domain.json, typed: what they may say, so that an edited or truncated file is one clear error."""

from __future__ import annotations

from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from armscope.compensation.constants import RANGE
from armscope.compensation.domain import count_directions
from armscope.core.inputs import Strict
from armscope.errormodels.features import input_names
from armscope.physics.model_contents import BaseFile, Rotation, Word
from armscope.robot.description import RobotDescription

Number = Annotated[float, Field(ge=-1e9, le=1e9)]
Positive = Annotated[float, Field(gt=0, le=1e9)]
Numbers = Annotated[tuple[Number, ...], Field(max_length=10_000)]
Names = Annotated[tuple[Word, ...], Field(min_length=1, max_length=60)]
Coefficients = tuple[tuple[Numbers, Numbers, Numbers], ...]
Three = tuple[Number, Number, Number]


class DomainContent(Strict):
    """Where a model was identified."""

    inputs: Names
    units: tuple[Literal["rad", "mm", "kg", "degC"], ...]
    rows: Annotated[int, Field(ge=1)]
    mean: Numbers
    scale: tuple[Positive, ...]
    moving: tuple[bool, ...]
    low: Numbers
    high: Numbers
    standardised_rows: tuple[Numbers, ...] = Field(min_length=1)
    allowed: Positive = RANGE.allowed

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        count = len(self.inputs)
        for name in ("units", "mean", "scale", "moving"):
            if len(getattr(self, name)) != count:
                raise ValueError(f"`{name}` needs one value for each of the {count} inputs")
        if len(set(self.inputs)) < count:
            raise ValueError("inputs differ in their names")
        if any(len(row) != count for row in self.standardised_rows):
            raise ValueError(f"each of `standardised_rows` needs one value for each of the {count} inputs")
        directions = count_directions(np.array(self.moving), self.units)
        if len(self.low) != directions or len(self.high) != directions:
            raise ValueError(f"`low` and `high` need one value for each of {directions} directions")
        if any(low > high for low, high in zip(self.low, self.high, strict=True)):
            raise ValueError("`low` is not above `high`")
        return self


class IdentifiedContent(Strict):
    """domain.json."""

    format: Literal["armscope domain 1"]
    robot: Word
    payload_kg: tuple[Number, Number] | None
    payload_left_out: bool = False
    time_s: tuple[float, float] | None
    held_out_mm: Annotated[float, Field(ge=0, le=1e9)] | None = None
    many_fit_nothing: bool = False
    torque_weights: tuple[Numbers, ...] | None
    domain: DomainContent

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        motors = [name for name in self.domain.inputs if name.startswith("q")]
        rest = self.domain.inputs[len(motors) :]
        if list(self.domain.inputs[: len(motors)]) != [f"q{k}" for k in range(1, len(motors) + 1)] or not motors:
            raise ValueError("`domain.inputs` begin with q1, q2, ...")
        if not set(rest) <= {"payload_kg", "temperature_c"}:
            raise ValueError("`domain.inputs` after the motors are payload_kg and temperature_c")
        weights = self.torque_weights
        if weights is not None and (len(weights) != len(motors) or len({len(row) for row in weights}) > 1):
            raise ValueError("`torque_weights` needs equally many numbers for each motor")
        return self


class SpecContent(Strict):
    """Which model."""

    family: Literal["polynomial", "fourier"]
    order: Annotated[int, Field(ge=1, le=12)]
    space: Literal["cartesian", "angular"]


class SumsContent(Strict):
    """Terms of one input each."""

    model: SpecContent
    inputs: Names
    moving: tuple[bool, ...]
    wavelengths_mm: tuple[Annotated[float, Field(ge=0, le=1e9)], ...] | None

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.inputs != input_names(self.model.space, len(self.inputs)):
            raise ValueError(f"the inputs are {', '.join(input_names(self.model.space, len(self.inputs)))}")
        if len(self.moving) != len(self.inputs):
            raise ValueError("`moving` needs one value for each input")
        needed = self.model.family == "fourier" and self.model.space == "cartesian"
        if needed != (self.wavelengths_mm is not None):
            raise ValueError("a Fourier series in millimetres has `wavelengths_mm`, and no other model")
        if self.wavelengths_mm is not None:
            if len(self.wavelengths_mm) != len(self.inputs):
                raise ValueError("`wavelengths_mm` needs one value for each input")
            if any(moves and wave <= 0 for moves, wave in zip(self.moving, self.wavelengths_mm, strict=True)):
                raise ValueError("an input that moves has a wavelength")
        return self


class ProductsContent(Strict):
    """Terms that multiply functions of several inputs."""

    model: SpecContent
    centre: Numbers
    half_range: tuple[Annotated[float, Field(ge=0, le=1e9)], ...]
    products: tuple[tuple[tuple[int, Literal["T", "cos", "sin"], int], ...], ...] = Field(min_length=1)

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        count = len(self.centre)
        if not 1 <= count <= 60 or len(self.half_range) != count:
            raise ValueError("`centre` and `half_range` need one value for each input")
        input_names(self.model.space, count)
        kinds = ("T",) if self.model.family == "polynomial" else ("cos", "sin")
        for factors in self.products:
            for which, kind, order in factors:
                if not 0 <= which < count or kind not in kinds or not 0 <= order <= 12 or self.half_range[which] == 0:
                    raise ValueError("a factor is [input that moves, function of the family, order up to 12]")
        return self


class CutContent(Strict):
    """A border between two regions."""

    axis: Annotated[int, Field(ge=0, lt=60)]
    at: Number
    half_width: Positive
    below: CutContent | None
    above: CutContent | None


class TurningContent(Strict):
    """The orientation's error."""

    rms_mrad: Three
    features: SumsContent | ProductsContent
    terms: tuple[Word, ...]
    coefficients: Coefficients
    tool: Rotation


class ErrorModelContent(Strict):
    """errormodel.json."""

    format: Literal["armscope error model 1"]
    name: Word
    method: Word
    rms_mm: Three
    robot: RobotDescription
    features: SumsContent | ProductsContent
    terms: tuple[Word, ...]
    coefficients: Coefficients
    regions: CutContent | None
    turning: TurningContent | None = None
    base: BaseFile
    domain: DomainContent
