"""What is said of a joint that scatters goes by the numbers that are known of it."""

from __future__ import annotations

import pytest

from armscope.physics.clause import Number, Told, say
from armscope.physics.scatter_words import SCATTER_CLAUSES, SCATTER_LABELS

RAD, KG = Number(3e-4, "rad"), Number(6.0, "kg")


@pytest.mark.parametrize(
    ("numbers", "said"),
    [
        ({}, "for a reason that no single column of the table tells"),
        ({"play": RAD}, "play of"),
        ({"overrun": RAD}, "ahead of its readings"),
        ({"give": Number(1e-6, "rad/(N m)")}, "gives way under gravity by more in some rows than in others"),
        ({"unsaid_load": KG}, "as if what the arm carries changed from row to row by 6.0 kg"),
    ],
)
def test_the_number_that_says_most_is_told(numbers: dict[str, Number], said: str) -> None:
    told = Told("unknown", "joint 2", "nothing in the table", {"scatter": RAD, **numbers})
    assert said in say(SCATTER_CLAUSES, told)
    assert set(numbers) <= set(SCATTER_LABELS)
