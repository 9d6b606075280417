"""F statistics of changes against two nested least-squares fits, written out."""

import numpy as np
import pytest
from scipy.stats import f as f_distribution

from armscope.comparison.own_errors import OwnErrors, no_own_errors
from armscope.comparison.penalised import HeldColumns
from armscope.comparison.scoring import Statistic, halves, numbers_behind, overdispersion, scored

RNG = np.random.default_rng(12)
COLUMNS, CHANGE = RNG.normal(size=(60, 4)), RNG.normal(size=(60, 2))
ROWS = COLUMNS @ [1.0, -2, 0, 3] + 0.4 * CHANGE[:, 0] + RNG.normal(0, 1, 60)


NONE = no_own_errors(60)


def left_by(columns: np.ndarray) -> float:
    return float(np.linalg.lstsq(columns, ROWS)[1][0])


def test_it_is_the_f_of_two_nested_fits() -> None:
    base = HeldColumns(COLUMNS, np.full(4, 1e-12))
    (found,) = scored([CHANGE], ROWS, base, 1.0, NONE)
    without, with_it = left_by(COLUMNS), left_by(np.hstack([COLUMNS, CHANGE]))
    assert found.statistic.f == pytest.approx((without - with_it) / 2 / (with_it / (60 - 4 - 2)))
    assert found.statistic.q == 2


def test_each_is_as_sure_alone_as_among_others() -> None:
    base = HeldColumns(COLUMNS, np.full(4, 1e-12))
    together = scored([CHANGE, CHANGE[:, :1]], ROWS, base, 1.3, NONE)
    alone = [scored([each], ROWS, base, 1.3, NONE)[0] for each in (CHANGE, CHANGE[:, :1])]
    assert [each.p for each in together] == pytest.approx([each.p for each in alone])
    assert [each.nats for each in together] == pytest.approx([each.nats for each in alone])


def test_what_stands_in_the_base_is_not_seen() -> None:
    base = HeldColumns(COLUMNS, np.full(4, 1e-12))
    (found,) = scored([COLUMNS[:, :1]], ROWS, base, 1.0, NONE)
    assert found.statistic.q == 0
    assert found.p == 1


def test_what_arms_have_a_little_of_is_seen_and_less_sure() -> None:
    """The same column drawn with a standard deviation of 0.1: then 0.4 is four of these, and not some three of 0.13."""
    usual = HeldColumns(np.hstack([CHANGE[:, :1], COLUMNS]), np.array([1 / 0.1**2, *np.full(4, 1e-12)]), drawn=1)
    own = OwnErrors(CHANGE[:, :1], *[np.zeros(1, int)] * 3, np.ones(1), np.full(1, 8.0))
    (found,) = scored([CHANGE[:, :1]], ROWS, usual, 1.0, own)
    (sure,) = scored([CHANGE[:, :1]], ROWS, usual.fixed, 1.0, NONE)
    assert found.statistic.q == sure.statistic.q == 1
    assert 0 < found.statistic.f < sure.statistic.f
    # generalised least squares, written out
    covariance = np.eye(60) + 0.1**2 * CHANGE[:, :1] @ CHANGE[:, :1].T
    root = np.linalg.inv(np.linalg.cholesky(covariance))
    nested = [
        float(np.linalg.lstsq(root @ columns, root @ ROWS)[1][0])
        for columns in (COLUMNS, np.hstack([COLUMNS, CHANGE[:, :1]]))
    ]
    assert found.statistic.f == pytest.approx((nested[0] - nested[1]) / (nested[1] / (60 - 4 - 1)))


def test_what_is_known_from_few_numbers_makes_a_change_less_sure() -> None:
    """Of a variance of which half is known from 4 numbers, and half from 56: 1 / (0.5^2 / 4 + 0.5^2 / 56) = 14.9."""
    column = CHANGE[:, :1] / np.linalg.norm(CHANGE[:, 0])
    base = HeldColumns(column, np.ones(1), drawn=1)
    own = OwnErrors(column, *[np.zeros(1, int)] * 3, np.ones(1), np.full(1, 4.0))
    assert numbers_behind(base, base.beyond(column), 56, own) == pytest.approx(14.93, abs=0.01)
    assert numbers_behind(base.fixed, base.fixed.beyond(column), 56, own) == 56


def statistics(factor, seed, count=200, q=3, free=150):
    """F statistics of chance, times a factor."""
    drawn = f_distribution(q, free - q).rvs(count, random_state=seed)
    return [Statistic(factor * value, q, free) for value in drawn]


def test_chance_needs_no_factor_or_hardly_one():
    assert np.mean([overdispersion(statistics(1, seed)) for seed in range(20)]) < 1.2


@pytest.mark.parametrize("factor", [3, 30])
def test_the_factor_is_found_again(factor):
    found = [overdispersion(statistics(factor, seed)) for seed in range(20)]
    assert np.mean(found) == pytest.approx(factor, rel=0.25)


def test_what_cannot_be_seen_says_nothing():
    assert overdispersion([Statistic(1e9, 0, 100)]) == 1
    assert Statistic(1e9, 0, 100).p(1.0) == 1


def test_halves_are_of_equal_size_and_as_many_as_the_poses_have_directions():
    angles = np.random.default_rng(0).uniform(-1, 1, (40, 6))
    assert [half.sum() for half in halves(angles)] == [20, 20, 20, 20]
    angles[:, 1:] = 0.3
    assert len(list(halves(angles))) == 2
