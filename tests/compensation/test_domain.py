"""Where a model holds: an outer bound of the data's convex hull."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from armscope.compensation import domain as module
from armscope.compensation.constants import RANGE
from armscope.compensation.domain import Domain


def rows(count=60, seed=0):
    return np.random.default_rng(seed).uniform(-1, 1, (count, 3)) * [1.0, 0.5, 2.0]


@given(st.integers(0, 10_000))
def test_every_mixture_of_identification_rows_is_inside(seed):
    data = rows()
    domain = Domain.of(data, ["q1", "q2", "q3"], ["rad"] * 3)
    mixture = np.random.default_rng(seed).dirichlet(np.full(len(data), 0.1), 5) @ data
    distance, what = domain.outside(mixture)
    assert np.all(distance < 1e-9)
    assert np.all(domain.nearest(data) < 1e-4)
    assert len(what) == 5


def test_a_long_table_has_the_extent_of_all_its_pieces(monkeypatch):
    whole = Domain.of(rows(), ["q1", "q2", "q3"], ["rad"] * 3)
    monkeypatch.setattr(module, "RANGE", replace(RANGE, rows_at_a_time=7))
    pieces = Domain.of(rows(), ["q1", "q2", "q3"], ["rad"] * 3)
    for name in ("low", "high", "standardised_rows"):
        np.testing.assert_allclose(getattr(pieces, name), getattr(whole, name), atol=1e-12)


def test_distance_is_counted_in_standard_deviations_of_the_input_that_leaves():
    data = rows()
    domain = Domain.of(data, ["q1", "q2", "q3"], ["rad"] * 3)
    point = data[np.argmax(data[:, 1])].copy()
    point[1] += 0.7 * data[:, 1].std()
    distance, what = domain.outside(point[None])
    assert distance[0] == pytest.approx(0.7)
    assert what[0] == "q2"


def test_joints_that_moved_in_lockstep_may_not_part_although_each_stays_in_its_range():
    rng = np.random.default_rng(2)
    together = rng.uniform(-1, 1, 80)
    data = np.column_stack([together, 0.6 * together + 0.001 * rng.normal(size=80), rng.uniform(-1, 1, 80)])
    domain = Domain.of(data, ["q1", "q2", "q3"], ["rad"] * 3)
    distance, what = domain.outside(np.array([[0.5, -0.3, 0.0], [0.5, 0.3, 0.0]]))
    assert distance[0] > 1.0
    assert what[0] == "q1 together with q2"
    assert distance[1] < 0.1


def test_an_input_that_stood_still_may_leave_by_its_tolerance_only():
    data = rows()
    data[:, 2] = 0.3
    domain = Domain.of(data, ["q1", "q2", "q3"], ["rad"] * 3)
    assert domain.still("rad") == {"q3": pytest.approx(0.3)}
    middle = data.mean(axis=0)
    distance, _ = domain.outside(middle + np.array([[0, 0, 0.019], [0, 0, 0.021]]))
    assert distance[0] < domain.allowed < distance[1]


@pytest.mark.parametrize("count", [40, 60, 150])
def test_poses_drawn_as_the_recorded_ones_were_are_inside(count):
    rng = np.random.default_rng(count)
    names, units = [f"q{i}" for i in range(1, 7)], ["rad"] * 6
    outside = []
    for _ in range(20):
        domain = Domain.of(rng.uniform(-1, 1, (count, 6)), names, units)
        outside.append(domain.outside(rng.uniform(-1, 1, (200, 6)))[0] > domain.allowed)
    assert 0.005 < np.mean(outside) < 0.1


def test_one_pose_far_from_all_others_does_not_open_the_range_to_everything():
    data = rows()
    usual = Domain.of(data, ["q1", "q2", "q3"], ["rad"] * 3).allowed
    data[0] = 8.0
    assert Domain.of(data, ["q1", "q2", "q3"], ["rad"] * 3).allowed < usual + 0.1


def test_corners_of_a_design_are_bounded_by_their_neighbours():
    corners = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T.repeat(8, axis=0)
    assert Domain.of(corners, ["q1", "q2", "q3"], ["rad"] * 3).allowed == RANGE.allowed


def test_a_domain_comes_back_from_its_plain_values():
    data = rows()
    domain = Domain.of(data, ["q1", "q2", "q3"], ["rad"] * 3)
    again = Domain.from_dict(domain.to_dict())
    probe = rows(20, 5) * 1.5
    np.testing.assert_allclose(again.outside(probe)[0], domain.outside(probe)[0], atol=1e-12)
    np.testing.assert_allclose(again.nearest(probe), domain.nearest(probe), atol=1e-3)


def test_inputs_of_different_kinds_need_not_stay_in_step():
    together = np.linspace(-1, 1, 80)
    warming = Domain.of(np.column_stack([together, 22 + 5 * together]), ["q1", "temperature_c"], ["rad", "degC"])
    assert warming.outside(np.array([[0.9, 18.0]]))[0][0] == 0.0
