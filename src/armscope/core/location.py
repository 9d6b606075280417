"""Where in an arm something acts: a kind of place, its number, and where it takes it from; files keep the words."""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass

_WORDS = re.compile(r"(joint|link|motor) (\d+)(?: from joint (\d+))?")


@dataclass(frozen=True)
class Location:
    """A place as its parts; `str` gives the words of the files."""

    kind: str  # "base", "joint", "link", "motor", "tool", "instrument", "payload", "parallelogram", or any other words
    number: int = 0  # which joint, link or motor, from 1; 0 where places are not numbered
    source: int = 0  # for "joint 6 from joint 5": 5, whose motion does it; else 0

    @classmethod
    @functools.lru_cache(maxsize=10_000)
    def of(cls, words: str) -> Location:
        """From the words of the files; words that name no numbered place are a kind of their own."""
        found = _WORDS.fullmatch(words)
        return cls(found[1], int(found[2]), int(found[3] or 0)) if found else cls(words)

    @property
    def index(self) -> int:
        """The number from 0."""
        return self.number - 1

    @property
    def region(self) -> str:
        """The place, coarsely: the number of the joint whose neighbourhood moves, else the kind.

        Link j of a standard D-H row lies between joints j and j+1; "joint 6 from joint 5" counts as joint 6.
        """
        return str(self.number) if self.number and self.kind in ("joint", "link") else self.kind

    def __str__(self) -> str:
        if not self.number:
            return self.kind
        return f"{self.kind} {self.number}" + (f" from joint {self.source}" if self.source else "")
