"""A change in words: what these recordings do not tell apart is no finding."""

from dataclasses import replace

import pytest

from tests.comparison.test_remedies import CHANGE


@pytest.mark.parametrize(
    ("others", "said"),
    [
        (0, CHANGE.title),
        (1, f"{CHANGE.title} (or another)"),
        (3, f"{CHANGE.title} (or one of 3 others that explain it as well)"),
        (28, f"something that these recordings do not tell ({CHANGE.title} or one of 28 others)"),
    ],
)
def test_the_more_explain_a_change_the_less_it_has_a_name(others: int, said: str) -> None:
    assert replace(CHANGE, alternatives=tuple(f"cause {n}" for n in range(others))).title_with_doubt == said
