"""How much must be searched before nothing found means that there is nothing."""

from dataclasses import replace

import pytest

from armscope.paper.audit_scope import AuditScope


def test_the_default_search_is_enough_and_says_what_it_is() -> None:
    assert AuditScope().thorough
    assert AuditScope().in_words == (
        "4096 sets of corners in a box from (-2500, -2500, -1500) to (2500, 2500, 3000) mm, "
        "and 151 rises from -1500 to 1500 mm"
    )


@pytest.mark.parametrize(
    "less",
    [
        {"corner_samples": 1},
        {"rises": (-1500.0, 0.0, 1500.0)},
        {"rises": (0.0,)},
        {"low": (900.0, -100.0, 500.0), "high": (1000.0, 100.0, 700.0)},
        {"low": (-2500.0, 0.0, -1500.0), "high": (2500.0, 4000.0, 3000.0)},  # without a printed start
    ],
)
def test_less_of_any_is_not_enough(less: dict[str, object]) -> None:
    assert not replace(AuditScope(), **less).thorough
