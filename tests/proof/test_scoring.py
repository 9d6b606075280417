"""Worlds scored: what counts as exact, as silent, as located, and what failed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.proof.rates import aims_table, confusion_table, power_table, tables
from armscope.proof.scoring import score
from tests.proof.cases import claim, concealed, world

OFFSET = concealed("joint_offset", "joint 2")
BUMP = concealed("unknown", "joint 2")
BACKGROUND = concealed("gear_eccentricity", "joint 4", minor=True, strength=0.4)


def only(*worlds):
    return score(worlds).worlds.iloc[0]


def test_an_exact_set_holds_every_effect_and_nothing_else():
    right = claim("joint_offset", "joint 2")
    assert only(world([OFFSET], [right]))["exact"]
    assert not only(world([OFFSET], []))["exact"]
    assert not only(world([OFFSET], [right, claim("gear_ratio", "joint 1")]))["exact"]
    assert not only(world([OFFSET], [right, claim("unknown", "joint 1")]))["exact"]


def test_a_world_is_as_clear_as_the_weakest_effect_of_its_story():
    faint, strong = replace(OFFSET, strength=2.0), concealed("gear_ratio", "joint 3", strength=9.0)
    cases = score([world([strong, faint, BACKGROUND], [claim("gear_ratio", "joint 3")])])
    for table in (cases.worlds, cases.effects, cases.names):
        assert set(table["weakest"]) == {2.0}


def test_a_wrong_minor_name_spoils_the_set_but_not_the_story():
    row = only(world([OFFSET], [claim("joint_offset", "joint 2"), claim("gear_ratio", "joint 1", minor=True)]))
    assert not row["exact"]
    assert row["exact_story"]
    assert row["wrong_names"] == 1


def test_on_an_arm_as_real_ones_are_the_background_may_be_named_or_left_out():
    right = claim("joint_offset", "joint 2")
    for said in ([right], [right, claim("gear_eccentricity", "joint 4")], [right, claim("unknown", "joint 4")]):
        assert only(world([OFFSET, BACKGROUND], said, category="real"))["exact"]
    assert not only(world([OFFSET, BACKGROUND], [right, claim("backlash", "joint 1")], category="real"))["exact"]


def test_a_clean_arm_is_silent_only_without_any_effect():
    assert only(world([], [], category="clean"))["silent"]
    assert not only(world([], [claim("unknown", "joint 1", minor=True)], category="clean"))["silent"]
    mismatch = world([], [], category="clean")
    assert not only(replace(mismatch, answer=replace(mismatch.answer, mismatch=True)))["silent"]


@pytest.mark.parametrize(
    ("said", "answer", "outcome", "right"),
    [
        ([claim("unknown", "joint 2")], "partly explained", "located", True),
        ([claim("unknown", "joint 2"), claim("backlash", "joint 2")], "partly explained", "partly named", False),
        ([claim("unknown", "joint 2"), claim("backlash", "joint 5")], "partly explained", "misnamed", False),
        ([claim("gear_ratio", "joint 2")], "explained", "misnamed", False),
        ([claim("unknown", "joint 3")], "partly explained", "elsewhere", False),
        ([], "cannot tell", "cannot tell", False),
        ([], "nothing missing", "missed", False),
    ],
)
def test_outside_the_library_only_a_located_unknown_without_a_name_is_right(said, answer, outcome, right):
    row = only(world([BUMP], said, category="outside", answer=answer))
    assert row["outside"] == outcome
    assert row["outside_right"] == right


def test_a_failed_diagnosis_is_wrong_everywhere():
    clean = only(world([], failed="ValueError: no", category="clean"))
    assert not clean["silent"]
    assert not clean["exact"]
    assert not clean["held_out_close"]
    assert only(world([BUMP], failed="ValueError: no", category="outside"))["outside"] == "failed"


def test_the_held_out_ratio_by_hand():
    assert only(world([], [], off=0.5))["held_out_ratio"] == pytest.approx(1.0)
    assert not only(world([], [], off=0.6))["held_out_close"]
    # two runs with six numbers each, the tool's three, one effect's one, 100 rows
    assert only(world([OFFSET], []))["price_of_fitting"] == pytest.approx((1 + 16 / 300) ** 0.5)


def test_missed_and_invented_names_stand_beside_each_other_in_the_confusion_matrix():
    cases = score(
        [world([OFFSET], [claim("gear_ratio", "joint 6")]), world([], [], category="clean", name="world-001")]
    )
    counts = confusion_table(cases).set_index(["true", "said"])["effects"].to_dict()
    assert counts == {("joint_offset", "gear_ratio"): 1, ("nothing", "nothing"): 1}


def test_aims_count_fresh_and_fixed_worlds_apart():
    worlds = [
        world([], [claim("backlash", "joint 1")] if number == 0 else [], "clean", fresh=number < 20, name=f"w{number}")
        for number in range(50)
    ]
    table = aims_table(score(worlds), np.random.default_rng(0)).set_index(["aim", "seeds"])
    silent = table.loc["no name on clean arms"]
    assert (silent.loc["fresh", "right"], silent.loc["fresh", "cases"]) == (19, 20)
    assert silent.loc["fresh", "verdict"] == "open"
    assert silent.loc["fixed", "verdict"] == "met"
    assert table.loc[("outside the library: located and not misnamed", "fresh"), "verdict"] == "too few cases"


def test_only_effects_that_stand_alone_make_the_power_curve():
    second = concealed("gear_ratio", "joint 4")
    cases = score([world([OFFSET], []), world([OFFSET, second], [], name="world-001")])
    assert power_table(cases.effects)["cases"].max() == 1


def test_tables_are_complete_for_a_single_silent_world():
    assert all(table is not None for table in tables(score([world([], [], category="clean")])).values())
