"""Where numbers of a configuration come from, once some of them were set anew over the file that gives sources."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def with_own_sources(config: Mapping[str, Any], default: Mapping[str, Any]) -> dict[str, Any]:
    """A configuration in which no number that was set anew keeps the source of the number that it stands in place of.

    Args:
        config: as it is used: the defaults, and over them what was set.
        default: of the file with all defaults; `{value: ..., source: ...}` is a number with its source.

    Returns:
        The configuration; a changed number that came without a source says so, and what the default was.
    """
    mended = dict(config)
    for name, part in config.items():
        was = default.get(name)
        if not (isinstance(part, Mapping) and isinstance(was, Mapping)):
            continue
        mended[name] = with_own_sources(part, was)
        if {"value", "source"} <= part.keys() & was.keys() and _inherits(part, was):
            mended[name]["source"] = f"set for this run, without a source (default: {was['value']}, {was['source']})"
    return mended


def _inherits(part: Mapping[str, Any], was: Mapping[str, Any]) -> bool:
    return bool(part["value"] != was["value"] and part["source"] == was["source"])
