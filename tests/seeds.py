"""One claim on several seeds: `make test` asks for it with the first one, `make test-long` with the others."""

from typing import Any

import pytest


def seeds(first: Any, *others: Any) -> list[Any]:
    """What a test of arms that differ by their seeds, or by another case of one claim, is parametrised by."""
    return [first, *(pytest.param(seed, marks=pytest.mark.long) for seed in others)]


def arms_and_seeds(short: str, whole: str, *every: int) -> list[Any]:
    """The same where an arm without its wrist shows it as well: the others are of the whole arm, by every seed."""
    return [(short, every[0]), *(pytest.param(whole, seed, marks=pytest.mark.long) for seed in every)]
