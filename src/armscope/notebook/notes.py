"""What a command says beside its table, as a notebook says it."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from typing import TypeVar

Given = TypeVar("Given")


class PredictionWarning(UserWarning):
    """What was assumed or left out of a prediction or of commands: the command says it on the terminal."""


def with_notes(given: tuple[Given, Iterable[str]]) -> Given:
    """What came with notes, which are told as warnings (`PredictionWarning`).

    Args:
        given: anything, and what is to be said about it.

    Returns:
        The first.
    """
    found, notes = given
    for note in notes:
        warnings.warn(note, PredictionWarning, stacklevel=3)
    return found
