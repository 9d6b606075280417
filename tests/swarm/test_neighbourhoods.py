"""Who follows whom."""

import numpy as np

from armscope.swarm.neighbourhoods import global_best, ring_best

INF = np.inf


def test_all_follow_the_one_best_and_the_first_of_equals():
    fitness = np.array([[3.0, 1.0, 2.0, 1.0], [INF, INF, 5.0, INF]])
    assert global_best(fitness).tolist() == [[1], [2]]


def test_on_a_ring_each_follows_the_best_of_three_around_the_corner():
    fitness = np.array([[0.0, 9.0, 8.0, 7.0, 6.0]])
    assert ring_best(fitness).tolist() == [[0, 0, 3, 4, 0]]


def test_among_equals_a_particle_on_a_ring_follows_itself():
    assert ring_best(np.full((1, 4), 2.0)).tolist() == [[0, 1, 2, 3]]


def test_a_particle_that_never_had_a_fitness_follows_a_neighbour_that_had():
    assert ring_best(np.array([[INF, 4.0, INF, INF]])).tolist() == [[1, 1, 1, 3]]
