import numpy as np
import pytest

from armscope.world.trajectories import archimedes_spiral, rectangle

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
