"""Numbers that decide: each with its unit, what it means and why it has this value.

A module keeps its own in a frozen dataclass that derives from `Constants`, one field a number:

    @dataclass(frozen=True)
    class SearchBudget(Constants):
        '''How much is searched.'''

        beam: int = 3
        '''hypotheses that go on after every round [hypotheses]; judgement: ...'''

docs/constants.md is made of them by `python -m tools.constants`.
"""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from dataclasses import Field, dataclass, fields
from itertools import pairwise

BASES = ("measured", "derived", "convention", "judgement")
"""What a value may rest on: an experiment that is named, a formula, what everybody does, or somebody's view."""
_SAID = re.compile(rf"(.+?)(?: \[([^\]]+)\])?; ((?:{'|'.join(BASES)}): .+|convention)")
"""What stands below a number: its meaning, its unit unless it has none, and its basis with a reason."""


@dataclass(frozen=True)
class Constants:
    """Numbers that belong together."""


@dataclass(frozen=True)
class Entry:
    """One number as the page about them shows it."""

    name: str
    value: object
    unit: str
    meaning: str
    basis: str


def entries(group: type[Constants]) -> list[Entry]:
    """A group's numbers, in its order. Raises ValueError: one without a meaning or a basis."""
    body = ast.parse(textwrap.dedent(inspect.getsource(group))).body[0]
    assert isinstance(body, ast.ClassDef)
    below = {ast.unparse(each.target): said for each, said in pairwise(body.body) if isinstance(each, ast.AnnAssign)}
    return [_entry(each, below.get(each.name)) for each in fields(group)]


def _entry(number: Field[object], below: ast.stmt | None) -> Entry:
    said = ast.literal_eval(below.value) if isinstance(below, ast.Expr) else ""
    found = _SAID.fullmatch(" ".join(said.split()))
    if found is None:
        raise ValueError(f"{number.name}: {said!r} must be a meaning, a [unit] and a basis: one of {', '.join(BASES)}")
    return Entry(number.name, number.default, found[2] or "", found[1], found[3])
