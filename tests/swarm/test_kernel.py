"""The compiled kernel walks the NumPy engine's way, whatever it shares its vectors with."""

import multiprocessing

import numpy as np
import pytest

from armscope.swarm.least_squares import minimise_least_squares
from armscope.swarm.least_squares_objective import LeastSquares
from armscope.swarm.result import StopReason
from armscope.swarm.settings import SwarmSettings
from armscope.swarm.streams import spawn_generators
from armscope.swarm.update import UpdateRule

pytest.importorskip("numba")

kernel = pytest.importorskip("armscope.swarm.kernel")


def problems(swarms: int, dimensions: int, orthonormal: bool, seed: int = 1) -> LeastSquares:
    generator = np.random.default_rng(seed)
    if orthonormal:
        factors = np.eye(dimensions)[None]
    else:
        columns = generator.normal(size=(3, 85, dimensions)) + generator.normal(size=(3, 1, dimensions))
        factors = np.stack([np.triu(np.linalg.qr(each)[1]) / np.sqrt(85) for each in columns])
    targets = generator.normal(size=(swarms, dimensions))
    return LeastSquares(factors, generator.integers(0, len(factors), swarms), targets, generator.random(swarms))


def run(engine, given, settings, seed=3, box=3.0):
    generators = spawn_generators(seed, len(given.targets))
    return minimise_least_squares(given, -box, [box] * given.targets.shape[1], generators, settings, engine), generators


RULES = [
    SwarmSettings(),
    SwarmSettings(neighbourhood="ring"),
    SwarmSettings(update="original"),
    SwarmSettings(update="inertia", velocity_clamp=0.1),
    SwarmSettings(update=UpdateRule(0.6, 1.1, 1.9), threshold=1.0, particles=33, iterations=90),
    SwarmSettings(particles=2, iterations=5),
    SwarmSettings(iterations=0),
]


@pytest.mark.parametrize("settings", RULES, ids=str)
@pytest.mark.parametrize("orthonormal", [True, False])
def test_kernel_and_numpy_engine_follow_the_same_trajectories(settings, orthonormal):
    given = problems(5, 6, orthonormal)
    (compiled, ours), (reference, theirs) = run("numba", given, settings), run("numpy", given, settings)
    assert np.allclose(compiled.history, reference.history, rtol=1e-11, atol=0)
    assert np.allclose(compiled.positions, reference.positions, rtol=1e-6, atol=1e-7)
    assert list(compiled.reasons) == list(reference.reasons)
    assert np.array_equal(compiled.iterations, reference.iterations)
    # both leave the callers' generators at the same place
    assert [g.random() for g in ours] == [g.random() for g in theirs]


def test_the_first_moves_agree_to_the_last_bit():
    given, settings = problems(5, 6, orthonormal=True), SwarmSettings(iterations=3)
    compiled, reference = run("numba", given, settings)[0], run("numpy", given, settings)[0]
    assert np.array_equal(compiled.positions, reference.positions)


@pytest.mark.parametrize("dimensions", [1, 3, 4, 5, 9, 25])
def test_triangular_products_of_all_sizes_are_right(dimensions):
    given = problems(3, dimensions, orthonormal=False)
    found = run("numba", given, SwarmSettings(iterations=5))[0]
    by_hand = given(found.positions[:, None, :], np.arange(3))[:, 0]
    assert np.allclose(found.fitness, by_hand, rtol=1e-13)


def same_bytes(first, second, rows=slice(None)) -> bool:
    return all(
        getattr(first, name).tobytes() == getattr(second, name)[rows].tobytes()
        for name in ("positions", "fitness", "history", "iterations")
    )


@pytest.mark.parametrize("orthonormal", [True, False])
def test_the_bits_do_not_depend_on_lane_or_pack(orthonormal):
    count = 2 * kernel.LANES + 3
    given = problems(count, 5, orthonormal)
    settings = SwarmSettings(particles=12, iterations=30, threshold=0.9)
    whole = run("numba", given, settings)[0]
    generators = spawn_generators(3, count)
    for rows in (slice(0, 1), slice(5, 9), slice(kernel.LANES - 1, kernel.LANES + 2), slice(count - 1, count)):
        part = LeastSquares(given.factors, given.factor_of[rows], given.targets[rows], given.rests[rows])
        found = minimise_least_squares(part, -3, [3] * 5, generators[rows], settings, "numba")
        assert same_bytes(found, whole, rows)


def _half(first: int) -> bytes:
    given, settings = problems(6, 4, orthonormal=True), SwarmSettings(particles=12, iterations=30)
    rows = slice(first, first + 3)
    part = LeastSquares(given.factors, given.factor_of[rows], given.targets[rows], given.rests[rows])
    return minimise_least_squares(part, -3, [3] * 4, spawn_generators(3, 6)[rows], settings).history.tobytes()


def test_the_bits_do_not_depend_on_the_number_of_processes():
    given, settings = problems(6, 4, orthonormal=True), SwarmSettings(particles=12, iterations=30)
    whole = minimise_least_squares(given, -3, [3] * 4, spawn_generators(3, 6), settings).history.tobytes()
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert b"".join(pool.map(_half, [0, 3])) == whole


def test_a_swarm_that_leaves_the_finite_numbers_stops_as_in_numpy():
    settings = SwarmSettings(particles=4, iterations=20000, update="original")
    given = problems(2, 2, orthonormal=False)
    compiled, reference = run("numba", given, settings)[0], run("numpy", given, settings)[0]
    assert list(compiled.reasons) == [StopReason.DIVERGED] * 2
    assert np.array_equal(compiled.iterations, reference.iterations)
    assert np.allclose(compiled.fitness, reference.fitness)


def test_a_fitness_that_is_never_finite_never_becomes_a_best():
    given = LeastSquares(np.eye(2)[None], np.zeros(1, dtype=int), np.full((1, 2), 1e200), np.zeros(1))
    compiled = run("numba", given, SwarmSettings(particles=4, iterations=3))[0]
    assert list(compiled.reasons) == [StopReason.NEVER_FINITE]
    assert np.isnan(compiled.positions).all()


def test_each_swarm_has_its_own_box():
    given = LeastSquares(np.eye(1)[None], np.zeros(2, dtype=int), np.zeros((2, 1)), np.zeros(2))
    found = minimise_least_squares(
        given, [[2.0], [-9.0]], [[3.0], [-8.0]], spawn_generators(1, 2), SwarmSettings(iterations=0), "numba"
    )
    assert 2 <= found.positions[0, 0] <= 3
    assert -9 <= found.positions[1, 0] <= -8


@pytest.mark.parametrize("engine", ["numba", "numpy"])
@pytest.mark.parametrize("box", [1.0, [1.0] * 3, [1.0] * 5])
def test_a_box_of_other_dimensions_is_refused_and_not_read_beyond_its_end(engine, box):
    given = problems(2, 4, True)
    with pytest.raises(ValueError, match=r"a box of \d dimensions for problems of 4 coefficients"):
        minimise_least_squares(given, np.negative(box), box, spawn_generators(3, 2), None, engine)
