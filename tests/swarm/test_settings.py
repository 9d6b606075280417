"""Settings that can't work are refused, with their name, their value and the rule."""

import pytest

from armscope.swarm.settings import SwarmSettings
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
