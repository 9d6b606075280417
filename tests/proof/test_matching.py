"""Who is who: concealed effects and what a verdict calls them."""

from __future__ import annotations

import itertools

from armscope.proof.matching import among_all, distinct, match, name_row
from tests.proof.cases import claim, concealed

OFFSET = concealed("joint_offset", "joint 2")
COMPLIANCE = concealed("joint_compliance", "joint 2", alternatives=[("gear_eccentricity", "joint 2")])


def outcomes(truths, claims):
    matches, left = match(truths, distinct(claims))
    return [m.outcome for m in matches], [c.name for c in left]


def test_a_right_name_at_the_wrong_place_is_no_match():
    assert outcomes([OFFSET], [claim("joint_offset", "joint 3")]) == (["missed"], [("joint_offset", "joint 3")])


def test_a_wrong_name_at_the_right_place_is_located_and_stays_wrong():
    assert outcomes([OFFSET], [claim("gear_ratio", "joint 2")]) == (["located"], [("gear_ratio", "joint 2")])
    assert outcomes([OFFSET], [claim("link_geometry", "link 2")])[0] == ["located"]


def test_a_sealed_alternative_is_acceptable_but_one_that_only_the_verdict_lists_is_not():
    assert outcomes([COMPLIANCE], [claim("gear_eccentricity", "joint 2")]) == (["acceptable"], [])
    listing = claim("gear_ratio", "joint 5", alternatives=[("joint_offset", "joint 2")])
    assert outcomes([OFFSET], [listing]) == (["listed"], [("gear_ratio", "joint 5")])
    assert among_all(OFFSET, [listing])
    assert not among_all(COMPLIANCE, [listing])


def test_a_name_that_would_do_elsewhere_has_the_right_effect_whether_it_is_the_own_or_an_alternative():
    said = [claim(effect, "joint 5") for effect in ("joint_compliance", "gear_eccentricity", "joint_offset")]
    assert [name_row([COMPLIANCE], each, False)["effect_right"] for each in said] == [True, True, False]


def test_own_names_go_before_alternatives_in_whatever_order_they_stand():
    eccentric = concealed("gear_eccentricity", "joint 2")
    claims = [claim("gear_eccentricity", "joint 2"), claim("joint_compliance", "joint 2")]
    for truths in itertools.permutations([COMPLIANCE, eccentric]):
        for said in itertools.permutations(claims):
            assert outcomes(truths, said) == (["named", "named"], [])


def test_one_name_cannot_stand_for_two_concealed_effects():
    twin = concealed("joint_offset", "joint 3", alternatives=[("joint_offset", "joint 2")])
    found, left = outcomes([OFFSET, twin], [claim("joint_offset", "joint 2")])
    assert sorted(found) == ["missed", "named"]
    assert not left


def test_a_name_stands_for_the_story_before_it_stands_for_the_background():
    background = concealed("gear_eccentricity", "joint 2", minor=True)
    for truths in itertools.permutations([COMPLIANCE, background]):
        matches, left = match(truths, [claim("gear_eccentricity", "joint 2")])
        assert {m.truth.minor: m.outcome for m in matches} == {False: "acceptable", True: "missed"}
        assert not left


def test_waves_of_one_effect_at_one_place_are_one_name():
    claims = [claim("gear_mesh", "joint 1", minor=True, rms=0.2), claim("gear_mesh", "joint 1", rms=0.1)]
    (only,) = distinct(claims)
    assert not only.minor
    assert only.rms_mm == 0.2
