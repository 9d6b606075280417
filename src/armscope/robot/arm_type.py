"""What arms of one type have shown: sizes of their errors, learned from a fleet and read from its priors.yaml."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from armscope.core.inputs import InputError, Strict, load, nearest

Size = Annotated[float, Field(ge=0, le=1e9)]
Count = Annotated[int, Field(ge=1, le=1_000_000_000)]
Share = Annotated[float, Field(ge=0, le=1)]
Name = Annotated[str, Field(min_length=1, max_length=200)]


class LearnedSize(Strict):
    """Root mean square of a parameter over the arms in which its effect was named."""

    unit: str
    rms: Size
    arms: Count


class RepeatedCause(Strict):
    """How often a cause was named, and its median size."""

    share: Share
    rms_at_tool_mm: Size


class TypeContent(Strict):
    """One type of arm."""

    arms: Count
    causes: dict[Name, RepeatedCause] = Field(default_factory=dict)
    sizes: dict[Name, dict[Name, LearnedSize]] = Field(default_factory=dict)


class PriorsContent(Strict):
    """priors.yaml."""

    format: Literal["armscope fleet priors 2"]
    types: Annotated[dict[Name, TypeContent], Field(min_length=1)]


@dataclass(frozen=True)
class ArmType:
    """What is known of a type of arm before one of them is measured; by default nothing."""

    source: str = ""  # the file, for errors
    title: str = ""  # the type's name, and of how many arms it is known
    # by "effect at location" and parameter, in the parameter's file unit
    sizes: Mapping[str, Mapping[str, LearnedSize]] = field(default_factory=dict)


def read_arm_type(path: Path | str, name: str | None = None) -> ArmType:
    """A type of arm in a priors.yaml.

    Args:
        path: that ``snakemake fleet`` wrote.
        name: of the type; may be left out where the file holds one.

    Raises:
        InputError: the file is none, or has no such type, or several and none is named.
    """
    types = load(PriorsContent, path).types
    if name is None and len(types) > 1:
        raise InputError(path, "types", f"{len(types)} types", "--arm-type says which", nearest("", types))
    name = next(iter(types)) if name is None else name
    if name not in types:
        raise InputError("--arm-type", "", name, f"{path} has no such type", nearest(name, types))
    return ArmType(str(path), f"{types[name].arms} arms of type {name}", types[name].sizes)
