"""YAML as configuration needs it: plain values only, bounded in depth and size, every refusal with its place.

PyYAML's own loaders recurse (deep nesting overflows the stack), build other things than plain values (dates, tagged
objects), keep the last of two equal keys, and expand aliases without bound.
"""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterator
from dataclasses import dataclass, field
from typing import Any

import yaml

DEEPEST = 60  # Levels of nesting; no file of armscope has more than ten
MOST_VALUES = 600_000  # Values after aliases are written out
MOST_KEYS = 20_000  # Of one mapping; what a file of armscope names, runs of a model above all, are hundreds
LARGEST_WHOLE = 2**63
LONGEST_NUMBER = 100
CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f]")
"""Characters that steer a terminal instead of standing for something."""

_TAG = "tag:yaml.org,2002:"
_PLAIN = {f"{_TAG}{kind}" for kind in ("str", "int", "float", "bool", "null", "seq", "map")}
_MERGE = object()
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class NotPlain(ValueError):
    """Something that a configuration can't hold: what, at which mark of the text, and how to mend it."""

    def __init__(self, problem: str, mark: Any, cure: str = "") -> None:
        super().__init__(problem)
        self.problem, self.mark, self.cure = problem, mark, cure


@dataclass
class _Open:
    """A list or a mapping that is being read."""

    value: Any
    mark: Any
    anchor: str | None
    size: int = 1
    key: Any = None
    has_key: bool = False
    merged: list[Any] = field(default_factory=list)


def plain_yaml(text: str | bytes) -> Any:
    """The one document in a YAML text; None where there is none. Raises yaml.YAMLError: it is no YAML; NotPlain: it
    is more than a configuration can be."""
    reading = _Reading()
    for event in _events(text):
        reading.take(event)
    return reading.documents[0] if reading.documents else None


def _events(text: str | bytes) -> Iterator[Any]:
    loader = _LOADER(text)
    try:
        while loader.check_event():
            yield loader.get_event()
    finally:
        loader.dispose()


class _Reading:
    """Values put together from the events of a parser, without recursion."""

    def __init__(self) -> None:
        self.documents: list[Any] = []
        self._open: list[_Open] = []
        self._known: dict[tuple[str | None, tuple[bool, bool], str], Any] = {}
        self._anchors: dict[str, tuple[Any, int]] = {}
        self._resolver: Any = yaml.resolver.Resolver()
        self._constructor = yaml.constructor.SafeConstructor()

    def take(self, event: Any) -> None:
        """The next event."""
        if isinstance(event, yaml.ScalarEvent):
            value = self._scalar(event)
            if event.anchor is not None:
                self._anchors[event.anchor] = value, 1
            self._add(value, 1, event.start_mark)
        elif isinstance(event, yaml.AliasEvent):
            if event.anchor not in self._anchors:
                raise NotPlain(f"the alias *{event.anchor} of nothing that is complete", event.start_mark)
            self._add(*self._anchors[event.anchor], event.start_mark)
        elif isinstance(event, yaml.SequenceStartEvent | yaml.MappingStartEvent):
            _check_tag(event)
            if len(self._open) >= DEEPEST:
                raise NotPlain(f"more than {DEEPEST} levels of nesting", event.start_mark)
            if event.anchor is not None:
                self._anchors.pop(event.anchor, None)
            empty: Any = [] if isinstance(event, yaml.SequenceStartEvent) else {}
            self._open.append(_Open(empty, event.start_mark, event.anchor))
        elif isinstance(event, yaml.SequenceEndEvent | yaml.MappingEndEvent):
            self._close()

    def _close(self) -> None:
        done = self._open.pop()
        for inner in done.merged:
            for key, value in inner.items():
                done.value.setdefault(key, value)
        if done.anchor is not None:
            self._anchors[done.anchor] = done.value, done.size
        self._add(done.value, done.size, done.mark)

    def _add(self, value: Any, size: int, mark: Any) -> None:
        if not self._open:
            if self.documents:
                raise NotPlain("a second document", mark, "Leave out the line `---` and what follows it.")
            self.documents.append(value)
            return
        into = self._open[-1]
        into.size += size
        if into.size > MOST_VALUES:
            raise NotPlain(f"more than {MOST_VALUES} values, aliases written out", mark)
        if isinstance(into.value, list):
            into.value.append(value)
        elif into.has_key:
            self._put(into, value, mark)
            into.has_key = False
        else:
            if not isinstance(value, Hashable):
                raise NotPlain(f"the key {str(value)[:60]}", mark)
            if value is not _MERGE and value in into.value:
                raise NotPlain(f"the key {value!r} twice", mark, "Leave one of them out.")
            if len(into.value) >= MOST_KEYS:
                raise NotPlain(f"more than {MOST_KEYS} keys of one mapping", mark)
            into.key, into.has_key = value, True

    @staticmethod
    def _put(into: _Open, value: Any, mark: Any) -> None:
        if into.key is not _MERGE:
            into.value[into.key] = value
            return
        several = value if isinstance(value, list) else [value]
        if not all(isinstance(each, dict) for each in several):
            raise NotPlain("something else than mappings to merge", mark)
        into.merged += several

    def _scalar(self, event: Any) -> Any:
        """The value of a text; one that stood before is not read again: tables in YAML repeat most of theirs."""
        text = event.tag, event.implicit, event.value
        if text not in self._known:
            self._known[text] = self._read_scalar(event)
        if self._known[text] is not _MERGE:
            return self._known[text]
        return _MERGE if self._open and isinstance(self._open[-1].value, dict) else event.value

    def _read_scalar(self, event: Any) -> Any:
        _check_tag(event)
        if found := CONTROL.search(event.value):
            raise NotPlain(f"the control character {found.group()!r}", event.start_mark)
        tag = event.tag
        if tag is None or tag == "!":
            tag = self._resolver.resolve(yaml.ScalarNode, event.value, event.implicit)
        if tag == f"{_TAG}merge":
            return _MERGE
        construct = self._constructor.yaml_constructors.get(tag) if tag in _PLAIN else None
        if construct is None or tag == f"{_TAG}str":  # dates stay as they are written
            return event.value
        if ":" in event.value:  # 19:10 is 1150 to YAML 1.1, which counts hours and minutes so
            cure = "A number has a point, 19.10; words and times of day stand in quotes."
            raise NotPlain(f"{event.value[:60]}, neither a number nor a word", event.start_mark, cure)
        if len(event.value) > LONGEST_NUMBER:
            raise NotPlain(f"a number of {len(event.value)} digits", event.start_mark)
        try:
            value = construct(self._constructor, yaml.ScalarNode(tag, event.value))
        except (ValueError, KeyError, OverflowError, IndexError) as error:
            raise NotPlain(f"no {tag.removeprefix(_TAG)}: {event.value[:60]!r}", event.start_mark) from error
        if isinstance(value, int) and abs(value) >= LARGEST_WHOLE:
            raise NotPlain(f"a number of {len(event.value)} digits", event.start_mark)
        return value


def _check_tag(event: Any) -> None:
    if event.tag is not None and event.tag != "!" and event.tag not in _PLAIN:
        raise NotPlain(f"the tag {event.tag}", event.start_mark, "Leave out the word that begins with `!`.")
