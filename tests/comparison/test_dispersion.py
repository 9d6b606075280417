"""What differs inside a recording makes changes between recordings less sure, and noise does not."""

import numpy as np
import pytest
from scipy.stats import f as f_distribution

from armscope.comparison.dispersion import Statistic, halves, overdispersion


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
