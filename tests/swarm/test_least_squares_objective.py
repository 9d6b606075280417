"""The triangular factor gives the residual of all rows, and the swarm finds its minimum."""

import numpy as np
import pytest

from armscope.swarm.least_squares import minimise_least_squares
from armscope.swarm.least_squares_objective import LeastSquares
from armscope.swarm.settings import SwarmSettings
from armscope.swarm.streams import spawn_generators


@pytest.fixture
def rows():
    generator = np.random.default_rng(5)
    return generator.normal(size=(40, 3)), generator.normal(size=(40, 2))


def as_problem(columns, errors) -> LeastSquares:
    q, r = np.linalg.qr(columns)
    count = len(columns)
    rests = np.mean((errors - q @ (q.T @ errors)) ** 2, axis=0)
    return LeastSquares(
        np.triu(r)[None] / np.sqrt(count), np.zeros(2, dtype=int), (q.T @ errors).T / np.sqrt(count), rests
    )


def test_the_fitness_is_the_rms_residual_over_all_rows(rows):
    columns, errors = rows
    points = np.random.default_rng(1).normal(size=(2, 5, 3))
    fitness = as_problem(columns, errors)(points, np.arange(2))
    for swarm in range(2):
        residuals = errors[:, [swarm]] - columns @ points[swarm].T
        assert np.allclose(fitness[swarm], np.sqrt(np.mean(residuals**2, axis=0)), rtol=1e-13)


@pytest.mark.parametrize("engine", ["auto", "numpy"])
def test_a_swarm_reaches_the_least_squares_solution(rows, engine):
    columns, errors = rows
    found = minimise_least_squares(as_problem(columns, errors), -2, [2] * 3, spawn_generators(1, 2), engine=engine)
    assert np.allclose(found.positions, np.linalg.lstsq(columns, errors, rcond=None)[0].T, atol=1e-6)


def test_a_generator_that_the_kernel_does_not_know_is_left_to_numpy(rows):
    generators = [np.random.default_rng(seed) for seed in (1, 2)]
    problem, settings = as_problem(*rows), SwarmSettings(iterations=3)
    assert np.isfinite(minimise_least_squares(problem, -2, [2] * 3, generators, settings).fitness).all()
    with pytest.raises(ValueError, match="SFC64"):
        minimise_least_squares(problem, -2, [2] * 3, generators, settings, engine="numba")


@pytest.mark.parametrize(
    ("change", "rule"),
    [
        ({"factors": np.ones((1, 3, 3))}, "upper triangular"),
        ({"factors": np.eye(2)[None]}, "upper triangular"),
        ({"rests": np.zeros(3)}, "for each of the 2 swarms"),
        ({"factor_of": np.array([0, 5])}, "factor_of"),
    ],
)
def test_problems_that_do_not_fit_together_are_refused(rows, change, rule):
    good = as_problem(*rows)
    parts = {name: getattr(good, name) for name in ("factors", "factor_of", "targets", "rests")} | change
    with pytest.raises(ValueError, match=rule):
        LeastSquares(**parts)


def test_wrong_engine_and_wrong_number_of_generators_are_refused(rows):
    with pytest.raises(ValueError, match="auto, numba, numpy"):
        minimise_least_squares(as_problem(*rows), -2, [2] * 3, spawn_generators(1, 2), engine="fortran")
    with pytest.raises(ValueError, match="one is needed for each"):
        minimise_least_squares(as_problem(*rows), -2, [2] * 3, spawn_generators(1, 3))
