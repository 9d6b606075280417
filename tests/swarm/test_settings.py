"""Settings that can't work are refused, with their name, their value and the rule."""

import numpy as np
import pytest

from armscope.swarm.settings import SwarmSettings, global_best, ring_best
from armscope.swarm.update import UpdateRule


def test_the_defaults_are_the_papers_numbers():
    settings = SwarmSettings()
    assert (settings.particles, settings.iterations) == (100, 200)
    assert (settings.rule.cognitive, settings.rule.social) == (2.05, 2.05)


def test_a_rule_of_ones_own_is_taken():
    rule = UpdateRule(0.6, 1.7, 1.7)
    assert SwarmSettings(update=rule).rule is rule


@pytest.mark.parametrize(
    ("wrong", "rule"),
    [
        ({"particles": 1}, "2 or more"),
        ({"particles": 2.5}, "whole number"),
        ({"particles": True}, "whole number"),
        ({"iterations": -1}, "0 or more"),
        ({"update": "constricted"}, "original, constriction, inertia"),
        ({"neighbourhood": "star"}, "gbest, ring"),
        ({"velocity_clamp": 0.0}, "above 0"),
        ({"velocity_clamp": float("nan")}, "finite"),
        ({"threshold": float("inf")}, "finite"),
        ({"threshold": "small"}, "finite"),
    ],
)
def test_a_wrong_setting_is_named_with_its_value_and_the_rule(wrong, rule):
    (name, value), *_ = wrong.items()
    with pytest.raises(ValueError, match=rule) as error:
        SwarmSettings(**wrong)
    assert name in str(error.value)
    assert repr(value) in str(error.value)


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
