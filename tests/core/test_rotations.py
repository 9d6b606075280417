"""Turns are those of scipy, which is another implementation."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.core.rotations import cross, cross_matrices, turn_onto, turned_by


@pytest.mark.parametrize("size", [0.0, 1e-12, 1e-6, 0.99e-4, 1.01e-4, 1e-2, 1.0, 3.1, 3.14159265, 40.0])
def test_a_rotation_vector_turns_as_scipys_does(size: float) -> None:
    vectors = np.random.default_rng(0).normal(size=(50, 3))
    vectors *= size / np.linalg.norm(vectors, axis=1, keepdims=True)
    assert turned_by(vectors) == pytest.approx(Rotation.from_rotvec(vectors).as_matrix(), abs=3e-15 * max(1, size))
    assert turned_by(vectors[0]) == pytest.approx(turned_by(vectors)[0], abs=1e-16)
    assert turned_by(vectors.reshape(5, 10, 3)).shape == (5, 10, 3, 3)


def test_a_cross_matrix_multiplies_as_the_cross_product_does() -> None:
    one, other = np.random.default_rng(1).normal(size=(2, 20, 3))
    assert np.einsum("nij,nj->ni", cross_matrices(one), other) == pytest.approx(np.cross(one, other))
    np.testing.assert_array_equal(cross(one, other), np.cross(one, other))
    np.testing.assert_array_equal(cross(one[0], other), np.cross(one[0], other))


@pytest.mark.parametrize("flat", [False, True])
def test_points_are_turned_as_scipy_aligns_them_and_never_mirrored(flat: bool) -> None:
    rng = np.random.default_rng(2)
    points = rng.normal(size=(30, 3)) * [1, 1, not flat]
    wanted = points @ Rotation.from_rotvec([0.4, -2.0, 1.0]).as_matrix().T + rng.normal(0, 1e-2, (30, 3))
    assert turn_onto(points, wanted) == pytest.approx(Rotation.align_vectors(wanted, points)[0].as_matrix(), abs=1e-12)
    assert np.linalg.det(turn_onto(points, wanted * [1, 1, -1])) == pytest.approx(1)
