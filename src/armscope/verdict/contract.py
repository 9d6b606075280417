"""verdict.json: its names, its version, its JSON schema; the one place that writes and reads them.

Keys of the contract stay; more may come. A reader takes no offence at a key that it does not know.
"""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import numpy as np
from pydantic import BaseModel, ConfigDict
from pydantic.json_schema import GenerateJsonSchema

from armscope.core.files import plain_values
from armscope.core.inputs import InputError, format_of, validate
from armscope.core.types import Number
from armscope.verdict.effects import Alternative, Cause, FoundEffect, Parameter, Specific
from armscope.verdict.schema import (
    Answer,
    Background,
    HeldOut,
    Notice,
    Orientations,
    SuspectRow,
    Unexplained,
    Verdict,
    WaterfallStep,
)

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Format = Literal["armscope verdict 2"]
FORMAT: Format = "armscope verdict 2"
Made = TypeVar("Made", bound="DataclassInstance")


class FilePart(BaseModel):
    """A part of a verdict's file, made of what it is in memory."""

    model_config = ConfigDict(from_attributes=True)


class EffectFile(FilePart):
    """An effect that the evidence asks for; the attributes of `armscope.verdict.effects.FoundEffect`."""

    effect: str
    location: str
    family: str
    driver: str
    named_as: Specific
    title: str
    minor: bool
    parameters: tuple[Parameter, ...]
    rms_at_tool_mm: Number
    share: Number
    evidence_nats: Number
    alternatives: tuple[Alternative, ...]
    inclusion: float | None
    description: str
    carries_over: str
    undetermined: tuple[str, ...] = ()
    share_after_calibration: Number = np.nan


class BeforeAfter(FilePart):
    """RMS per axis.

    Attributes:
        before: with the frames only.
        after: with the model.
    """

    before: Number
    after: Number


class HeldOutFile(BeforeAfter):
    """RMS per axis (mm) on rows that took no part; null where it was not possible."""

    before_all_rows: Number
    after_all_rows: Number
    spread: Number
    folds: int
    grouped_by: str


class OrientationFile(FilePart):
    """What measured orientations say; RMS per axis, mrad.

    Attributes:
        held_out_rms_mrad: on rows that took no part.
    """

    rows: int
    noise_mrad: Number
    lever_mm: Number
    before_mrad: Number
    instrument_mrad: Number = 0.0
    held_out_rms_mrad: BeforeAfter


class VerdictFile(FilePart):
    """The content of verdict.json; the attributes of `armscope.verdict.schema.Verdict`.

    Attributes:
        format: the file's kind and version.
        held_out_rms_mm: errors on rows that took no part.
        orientation: what measured orientations say; null where none were measured.
        fitted_rms_mm: on the fitted rows, mm.
    """

    format: Format = FORMAT
    mismatch: bool | None
    answer: Answer
    headline: str
    noise_mm: Number
    noise_source: str
    causes: tuple[Cause, ...] = ()
    effects: tuple[EffectFile, ...]
    unexplained: Unexplained
    background: Background
    background_families: tuple[Background, ...]
    held_out_rms_mm: HeldOutFile
    orientation: OrientationFile | None
    fitted_rms_mm: BeforeAfter
    waterfall: tuple[WaterfallStep, ...]
    suspects: tuple[SuspectRow, ...]
    notices: tuple[Notice, ...]
    rows: int
    runs: tuple[str, ...]
    settings: dict[str, Any]


_SAME = (
    "mismatch", "answer", "headline", "noise_mm", "noise_source", "causes", "effects", "unexplained", "background",
    "background_families", "waterfall", "suspects", "notices", "rows", "runs", "settings",
)  # fmt: skip
"""Keys that a verdict's attributes are called by, too."""


class AlwaysThere(GenerateJsonSchema):
    """Every key is always there: the defaults are those of the classes in memory."""

    def field_is_required(self, *_: Any, **__: Any) -> bool:
        """They all are."""
        return True

    def default_schema(self, schema: Any) -> Any:
        """Without the default."""
        return self.generate_inner(schema["schema"])


def schema() -> dict[str, Any]:
    """The JSON schema of verdict.json."""
    return VerdictFile.model_json_schema(mode="serialization", schema_generator=AlwaysThere)


def to_json(verdict: Verdict) -> dict[str, Any]:
    """The content of verdict.json."""
    held_out, seen = verdict.held_out, verdict.orientations
    turns = BeforeAfter(before=held_out.turn_before, after=held_out.turn_after)
    file = VerdictFile(
        **{name: getattr(verdict, name) for name in _SAME},
        held_out_rms_mm=HeldOutFile.model_validate(held_out),
        orientation=None if seen is None else OrientationFile(**vars(seen), held_out_rms_mrad=turns),
        fitted_rms_mm=BeforeAfter(before=verdict.residual_before_mm, after=verdict.residual_after_mm),
    )
    content: dict[str, Any] = plain_values(file.model_dump(by_alias=True))  # JSON has no NaN: null, as in the file
    return content


def from_json(content: Any, source: object) -> Verdict:
    """A verdict from the content of verdict.json; see `Verdict.from_json`."""
    if (found := format_of(content)) != FORMAT:
        rule = f'a verdict of this version says "format": "{FORMAT}"'
        raise InputError(source, "format", found, rule, "`armscope diagnose` writes one.")
    file = validate(VerdictFile, content, source)
    seen = file.orientation
    turns = seen.held_out_rms_mrad if seen else BeforeAfter(before=np.nan, after=np.nan)
    return Verdict(
        **{name: getattr(file, name) for name in _SAME if name != "effects"},
        effects=tuple(_in_memory(FoundEffect, effect) for effect in file.effects),
        held_out=_in_memory(HeldOut, file.held_out_rms_mm, turn_before=turns.before, turn_after=turns.after),
        residual_before_mm=file.fitted_rms_mm.before,
        residual_after_mm=file.fitted_rms_mm.after,
        orientations=_in_memory(Orientations, seen) if seen else None,
    )


def _in_memory(kind: type[Made], part: BaseModel, **changes: Any) -> Made:
    """A part of the file as what it is in memory, without what is said twice; changes: what it has in another shape."""
    known = {field.name for field in fields(kind)}
    return kind(**{**{name: value for name, value in part if name in known}, **changes})
