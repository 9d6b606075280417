"""Words in a row and in the middle of a sentence."""

from __future__ import annotations

from collections.abc import Sequence


def enumerated(words: Sequence[str], last: str = "and") -> str:
    """ "one, two and three"."""
    return f" {last} ".join([", ".join(words[:-1]), words[-1]]) if len(words) > 1 else "".join(words)


def uncapitalised(text: str) -> str:
    """With a small first letter, unless it begins with a name."""
    return f"{text[:1].lower() if text[1:2].islower() else text[:1]}{text[1:]}"
