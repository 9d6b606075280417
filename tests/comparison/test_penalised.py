"""Fits with penalties against plain least squares, and the rows' own count of what is free."""

import gc
import weakref

import numpy as np
import pytest

from armscope.comparison.penalised import HeldColumns, held_values, left_of_groups, variance_left


def fitted_by(penalty: float) -> tuple[np.ndarray, HeldColumns]:
    rng = np.random.default_rng(3)
    columns = rng.normal(size=(40, 5))
    return columns @ np.arange(5.0) + rng.normal(0, 0.1, 40), HeldColumns(columns, np.full(5, penalty))


def test_without_a_penalty_it_is_least_squares() -> None:
    rows, base = fitted_by(1e-12)
    plain, square, *_ = np.linalg.lstsq(base.columns, rows)
    np.testing.assert_allclose(held_values(rows, base), plain, rtol=1e-9)
    variance, free = variance_left(rows, base)
    assert free == pytest.approx(35)
    assert variance == pytest.approx(square[0] / 35)


def test_a_penalty_holds_values_and_frees_numbers() -> None:
    rows, base = fitted_by(1e9)
    np.testing.assert_allclose(held_values(rows, base), 0, atol=1e-5)
    assert variance_left(rows, base)[1] == pytest.approx(40, abs=1e-4)


@pytest.mark.parametrize("penalty", [1e-12, 3.0])
def test_groups_share_what_is_free(penalty: float) -> None:
    rows, base = fitted_by(penalty)
    left, free = left_of_groups(rows, base, np.repeat([0, 1], [10, 30]))
    np.testing.assert_allclose(left, rows - base.columns @ held_values(rows, base), atol=1e-9)
    hat = base.columns @ np.linalg.inv(base.gram + np.diag(base.penalty)) @ base.columns.T
    np.testing.assert_allclose(free, [10 - np.trace(hat[:10, :10]), 30 - np.trace(hat[10:, 10:])])


def test_what_is_drawn_is_noise_of_another_shape() -> None:
    """Of 2000 tables whose values are drawn with the variance that the penalty says, the variance left is the noise's;
    to count these values as numbers that are taken up would make it larger by 40 / 25."""
    rng = np.random.default_rng(8)
    base = HeldColumns(rng.normal(size=(40, 20)), np.full(20, 0.25), drawn=20)
    tables = base.columns @ rng.normal(0, 2, (20, 2000)) + rng.normal(0, 1, (40, 2000))
    found = [variance_left(rows, base) for rows in tables.T]
    assert np.mean([variance for variance, _ in found]) == pytest.approx(1, abs=0.02)
    assert {free for _, free in found} == {40}


def test_other_penalties_on_the_same_columns() -> None:
    rows, base = fitted_by(3.0)
    assert variance_left(rows, base.held(np.full(5, 1e9)))[1] == pytest.approx(40, abs=1e-4)
    np.testing.assert_allclose(base.half, base.inverse @ base.columns.T)


def test_what_is_fixed_is_what_is_not_drawn() -> None:
    _, base = fitted_by(3.0)
    some = HeldColumns(base.columns, base.penalty, drawn=2)
    np.testing.assert_array_equal(some.fixed.columns, base.columns[:, 2:])
    assert base.fixed is base
    across = base.columns @ np.linalg.solve(base.gram + np.diag(base.penalty), base.columns.T)
    other = np.random.default_rng(1).normal(size=(40, 3))
    np.testing.assert_allclose(base.information(other), other.T @ (np.eye(40) - across) @ other)


@pytest.mark.parametrize("drawn", [0, 1])
def test_columns_go_as_soon_as_nobody_needs_them(drawn):
    """A search makes thousands; kept until garbage was looked for, two short tables took gigabytes."""
    held = HeldColumns(np.eye(4)[:, :2], np.ones(2), drawn)
    held.fixed.half  # noqa: B018 - what is computed once is kept in it
    seen = weakref.ref(held)
    gc.disable()
    try:
        del held
        assert seen() is None
    finally:
        gc.enable()
