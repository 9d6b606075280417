"""What a command says beside its table, as a notebook says it."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from typing import TypeVar

Given = TypeVar("Given")


class PredictionWarning(UserWarning):
    """What was assumed or left out of a prediction or of commands: the command says it on the terminal."""


class PosesWarning(UserWarning):
    """What chosen poses were not checked for: `armscope poses` says it on standard error."""


def with_notes(given: tuple[Given, Iterable[str]], kind: type[UserWarning] = PredictionWarning) -> Given:
    """What came with notes, which are told as warnings."""
    found, notes = given
    for note in notes:
        warnings.warn(note, kind, stacklevel=3)
    return found
