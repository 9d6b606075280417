"""What can't be told apart is known beforehand."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.world.catalogue import KINDS
from armscope.world.effects import LIBRARY
from armscope.world.kinds import Concealed
from armscope.world.rivals import Judge, rivals
from armscope.world.strength import sized, stand
from tests.world.by_hand import ARMS
from tests.world.scenes import drawn, scene_of

SIGMA = 3e-5


def judged(arm, kind, place, rule="free", strength=5.0, values=None, beside=()):
    scene, tool = scene_of(arm, rule, count=120)
    effect = drawn(scene, kind, place)
    if values:
        effect = Concealed(effect.kind, place, {**effect.values, **values})
    found = sized(scene, effect, strength * SIGMA)
    return Judge(scene, tool).visibility(found, [sized(scene, other, 5 * SIGMA) for other in beside], SIGMA)


def names(visibility):
    return {(a.effect, a.location) for a in visibility.alternatives}


@pytest.mark.parametrize("arm", ARMS)
def test_the_patterns_of_each_effect_make_what_the_engine_simulates(arm):
    """Every effect but those left out, at two places, simulated small: its own patterns explain it to a percent."""
    scene, _ = scene_of(arm, count=30)
    known = rivals(scene)
    for kind in LIBRARY:
        if kind.effect in ("gear_mesh", "payload_error", "base_shift") or kind.name == "backlash/load":
            continue
        for place in kind.places(scene.description)[2:4] or kind.places(scene.description)[:1]:
            effect = drawn(scene, kind.name, place).scaled(0.1)
            displacement = (stand(scene, [effect]).tool - stand(scene, []).tool).ravel()
            own = [r.columns for r in known if (r.effect, r.location) == (kind.effect, place)]
            left = [np.linalg.norm(displacement - c @ np.linalg.lstsq(c, displacement, rcond=None)[0]) for c in own]
            assert min(left) < 0.01 * np.linalg.norm(displacement), (kind.name, place)


def test_a_tilting_base_and_a_tilting_first_bearing_are_one_where_their_origins_coincide():
    assert ("bearing_compliance", "joint 1") in names(judged("six-axis", "base_compliance", "base"))


def test_they_are_two_where_the_first_axis_has_its_origin_above_the_base():
    assert names(judged("seven-axis", "base_compliance", "base")) == set()


def test_without_payload_changes_a_parallelograms_soft_motor_2_looks_like_an_eccentric_gear():
    found = judged("parallelogram-120kg", "joint_compliance", "joint 2", "no_payload")
    assert ("gear_eccentricity", "joint 2") in names(found)


def test_payload_changes_tell_them_apart():
    assert names(judged("parallelogram-120kg", "joint_compliance", "joint 2")) == set()


def test_a_lag_at_speeds_in_step_with_the_angle_looks_like_a_gear_ratio():
    assert ("gear_ratio", "joint 3") in names(judged("seven-axis", "servo_lag", "joint 3", "constant_speed"))
    assert names(judged("seven-axis", "servo_lag", "joint 3")) == set()


def test_the_oracle_sees_strength_squared_per_coordinate_of_an_effect_alone():
    assert judged("six-axis", "gear_mesh", "joint 4", strength=5.0).noncentrality == pytest.approx(25 * 360, rel=0.01)


def test_beside_an_effect_that_shares_its_pattern_less_is_left_to_see():
    scene, _ = scene_of("six-axis", count=120)
    alone = judged("six-axis", "joint_offset", "joint 3")
    crowded = judged("six-axis", "joint_offset", "joint 3", beside=[drawn(scene, "joint_offset", "joint 2")])
    assert crowded.noncentrality < 0.9 * alone.noncentrality


def test_nothing_is_an_alternative_to_what_nobody_can_see():
    assert judged("six-axis", "joint_offset", "joint 3", strength=0.01).alternatives == ()


def test_kinds_have_distinct_names():
    assert len(KINDS) == len({kind.name for kind in KINDS.values()})
