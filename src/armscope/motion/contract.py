"""verdict.json of a motion: its names, its version, its JSON schema; the one place that writes and reads them.

Keys of the contract stay; more may come. A reader takes no offence at a key that it does not know.
"""

from __future__ import annotations

from typing import Any, Literal

from armscope.core.inputs import InputError, format_of, validate
from armscope.core.types import Number
from armscope.motion.verdict import (
    FoundCause,
    HeldOutMotion,
    JointBackground,
    MotionVerdict,
    Step,
    UnexplainedTorque,
)
from armscope.verdict.contract import AlwaysThere, FilePart, ParameterFile, in_memory
from armscope.verdict.effects import Alternative, Parameter
from armscope.verdict.schema import Answer, Notice

Format = Literal["armscope motion verdict 1"]
FORMAT: Format = "armscope motion verdict 1"


class FoundCauseFile(FilePart):
    """A cause that the evidence asks for; the attributes of `armscope.motion.verdict.FoundCause`."""

    effect: str
    location: str
    family: str
    driver: str
    title: str
    minor: bool
    parameters: tuple[ParameterFile, ...]
    rms: Number
    unit: str
    joint: str
    share: Number
    evidence_nats: Number
    alternatives: tuple[Alternative, ...]
    carries_over: str
    consistent: bool | None
    physics: str
    confirm: str
    cure: str
    doubt: str = ""


class JointBackgroundFile(FilePart):
    """What every joint has; the attributes of `armscope.motion.verdict.JointBackground`."""

    joint: str
    parameters: tuple[ParameterFile, ...]
    noise: Number
    unit: str
    independent_rows: int


class MotionVerdictFile(FilePart):
    """The content of verdict.json of a motion; the attributes of `armscope.motion.verdict.MotionVerdict`.

    Attributes:
        format: the file's kind and version.
    """

    format: Format = FORMAT
    answer: Answer
    headline: str
    mismatch: bool | None
    effects: tuple[FoundCauseFile, ...]
    unexplained: UnexplainedTorque
    background: tuple[JointBackgroundFile, ...]
    masses_share: Number
    held_out: HeldOutMotion
    fitted: Step
    waterfall: tuple[Step, ...]
    identifiable: dict[str, Number]
    preparation: str
    notices: tuple[Notice, ...]
    rows: int
    samples: int
    runs: tuple[str, ...]
    seconds: Number
    settings: dict[str, Any]


def schema() -> dict[str, Any]:
    """The JSON schema of verdict.json of a motion."""
    return MotionVerdictFile.model_json_schema(mode="serialization", schema_generator=AlwaysThere)


def to_json(verdict: MotionVerdict) -> dict[str, Any]:
    """The content of verdict.json."""
    return MotionVerdictFile.model_validate(verdict).model_dump()


def from_json(content: Any, source: object) -> MotionVerdict:
    """A verdict from the content of verdict.json; see `MotionVerdict.from_json`."""
    if (found := format_of(content)) != FORMAT:
        rule = f'a verdict on a motion says "format": "{FORMAT}"'
        raise InputError(source, "format", found, rule, "`armscope diagnose` writes one.")
    file = validate(MotionVerdictFile, content, source)
    return in_memory(
        MotionVerdict,
        file,
        effects=tuple(in_memory(FoundCause, each, parameters=_parameters(each)) for each in file.effects),
        background=tuple(in_memory(JointBackground, each, parameters=_parameters(each)) for each in file.background),
    )


def _parameters(part: FoundCauseFile | JointBackgroundFile) -> tuple[Parameter, ...]:
    return tuple(in_memory(Parameter, each) for each in part.parameters)
