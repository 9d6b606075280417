"""The proof's worlds are those that were declared, and half of them can't be known beforehand."""

from __future__ import annotations

from collections import Counter

import pytest
import yaml

from armscope.world.catalogue import STRENGTHS, catalogue
from armscope.world.effects import LIBRARY
from armscope.world.outside import OUTSIDE
from armscope.world.spec import KINDS, WorldSpec
from tests.world.by_hand import ARMS

CATEGORIES = {"clean", "single", "multiple", "outside", "misleading", "inseparable", "rough", "bad_shots"}
FULL = CATEGORIES | {"real", "faint", "rough_misleading"}


def test_the_full_proof_has_over_300_worlds_of_every_category_on_every_arm():
    worlds = catalogue(1, "full")
    assert len(worlds) >= 300
    assert {world.category for world in worlds} == FULL
    assert min(Counter(world.arm for world in worlds).values()) > 60
    assert {world.arm for world in worlds} == set(ARMS)
    assert all(60 <= world.rows <= 300 for world in worlds)
    assert len({world.id for world in worlds}) == len(worlds)


def test_the_noise_is_stated_in_some_six_of_ten_worlds():
    stated = [world.noise_stated for world in catalogue(1, "full")]
    assert 0.5 < sum(stated) / len(stated) < 0.7


def test_the_small_proof_has_24_worlds_the_roughest_among_them():
    worlds = catalogue(1)
    assert len(worlds) == 24
    assert {world.category for world in worlds} == CATEGORIES


def test_every_effect_stands_alone_at_every_strength():
    alone = {(w.effects[0].kind, w.effects[0].strength) for w in catalogue(1, "full") if w.category == "single"}
    assert alone == {(kind.name, strength) for kind in LIBRARY for strength in STRENGTHS}


def test_every_kind_outside_the_library_is_there_at_several_strengths():
    outside = Counter(w.effects[0].kind for w in catalogue(1, "full") if w.category == "outside")
    assert set(outside) == {kind.name for kind in OUTSIDE}
    assert min(outside.values()) >= 4


def test_two_to_six_effects_come_together():
    counts = {len(world.effects) for world in catalogue(1, "full") if world.category == "multiple"}
    assert counts == {2, 3, 4, 5, 6}


@pytest.mark.parametrize("size", ["small", "full"])
def test_half_of_the_worlds_depend_on_the_proofs_seed_and_half_do_not(size):
    one, two = catalogue(1, size), catalogue(2, size)
    assert abs(sum(world.fresh for world in one) - len(one) / 2) <= 1
    for a, b in zip(one, two, strict=True):
        assert (a.seed != b.seed) == a.fresh == b.fresh
        assert a.fresh or a == b


def test_fixed_and_fresh_worlds_hold_the_same_mixture():
    worlds = catalogue(1, "full")
    for category in FULL:
        fresh = [world.fresh for world in worlds if world.category == category]
        assert abs(sum(fresh) - len(fresh) / 2) <= 0.07 * len(fresh)
    for strength in STRENGTHS:
        fresh = [w.fresh for w in worlds if w.category == "single" and w.effects[0].strength == strength]
        assert 0.15 * len(fresh) < sum(fresh) < 0.85 * len(fresh)


def test_a_worlds_name_says_nothing_about_what_is_inside():
    assert all(world.id == f"world-{number:03d}" for number, world in enumerate(catalogue(1, "full")))


def test_no_two_worlds_share_a_seed():
    seeds = [world.seed for world in catalogue(5, "full")]
    assert len(set(seeds)) == len(seeds)


def test_a_spec_survives_being_written_and_read():
    for world in catalogue(7):
        text = yaml.safe_dump(world.model_dump(mode="json"))
        assert WorldSpec.model_validate(yaml.safe_load(text)) == world


def test_every_wish_names_a_known_kind():
    assert {asked.kind for world in catalogue(1, "full") for asked in world.effects} <= set(KINDS)
