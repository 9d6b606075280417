"""Columns that can be told apart span what all columns span, lower tiers first."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from armscope.design.independence import independent_columns


@given(st.integers(0, 2**32 - 1), st.integers(1, 6), st.integers(0, 5))
@settings(max_examples=30, deadline=None)
def test_as_many_as_the_rank_are_chosen_and_all_others_are_made_of_them(seed: int, rank: int, more: int) -> None:
    rng = np.random.default_rng(seed)
    free = np.linalg.qr(rng.normal(size=(20, rank)))[0]
    columns = np.hstack([free, free @ rng.normal(size=(rank, more))])[:, rng.permutation(rank + more)]
    chosen = independent_columns(columns, rng.integers(0, 3, rank + more), 1e-9)
    assert chosen.sum() == rank
    made = columns[:, chosen] @ np.linalg.lstsq(columns[:, chosen], columns, rcond=None)[0]
    np.testing.assert_allclose(made, columns, atol=1e-8)


def test_of_two_alike_the_lower_tier_is_chosen_and_what_leaves_too_little_is_not() -> None:
    one, other = np.eye(4)[:, :1], np.eye(4)[:, 1:2]
    columns = np.hstack([one, one, one + 1e-4 * other])
    assert independent_columns(columns, np.array([1, 0, 2]), 1e-3).tolist() == [False, True, False]
    assert independent_columns(columns, np.array([1, 0, 2]), 1e-5).tolist() == [False, True, True]
