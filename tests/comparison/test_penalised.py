"""Fits with penalties against plain least squares, and the rows' own count of what is free."""

import numpy as np
import pytest

from armscope.comparison.penalised import held_values, left_of_groups, variance_left


def drawn(penalty: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(3)
    columns = rng.normal(size=(40, 5))
    return columns @ np.arange(5.0) + rng.normal(0, 0.1, 40), columns, np.full(5, penalty)


def test_without_a_penalty_it_is_least_squares() -> None:
    rows, columns, penalty = drawn(1e-12)
    plain, square, *_ = np.linalg.lstsq(columns, rows)
    np.testing.assert_allclose(held_values(rows, columns, penalty), plain, rtol=1e-9)
    variance, free = variance_left(rows, columns, penalty)
    assert free == pytest.approx(35)
    assert variance == pytest.approx(square[0] / 35)


def test_a_penalty_holds_values_and_frees_numbers() -> None:
    rows, columns, penalty = drawn(1e9)
    np.testing.assert_allclose(held_values(rows, columns, penalty), 0, atol=1e-5)
    assert variance_left(rows, columns, penalty)[1] == pytest.approx(40, abs=1e-4)


@pytest.mark.parametrize("penalty", [1e-12, 3.0])
def test_groups_share_what_is_free(penalty: float) -> None:
    rows, columns, held = drawn(penalty)
    left, free = left_of_groups(rows, columns, held, np.repeat([0, 1], [10, 30]))
    np.testing.assert_allclose(left, rows - columns @ held_values(rows, columns, held), atol=1e-9)
    hat = columns @ np.linalg.inv(columns.T @ columns + np.diag(held)) @ columns.T
    np.testing.assert_allclose(free, [10 - np.trace(hat[:10, :10]), 30 - np.trace(hat[10:, 10:])])
