"""What the diagnosis says of the examples and of fixed worlds stays what it was, name by name and number by number.

A change of behaviour that is meant writes tests/golden/golden.json anew (`python -m tests.golden.cases --digest`) in a
commit that says why.
"""

import json
from typing import Any

import numpy as np
import pytest

from tests.golden.cases import DIGEST, digest, verdicts

CLOSE = 1e-6
"""Relative: another machine's linear algebra sums in another order."""


def _numbers(content: Any) -> list[float]:
    if isinstance(content, dict):
        return [number for value in content.values() for number in _numbers(value)]
    if isinstance(content, list):
        return [number for value in content for number in _numbers(value)]
    return [float(content)] if isinstance(content, int | float) else []


def _words(content: Any) -> Any:
    if isinstance(content, dict):
        return {key: _words(value) for key, value in content.items()}
    if isinstance(content, list):
        return [_words(value) for value in content]
    return content if isinstance(content, str) else None


LATER = [pytest.param(kind, marks=pytest.mark.long) for kind in ("again", "long")]


@pytest.mark.parametrize("kind", ["others", *LATER])
def test_names_places_and_numbers_are_what_they_were(kind: str) -> None:
    golden = json.loads(DIGEST.read_text(encoding="utf-8"))
    for name, verdict in verdicts(kind):
        now = json.loads(json.dumps(digest(verdict)))
        assert _words(now) == _words(golden[name]), name
        np.testing.assert_allclose(_numbers(now), _numbers(golden[name]), rtol=CLOSE, atol=1e-9, err_msg=name)
