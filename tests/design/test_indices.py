import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from armscope.design.indices import (
    SOURCES,
    all_indices,
    observability,
    observability_slopes,
)


def test_each_index_is_its_formula():
    s, n = np.array([3.0, 2.0, 0.5]), 16
    expected = {
        "O1": (3 * 2 * 0.5) ** (1 / 3) / 4,
        "O2": 0.5 / 3,
        "O3": 0.5,
        "O4": 0.25 / 3,
        "O5": 1 / (1 / 3 + 1 / 2 + 1 / 0.5),
    }
    assert {name: float(observability(name, s, n)) for name in SOURCES} == pytest.approx(expected)
    assert set(expected) == set(SOURCES)


@given(st.integers(0, 10_000))
def test_one_more_pose_never_hides_a_direction(seed):
    """O3 and O5 follow the information alone, which only grows (Weyl's inequality)."""
    rng = np.random.default_rng(seed)
    jacobian = rng.normal(size=(5, 3, 4))
    fewer, more = all_indices(jacobian[:4]), all_indices(jacobian)
    assert more["O3"] >= fewer["O3"] * (1 - 1e-12)
    assert more["O5"] >= fewer["O5"] * (1 - 1e-12)


@pytest.mark.parametrize("index", list(SOURCES))
def test_slopes_are_those_of_finite_differences(index):
    values = np.array([5.0, 2.0, 1.1, 0.4])  # eigenvalues of the information
    for k in range(4):
        step = np.zeros(4)
        step[k] = 1e-6
        up, down = (float(observability(index, np.sqrt(values + sign * step), 7)) for sign in (1, -1))
        assert observability_slopes(index, np.sqrt(values))[k] == pytest.approx(
            (np.log(up) - np.log(down)) / 2e-6, abs=1e-6
        )


def test_what_cannot_be_told_has_no_observability():
    twins = np.repeat(np.random.default_rng(0).normal(size=(6, 3, 2)), 2, axis=2)
    assert all_indices(twins)["O3"] == pytest.approx(0, abs=1e-12)
    assert all_indices(twins[:1]) == dict.fromkeys(SOURCES, 0.0)  # 3 numbers for 4 parameters
