"""Answers about rough arms in motion: what is rough may be named or left out, what isn't there may not be named."""

import pytest

from armscope.proof.motion.scoring import score
from tests.proof.motion.cases import effect, said, world

SMALL = [effect("link_mass", "link 2") | {"strength": 1.0}, effect("stribeck_friction", "joint 1") | {"strength": 4.9}]


def case(answers, effects=(), allowed=()):
    return score([world(effects, answers, category="rough", rough=SMALL, also_allowed=allowed)])["worlds"].iloc[0]


def test_what_is_rough_is_right_named_or_not():
    cause = effect()
    assert case([said()], [cause])["right"]
    assert case([said(), said("link_mass", "link 2")], [cause])["right"]


def test_a_cause_that_is_missed_or_a_name_of_nothing_is_wrong():
    assert not case([said("link_mass", "link 2")], [effect()])["right"]
    found = case([said(), said("cable_torque", "joint 1")], [effect()])
    assert not found["right"]
    assert not found["nothing_false"]


def test_something_unknown_is_never_wrong_and_no_cause_needs_no_name():
    assert case([], [])["right"]
    assert case([said("unknown", "joint 1")], [])["right"]


@pytest.mark.parametrize(("first", "right"), [("link_mass", False), ("stribeck_friction", True)])
def test_the_first_name_is_a_causes_or_of_something_as_large(first, right):
    place = {"link_mass": "link 2", "stribeck_friction": "joint 1"}[first]
    found = case([said(first, place), said()], [effect()])
    assert found["first"] == found["right"] == right


def test_names_that_are_as_good_are_no_wrong_ones():
    answers = [said(), said("payload_error", "payload")]
    assert not case(answers, [effect()])["right"]
    assert case(answers, [effect()], allowed=(("payload_error", "payload"),))["right"]


def test_other_arms_are_not_judged_so():
    row = score([world([effect()], [said()])])["worlds"].iloc[0]
    assert row[["first", "nothing_false", "right"]].isna().all()
