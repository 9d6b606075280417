"""Shares of the mismatch: what several effects are worth together and each."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from armscope.inference.normal_equations import NormalEquations
from armscope.inference.shapley import shares

ROWS = 60
WELL_CONDITIONED = 300.0


def sums(X: np.ndarray, y: np.ndarray) -> NormalEquations:
    return NormalEquations(X.T @ X, X.T @ y, float(y @ y), float(len(y)))


def frames(X: np.ndarray) -> np.ndarray:
    """The first column is the frame."""
    return np.array([0])


def explained(X: np.ndarray, y: np.ndarray) -> float:
    """Share of the variance beyond the first column that all columns explain, by least squares."""

    def left(columns: np.ndarray) -> float:
        return float(np.sum((y - columns @ np.linalg.lstsq(columns, y, rcond=None)[0]) ** 2))

    return 1 - left(X) / left(X[:, :1])


@given(st.integers(0, 10_000), st.integers(1, 7))
def test_shares_are_never_negative_and_add_up_to_what_is_explained(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    X = rng.normal(size=(ROWS, 1 + 2 * count)) @ (np.eye(1 + 2 * count) + 0.4 * rng.normal(size=2 * (1 + 2 * count,)))
    y = X @ rng.normal(size=X.shape[1]) + rng.normal(size=ROWS)
    # the factor's guard against rounding (1e-11 of a column) shows where columns are nearly one another's combinations
    assume(np.linalg.cond(X / np.linalg.norm(X, axis=0)) < WELL_CONDITIONED)
    members = [np.array([1 + 2 * m, 2 + 2 * m]) for m in range(count)]
    told = shares(sums(X, y), np.zeros(X.shape[1]), frames(X), members)
    assert (told >= -1e-9).all()
    assert told.sum() == pytest.approx(explained(X, y), abs=1e-6)


def test_effects_that_do_not_overlap_are_worth_their_own_variance() -> None:
    X = np.linalg.qr(np.random.default_rng(1).normal(size=(ROWS, 3)))[0]
    y = X @ np.array([5.0, 3.0, 4.0])
    told = shares(sums(X, y), np.zeros(3), frames(X), [np.array([1]), np.array([2])])
    np.testing.assert_allclose(told, [9 / 25, 16 / 25], atol=1e-9)


def test_two_that_nearly_cancel_are_not_worth_more_than_the_mismatch() -> None:
    rng = np.random.default_rng(2)
    one, other = rng.normal(size=ROWS), 1e-2 * rng.normal(size=ROWS)
    X = np.column_stack([np.ones(ROWS), one, one + other])
    y = X @ np.array([0.0, 100.0, -100.0])
    told = shares(sums(X, y), np.zeros(3), frames(X), [np.array([1]), np.array([2])])
    assert told.sum() == pytest.approx(1.0, abs=1e-6)
    assert (told <= 1).all()


def test_what_is_held_near_zero_explains_little() -> None:
    X = np.linalg.qr(np.random.default_rng(3).normal(size=(ROWS, 2)))[0]
    y = X @ np.array([1.0, 2.0])
    (free,) = shares(sums(X, y), np.zeros(2), frames(X), [np.array([1])])
    (held,) = shares(sums(X, y), np.array([0.0, 9.0]), frames(X), [np.array([1])])
    assert free == pytest.approx(1.0)
    assert held == pytest.approx(0.1)


@given(st.integers(0, 10_000))
def test_the_last_members_count_for_what_nothing_else_explains(seed: int) -> None:
    rng = np.random.default_rng(seed)
    X = rng.normal(size=(ROWS, 9)) + rng.normal(size=(ROWS, 1))
    y = X @ rng.normal(size=9) + rng.normal(size=ROWS)
    members = [np.arange(1 + 2 * m, 3 + 2 * m) for m in range(4)]
    told = shares(sums(X, y), np.zeros(9), frames(X), members, last={1, 3})
    first = X[:, [0, *members[0], *members[2]]]
    left = 1 - explained(first, y)
    assert told[[0, 2]].sum() == pytest.approx(explained(first, y), abs=1e-6)
    one, other = (explained(np.column_stack([first, X[:, members[m]]]), y) for m in (1, 3))
    both = explained(X[:, [0, *members[0], *members[2], *members[1], *members[3]]], y)
    assert told[1] == pytest.approx((one - (1 - left) + both - other) / 2, abs=1e-6)
    assert told[3] == pytest.approx((other - (1 - left) + both - one) / 2, abs=1e-6)
