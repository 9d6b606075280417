"""The baseline has the swarm's budget, and the swarm beats it."""

import numpy as np

from armscope.swarm.engine import minimise
from armscope.swarm.random_search import random_search
from armscope.swarm.result import StopReason
from armscope.swarm.settings import SwarmSettings
from armscope.swarm.streams import spawn_generators


def sphere(positions, swarms):
    return np.sum((positions - 0.5) ** 2, axis=2)


def test_it_evaluates_as_often_as_a_swarm_and_keeps_the_best():
    seen = []

    def spy(positions, swarms):
        seen.append(positions)
        return sphere(positions, swarms)

    settings = SwarmSettings(particles=7, iterations=9)
    found = random_search(spy, -1, [1, 1], spawn_generators(2, 1), settings)
    points = np.concatenate(seen).reshape(-1, 2)
    assert len(points) == 70
    assert found.fitness[0] == sphere(points[None], None).min()
    assert found.history.shape == (1, 10)


def test_a_swarm_gets_closer_with_as_many_evaluations():
    settings = SwarmSettings(particles=30, iterations=60)
    random = random_search(sphere, -5, [5] * 4, spawn_generators(2, 5), settings)
    swarm = minimise(sphere, -5, [5] * 4, spawn_generators(2, 5), settings)
    assert (swarm.fitness < 0.01 * random.fitness).all()


def test_it_stops_at_the_threshold_and_ignores_nan():
    def poisoned(positions, swarms):
        return np.where(positions[..., 0] < 0, np.nan, sphere(positions, swarms))

    settings = SwarmSettings(particles=10, iterations=100, threshold=0.05)
    found = random_search(poisoned, -1, [1, 1], spawn_generators(2, 4), settings)
    assert list(found.reasons) == [StopReason.THRESHOLD] * 4
    assert (found.iterations < 100).all()
    assert (found.positions[:, 0] >= 0).all()
    assert np.array_equal(found.fitness, sphere(found.positions[:, None], None)[:, 0])


def test_nothing_finite_is_said():
    found = random_search(
        lambda positions, swarms: np.full(positions.shape[:2], np.inf),
        0,
        [1],
        spawn_generators(1, 1),
        SwarmSettings(5, 5),
    )
    assert found.reasons[0] is StopReason.NEVER_FINITE
    assert np.isnan(found.positions).all()
