"""verdict.json of a motion: its version and its JSON schema; the one place that writes and reads it.

Keys of the contract stay; more may come. A reader takes no offence at a key that it does not know.
"""

from __future__ import annotations

from typing import Any

from pydantic import ConfigDict, RootModel

from armscope.core.files import plain_values
from armscope.core.inputs import InputError, format_of, validate
from armscope.motion.verdict import FORMAT, MotionVerdict
from armscope.verdict.contract import AlwaysThere


class MotionVerdictFile(RootModel[MotionVerdict]):
    """The content of verdict.json of a motion."""

    model_config = ConfigDict(revalidate_instances="always")


def schema() -> dict[str, Any]:
    """The JSON schema of verdict.json of a motion."""
    whole = MotionVerdictFile.model_json_schema(mode="serialization", schema_generator=AlwaysThere)
    return {"$defs": whole["$defs"], **whole["$defs"].pop("MotionVerdict")}


def to_json(verdict: MotionVerdict) -> dict[str, Any]:
    """The content of verdict.json."""
    content: dict[str, Any] = plain_values(MotionVerdictFile(verdict).model_dump(by_alias=True))
    return content


def from_json(content: Any, source: object) -> MotionVerdict:
    """A verdict from the content of verdict.json; see `MotionVerdict.from_json`."""
    if (found := format_of(content)) != FORMAT:
        rule = f'a verdict on a motion says "format": "{FORMAT}"'
        raise InputError(source, "format", found, rule, "`armscope diagnose` writes one.")
    return validate(MotionVerdictFile, content, source).root
