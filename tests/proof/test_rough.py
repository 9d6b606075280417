"""Rough arms: what stands out must be named, what is everywhere may be, what isn't there must not."""

from __future__ import annotations

from dataclasses import replace

import pytest

from armscope.proof.rough import rough_scores, rough_table
from armscope.proof.scoring import score
from tests.proof.cases import claim, concealed, world

CAUSE = concealed("joint_compliance", "joint 2", strength=6.0, parameters={"compliance": (1e-6, "rad/(N m)")})
SMALL = concealed("gear_mesh", "joint 3", minor=True, strength=2.0)
ZERO = concealed("joint_offset", "joint 4", minor=True, strength=9.0)
FOUND = claim("joint_compliance", "joint 2", rms=0.12)


def only(effects, claims, left_mm=0.1, **changes):
    made = world(effects, claims, category="rough")
    truth = replace(made.truth, left_mm=left_mm, also_allowed=(("payload_error", "payload"),), **changes)
    return score([replace(made, truth=truth)]).worlds.iloc[0]


def test_what_is_everywhere_may_be_named_or_left_out():
    for beside in ([], [claim("gear_mesh", "joint 3", rms=0.04)], [claim("unknown", "joint 6", rms=0.03)]):
        assert only([CAUSE, SMALL], [FOUND, *beside])["right"]
    assert only([CAUSE, SMALL], [FOUND, claim("payload_error", "payload", rms=0.03)])["right"]


def test_a_name_of_nothing_is_wrong_however_small():
    row = only([CAUSE, SMALL], [FOUND, claim("backlash", "joint 5", rms=0.01, minor=True)])
    assert not row["right"]
    assert row["wrong_names"] == 1


def test_a_cause_that_is_missed_is_wrong():
    assert not only([CAUSE, SMALL], [claim("gear_mesh", "joint 3", rms=0.04)])["right"]


def test_the_largest_name_is_a_causes_or_of_something_as_large():
    blown_up = claim("gear_mesh", "joint 3", rms=0.3)
    assert not only([CAUSE, SMALL], [FOUND, blown_up])["right"]
    assert only([CAUSE, replace(SMALL, strength=7.0)], [FOUND, blown_up])["right"]
    # every arm's D-H values are off by more than anything else
    assert only([CAUSE, ZERO], [FOUND, claim("joint_offset", "joint 4", rms=0.5)])["right"]


def test_two_that_are_off_by_the_same_may_come_in_either_order():
    """An offset stated on the next row is two rows' error, and which is listed as the cause is the world's choice."""
    first, second = (concealed("link_geometry", f"link {n}", strength=s) for n, s in ((4, 1314.6), (5, 1314.2)))
    said = [claim("link_geometry", "link 4", rms=20.0), claim("link_geometry", "link 5", rms=20.1)]
    assert only([first, replace(second, minor=True)], said)["right"]
    assert not only([first, replace(second, minor=True, strength=1200.0)], said)["right"]


@pytest.mark.parametrize(("nats", "tellable"), [(19.9, False), (20.0, True), (float("nan"), True)])
def test_a_cause_that_the_oracle_has_no_evidence_for_is_counted_apart(nats, tellable):
    """Without a word of the truth on it, as in older ones, it counts as one that can be told."""
    missed = only([replace(CAUSE, oracle_nats=nats), SMALL], [claim("gear_mesh", "joint 3", rms=0.04)])
    assert missed["tellable"] == tellable
    assert not missed["right"]


def test_where_nothing_stands_out_no_name_may_claim_much():
    small = concealed("gear_mesh", "joint 3", minor=True, strength=1.0)
    assert only([small], [])["right"]
    assert only([small], [claim("gear_mesh", "joint 3", rms=0.055)])["right"]
    assert not only([small], [claim("gear_mesh", "joint 3", rms=0.065)])["right"]
    assert only([small], [claim("gear_mesh", "joint 3", rms=0.065)], left_mm=0.2)["right"]


@pytest.mark.parametrize(
    ("said", "count"),
    [
        (claim("joint_offset", "joint 4", parameters={"offset": (0.06, 0.1, "rad")}), 1),
        (claim("joint_offset", "joint 4", parameters={"offset": (0.04, 0.1, "rad")}), 0),
        (claim("link_geometry", "link 2", parameters={"a": (-30.0, 9.0, "mm")}), 1),
        (replace(FOUND, parameters={"compliance": (6e-5, 1e-5, "rad/(N m)")}), 1),
        (replace(FOUND, parameters={"compliance": (2e-6, 1e-7, "rad/(N m)")}), 0),
    ],
)
def test_a_value_that_no_arm_has_is_counted(said, count):
    assert only([CAUSE, ZERO], [said])["absurd"] == count


def test_no_verdict_is_never_right():
    failed = world([], [], "rough", failed="it broke")
    assert not rough_scores(failed.truth, failed.answer, [], [])["right"]
    assert rough_scores(failed.truth, replace(failed.answer, failed=""), [], [])["right"]


def test_an_unknown_may_stand_for_all_that_there_is_at_its_place():
    waves = [concealed("gear_mesh", "joint 3", minor=True), concealed("gear_eccentricity", "joint 3", minor=True)]
    said = claim("unknown", "joint 3", rms=1.4 * 0.02 * 10)
    assert only(waves, [said])["right"]
    assert not only(waves[:1], [said])["right"]


def test_held_out_rows_are_judged_against_the_oracle():
    # the points are foretold exactly, so any oracle will do
    assert only([CAUSE], [FOUND], oracle_mm=0.01)["near_oracle"]
    made = world([CAUSE], [FOUND], category="rough", off=0.5)
    for oracle, near in ((0.46, True), (0.45, False)):
        row = score([replace(made, truth=replace(made.truth, oracle_mm=oracle))]).worlds.iloc[0]
        assert row["near_oracle"] == near
        assert row["to_oracle"] == pytest.approx(0.5 / oracle)


def test_rates_stand_by_number_of_causes_and_by_family():
    made = [world([CAUSE, SMALL], [FOUND], "rough", name=f"w{n}") for n in range(3)]
    made.append(world([CAUSE, SMALL], [], "rough", name="w3"))
    cases = score(made)
    table = rough_table(cases.worlds, cases.effects, cases.intervals).set_index(["family", "seeds", "score"])
    for family, counted in (
        ("rough", "right"),
        ("rough, one cause", "causes found"),
        ("causes: elastic", "causes found"),
    ):
        assert list(table.loc[(family, "fresh", counted), ["right", "cases"]]) == [3, 4]
