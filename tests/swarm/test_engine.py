"""The swarm itself, on functions whose minimum is known."""

import numpy as np
import pytest

from armscope.swarm.engine import minimise
from armscope.swarm.result import StopReason, SwarmResult
from armscope.swarm.settings import SwarmSettings
from armscope.swarm.streams import spawn_generators

SMALL = SwarmSettings(particles=20, iterations=40)


def sphere(positions, swarms):
    return np.sum((positions - 0.5) ** 2, axis=2)


def rosenbrock(positions, swarms):
    x, y = positions[..., 0], positions[..., 1]
    return (1 - x) ** 2 + 100 * (y - x**2) ** 2


def same(first: SwarmResult, second: SwarmResult) -> bool:
    return all(
        getattr(first, name).tobytes() == getattr(second, name).tobytes()
        for name in ("positions", "fitness", "history", "iterations")
    ) and list(first.reasons) == list(second.reasons)


def last_improvement(found: SwarmResult):
    """The iteration of each swarm's last improvement (0: the best stood there from the start)."""
    falls = np.diff(found.history, axis=1) < 0
    return np.max(falls * np.arange(1, found.history.shape[1]), axis=1, initial=0)


def test_the_minimum_of_a_sphere_is_found():
    found = minimise(sphere, [-5, -5, -5], [5, 5, 5], spawn_generators(1, 3), SwarmSettings())
    assert np.allclose(found.positions, 0.5, atol=1e-6)
    assert (found.fitness < 1e-12).all()


def test_the_minimum_of_rosenbrocks_valley_is_found():
    found = minimise(rosenbrock, -2, [2, 2], spawn_generators(1, 5), SwarmSettings())
    assert np.allclose(found.positions, 1.0, atol=1e-3)


def test_a_ring_finds_it_too_but_later():
    ring = SwarmSettings(neighbourhood="ring")
    slow = minimise(sphere, -5, [5] * 4, spawn_generators(1, 5), ring)
    fast = minimise(sphere, -5, [5] * 4, spawn_generators(1, 5), SwarmSettings())
    assert (slow.fitness < 1e-4).all()
    assert (slow.history[:, 60] > fast.history[:, 60]).all()


def test_each_swarm_may_have_its_own_box_and_its_own_objective():
    centres = np.array([[1.0, 2.0], [-30.0, 5.0]])

    def around_its_centre(positions, swarms):
        return np.sum((positions - centres[swarms, None, :]) ** 2, axis=2)

    found = minimise(around_its_centre, centres - 3, centres + 3, spawn_generators(4, 2), SwarmSettings())
    assert np.allclose(found.positions, centres, atol=1e-5)


@pytest.mark.parametrize("settings", [SMALL, SwarmSettings(20, 40, "inertia", "ring", 0.2, 1e-3)])
def test_the_bits_do_not_depend_on_the_chunk(settings):
    whole = minimise(sphere, -5, [5] * 3, spawn_generators(1, 7), settings, chunk=7)
    for chunk in (1, 2, 5, 100, None):
        assert same(whole, minimise(sphere, -5, [5] * 3, spawn_generators(1, 7), settings, chunk=chunk))


def test_a_swarm_computed_alone_is_the_same_as_in_company():
    whole = minimise(sphere, -5, [5] * 3, spawn_generators(1, 6), SMALL)
    parts = [minimise(sphere, -5, [5] * 3, [generator], SMALL) for generator in spawn_generators(1, 6)]
    assert same(whole, SwarmResult.joined(parts))


def test_the_same_seed_gives_the_same_bytes_and_another_does_not():
    first, again, other = (minimise(sphere, -5, [5] * 3, spawn_generators(s, 2), SMALL) for s in (8, 8, 9))
    assert same(first, again)
    assert not np.any(first.fitness == other.fitness)
    assert first.fitness[0] != first.fitness[1]


def test_the_history_never_rises_and_ends_at_the_result():
    found = minimise(rosenbrock, -2, [2, 2], spawn_generators(3, 4), SMALL)
    assert found.history.shape == (4, 41)
    assert (np.diff(found.history, axis=1) <= 0).all()
    assert np.array_equal(found.history[:, -1], found.fitness)
    assert np.array_equal(found.fitness, rosenbrock(found.positions[:, None, :], None)[:, 0])


def test_the_formula_as_printed_diverges():
    def sizes(update):
        largest = []

        def spy(positions, swarms):
            largest.append(np.sqrt(np.mean(positions**2)))
            return sphere(positions, swarms)

        found = minimise(spy, -5, [5] * 5, spawn_generators(1, 10), SwarmSettings(update=update), chunk=10)
        return largest[-1] / largest[0], found

    growth, original = sizes("original")
    shrinking, constricted = sizes("constriction")
    assert growth > 1.05**200
    assert shrinking < 1
    assert np.median(last_improvement(original)) < 20
    assert np.median(last_improvement(constricted)) > 190
    assert (original.fitness > 1e6 * constricted.fitness).all()


def test_a_swarm_stops_at_the_threshold_and_repeats_its_last_value():
    settings = SwarmSettings(particles=20, iterations=200, threshold=1e-3)
    found = minimise(sphere, -5, [5] * 2, spawn_generators(1, 6), settings)
    for swarm in range(6):
        at = found.iterations[swarm]
        assert found.reasons[swarm] is StopReason.THRESHOLD
        assert found.history[swarm, at - 1] >= 1e-3 > found.history[swarm, at]
        assert (found.history[swarm, at:] == found.fitness[swarm]).all()
    assert len(set(found.iterations)) > 1


def test_a_threshold_does_not_change_the_way_there():
    stopped = minimise(sphere, -5, [5] * 2, spawn_generators(1, 6), SwarmSettings(threshold=1e-3))
    whole = minimise(sphere, -5, [5] * 2, spawn_generators(1, 6), SwarmSettings())
    for swarm, at in enumerate(stopped.iterations):
        assert np.array_equal(stopped.history[swarm, : at + 1], whole.history[swarm, : at + 1])


def test_without_a_threshold_all_iterations_are_used():
    found = minimise(sphere, -5, [5], spawn_generators(1, 2), SMALL)
    assert list(found.reasons) == [StopReason.ITERATIONS] * 2
    assert found.iterations.tolist() == [40, 40]


@pytest.mark.parametrize("poison", [np.nan, np.inf, -np.inf])
def test_a_poisoned_fitness_never_becomes_a_best(poison):
    def poisoned(positions, swarms):
        fitness = sphere(positions, swarms)
        return np.where(positions[..., 0] < 0.4, poison, fitness)  # the way to the minimum leads past the poison

    found = minimise(poisoned, -5, [5] * 2, spawn_generators(1, 5), SMALL)
    assert np.isfinite(found.history[:, 1:]).all()
    assert (found.positions[:, 0] >= 0.4).all()
    assert (found.fitness < 0.01).all()


def test_a_swarm_that_never_sees_a_finite_fitness_says_so():
    found = minimise(
        lambda positions, swarms: np.full(positions.shape[:2], np.nan), 0, [1], spawn_generators(1, 2), SMALL
    )
    assert list(found.reasons) == [StopReason.NEVER_FINITE] * 2
    assert np.isnan(found.positions).all()
    assert np.isinf(found.fitness).all()


def test_a_swarm_that_leaves_the_finite_numbers_says_so_and_keeps_what_it_had():
    settings = SwarmSettings(particles=5, iterations=20000, update="original")
    found = minimise(sphere, -5, [5], spawn_generators(1, 2), settings)
    assert list(found.reasons) == [StopReason.DIVERGED] * 2
    assert (found.iterations < 20000).all()
    assert np.isfinite(found.fitness).all()
    assert np.isfinite(found.positions).all()


def test_an_objective_that_is_best_at_infinity_does_not_get_there():
    settings = SwarmSettings(particles=5, iterations=20000, update="original")
    found = minimise(
        lambda positions, swarms: 1 / (1 + positions[..., 0] ** 2), -5, [5], spawn_generators(1, 1), settings
    )
    assert np.isfinite(found.positions).all()


def test_no_iterations_means_the_best_of_the_start():
    found = minimise(sphere, -5, [5] * 2, spawn_generators(1, 2), SwarmSettings(particles=10, iterations=0))
    assert found.history.shape == (2, 1)
    assert last_improvement(found).tolist() == [0, 0]


def test_particles_start_in_the_box_and_at_rest():
    seen = []

    def spy(positions, swarms):
        seen.append(positions.copy())
        return sphere(positions, swarms)

    minimise(spy, [2, -1], [3, 7], spawn_generators(1, 1), SwarmSettings(particles=4000, iterations=0))
    start = seen[0][0]
    assert (start >= [2, -1]).all()
    assert (start <= [3, 7]).all()
    assert np.allclose(start.mean(axis=0), [2.5, 3.0], atol=0.2)


@pytest.mark.parametrize(
    ("lower", "upper", "rule"),
    [
        ([0, 2], [1, 1], "must not exceed"),
        ([0, np.nan], [1, 1], "finite"),
        ([0, -np.inf], [1, 1], "finite"),
        ([0, 0, 0], [1, 1], "must be D or 2 x D"),
        (np.zeros((3, 2)), np.ones((3, 2)), "must be D or 2 x D"),
        ([], [], "at least one"),
        ([-1.7e308], [1.7e308], "must be finite"),
    ],
)
def test_a_box_that_can_not_be_searched_is_refused(lower, upper, rule):
    with pytest.raises(ValueError, match=rule):
        minimise(sphere, lower, upper, spawn_generators(1, 2), SMALL)


def test_an_objective_of_the_wrong_shape_is_refused():
    with pytest.raises(ValueError, match="the shape"):
        minimise(lambda positions, swarms: np.zeros(3), 0, [1], spawn_generators(1, 2), SMALL)


def test_a_box_without_width_stays_where_it_is():
    found = minimise(sphere, [1.0, 2.0], [1.0, 2.0], spawn_generators(1, 1), SMALL)
    assert found.positions.tolist() == [[1.0, 2.0]]
