"""The oracle's power against simulation, and thresholds against curves with a known one."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import f

from armscope.proof.oracle import power, reliable_noncentrality, size_in_thresholds, threshold


def test_power_agrees_with_f_tests_on_simulated_rows():
    rng = np.random.default_rng(4)
    rows, columns, noncentrality, frame_numbers, repeats = 20, 2, 9.0, 21, 20000
    freedom = 3 * rows - frame_numbers - columns
    # in coordinates along and across the effect, least squares is a sum of squares
    along = rng.normal(size=(repeats, columns))
    along[:, 0] += np.sqrt(noncentrality)
    rest = rng.normal(size=(repeats, freedom))
    ratio = (along**2).sum(axis=1) / columns / ((rest**2).sum(axis=1) / freedom)
    found = (f.sf(ratio, columns, freedom) < 0.01).mean()
    assert power(noncentrality, columns, rows, frame_numbers) == pytest.approx(
        found, abs=4 * np.sqrt(found * (1 - found) / repeats)
    )


def test_nothing_to_see_is_found_as_often_as_false_alarms():
    assert power(0.0, 3, 100, 9) == pytest.approx(0.01)


def test_sizes_are_multiples_of_the_reliable_one():
    reliable = reliable_noncentrality(1, 100, 9)
    assert power(reliable, 1, 100, 9) == pytest.approx(0.9)
    assert size_in_thresholds(4 * reliable, 1, 100, 9) == pytest.approx(2.0)
    # one number, many rows: 2.576 + 1.282 standard errors
    assert np.sqrt(reliable_noncentrality(1, 3000, 9)) == pytest.approx(3.858, abs=0.01)


def test_the_threshold_of_a_known_curve_lies_in_its_interval():
    rng = np.random.default_rng(1)
    size = np.exp(rng.uniform(np.log(0.3), np.log(6), 600))
    found = rng.random(600) < 1 / (1 + np.exp(-4 * np.log(size / 1.2)))
    fitted = threshold(size, found, 0.5, rng)
    assert fitted.low < 1.2 < fitted.high
    assert fitted.high / fitted.low < 1.5
    reliable = threshold(size, found, 0.9, rng)
    assert reliable.low < 1.2 * 9**0.25 < reliable.high


@pytest.mark.parametrize("found", [np.ones(40, bool), np.zeros(40, bool)])
def test_cases_that_are_all_alike_tell_no_threshold(found):
    assert np.isnan(threshold(np.linspace(1, 2, 40), found, 0.9, np.random.default_rng(0)).value)


def test_cases_of_one_size_count_together_in_any_order():
    size = np.repeat([1.0, 2.0, 3.0], 10)
    found = np.arange(30) % 10 >= np.repeat([9, 5, 0], 10)  # one, five and ten of ten
    for seed in range(3):
        order = np.random.default_rng(seed).permutation(30)
        values = [threshold(size[order], found[order], share, np.random.default_rng(0)).value for share in (0.5, 0.6)]
        assert values == [2.0, 3.0]
