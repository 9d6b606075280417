"""A link's own error, what can't be told from it, and a zero beside what follows its joint's angle."""

from __future__ import annotations

from dataclasses import replace

import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.physics.elastic import tilting_joints
from armscope.physics.registry import library
from armscope.physics.scene import Scene
from armscope.physics.uneven_bearing import uneven_bearings
from armscope.recordings import Recordings
from armscope.robot import Arm, load_arm
from armscope.robot.library import nominal_file
from tests.diagnosis.planted import Wanted, one_run, recorded
from tests.physics.scenes import full_table

QUICK = Settings(resamples=0, cross_validation=False)
NOISE_MM = 0.03


def without_payload(arm: Arm, rows: int, seed: int) -> Recordings:
    """Random poses with nothing in hand, and no other context."""
    table = one_run(arm, rows, seed)
    return replace(table, payload=None, temperature=None, time=None, approach=None)


def told(arm: Arm, wanted: Wanted, rows: int, seed: int) -> set[tuple[str, str, str]]:
    table = recorded(arm, without_payload(arm, rows, seed), wanted, NOISE_MM, seed + 1)
    return {(e.effect, e.location, e.named_as) for e in diagnose(arm, table, QUICK).effects}


@pytest.fixture(scope="module")
def arm() -> Arm:
    return load_arm(nominal_file("ur10e"))


def test_a_link_that_is_twisted_is_no_bearing_under_a_load_that_is_always_the_same(arm: Arm) -> None:
    """Joint 2 carries all that lies beside its axis, in every pose alike: 16 urad/(N m) would be half a milliradian."""
    assert told(arm, {("link_geometry", "link 1"): [0.0, 5e-4, 0.0]}, 100, 3) == {("link_geometry", "link 1", "effect")}


def test_a_bearing_competes_where_its_load_varies(arm: Arm) -> None:
    table = full_table(arm, 60, 1)
    bare = replace(table, payload=None)
    assert "joint 2" in set(tilting_joints(Scene(arm, table)))
    assert "joint 2" not in set(tilting_joints(Scene(arm, bare)))
    assert {"joint 1", "joint 3"} <= set(tilting_joints(Scene(arm, bare)))
    for recordings in (table, bare):
        there = set(tilting_joints(Scene(arm, recordings)))
        assert {p.location for p in library(arm, recordings) if p.name == "bearing_compliance"} == there
        assert {p.location for p in uneven_bearings(arm, recordings)} == there


def test_a_zero_and_a_ratio_of_one_joint_are_two_names_and_nothing_unknown(arm: Arm) -> None:
    """The free curve of the joint's angle holds both, and fits worse by 12 nats: it pays for one name."""
    wanted = {("joint_offset", "joint 5"): [-6.7e-4], ("gear_ratio", "joint 5"): [5e-4]}
    found = told(arm, wanted, 160, 5)
    assert {(effect, place) for effect, place, _ in found} == set(wanted)
