import numpy as np
import pytest

from armscope.world.of_the_paper import Tracker, archimedes_spiral, rectangle

CORNERS = [[1.1, 0.8, 0.6], [1.1, -0.8, 0.6], [1.5, -0.8, 1.4], [1.5, 0.8, 1.4]]


def test_the_rectangle_has_fifty_targets_per_side_and_starts_where_the_paper_says():
    path = rectangle(CORNERS, 50)
    assert path.shape == (200, 3)
    assert path[[0, 50, 100, 150]].tolist() == CORNERS
    steps = np.linalg.norm(np.diff(np.vstack([path, path[:1]]), axis=0), axis=1).reshape(4, 50)
    assert np.ptp(steps, axis=1).max() < 1e-12  # straight and even along each side
    assert steps.sum() == pytest.approx(1.6 + np.hypot(0.4, 0.8) + 1.6 + np.hypot(0.4, 0.8))


@pytest.mark.parametrize(("plane", "axes", "third"), [("xy", [0, 1], 2), ("yz", [1, 2], 0)])
def test_the_spiral_obeys_equations_21_and_22(plane, axes, third):
    start = np.array([1.2, -0.6, 0.6])
    path = archimedes_spiral(start, plane, 0.02, 5, 200, 0.4)
    phi = np.arange(200) * 5 * np.pi / 200  # the printed step
    around = path[:, axes] - start[axes]
    assert np.allclose(around, 0.02 * phi[:, None] * np.column_stack([np.cos(phi), np.sin(phi)]), atol=1e-15)
    assert np.allclose(np.diff(path[:, third]), 0.4 / 200)
    assert path[0].tolist() == start.tolist()


POINTS = np.random.default_rng(0).uniform([0, -1, 0], [2, 1, 2], (400, 3))


def test_scatter_is_the_repeatability_of_a_mean_of_readings():
    """5 ppm at 5 m is 25 um per coordinate; the mean of 100 readings scatters by 2.5 um."""
    tracker = Tracker((0.0, 0.0, 0.0), accuracy=0.0, resolution=0.0)
    points = np.tile([3.0, 0.0, 4.0], (3000, 1))
    errors = tracker.measurement_errors(points, np.random.default_rng(1))
    assert errors.std(axis=0) == pytest.approx([2.5e-6] * 3, rel=0.06)


def test_accuracy_is_a_scale_and_a_turn_that_last_a_session():
    tracker = Tracker((4.0, 0.0, 1.5), repeatability=0.0, resolution=0.0)
    errors = tracker.measurement_errors(POINTS, np.random.default_rng(2))
    lever = POINTS - tracker.position
    columns = np.concatenate(
        [lever[:, :, None], np.stack([np.cross(axis, lever) for axis in np.eye(3)], axis=2)], axis=2
    )
    fit, residual, *_ = np.linalg.lstsq(columns.reshape(-1, 4), errors.ravel(), rcond=None)
    assert residual[0] < 1e-20
    assert np.all(np.abs(fit) < 50e-6)
    assert np.all(np.abs(fit) > 1e-8)


def test_over_many_sessions_the_accuracy_is_ten_ppm():
    tracker = Tracker((0.0, 0.0, 0.0), repeatability=0.0, resolution=0.0)
    point = np.array([[2.0, 0.0, 0.0]])
    errors = np.array([tracker.measurement_errors(point, np.random.default_rng(s))[0] for s in range(2000)])
    assert errors.std(axis=0) == pytest.approx([20e-6] * 3, rel=0.06)


def test_distances_come_in_steps_of_the_resolution():
    tracker = Tracker((0.0, 0.0, 0.0), accuracy=0.0, repeatability=0.0, resolution=1.26e-6, readings=1)
    measured = POINTS + tracker.measurement_errors(POINTS, np.random.default_rng(3))
    steps = np.linalg.norm(measured, axis=1) / 1.26e-6
    assert np.abs(steps - np.round(steps)).max() < 1e-3


def test_equal_seeds_measure_equally():
    tracker = Tracker((4.0, 0.0, 1.5))
    first, again = (tracker.measurement_errors(POINTS, np.random.default_rng(4)) for _ in range(2))
    assert np.array_equal(first, again)
    assert np.abs(first).max() < 3e-4
