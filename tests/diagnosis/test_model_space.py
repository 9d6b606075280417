"""What the library's effects exclude, require and contain, as the inference is told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis.model_space import EffectSpace, build_model_space
from armscope.inference.problem import prior_costs
from armscope.physics.backgrounds import ELASTIC, FAMILIES, GEOMETRIC, SOFT, STRUCTURE, backgrounds
from armscope.physics.drift import Pause, drift_with_pauses
from armscope.physics.effect import Part
from armscope.physics.frames import free_frames
from armscope.physics.payload import payload_errors
from armscope.physics.registry import library
from armscope.physics.soft_start import SOFT_START, soft_starts

from .planted import planted


@pytest.fixture(scope="module")
def space() -> EffectSpace:
    """The library of an arm that carried payloads, with a wrong payload, a drift by rows and one with a pause."""
    arm, table = planted("six-axis", {}, 60, 0.03, seed=2)
    table = replace(table, payload=np.repeat([0.0, 4.0, 8.0], 20), time=None)
    effects = library(arm, table)
    gives = next(p for p in effects if p.key == ("joint_compliance", "joint 2") and not p.variant)
    payloads = payload_errors(table, [Part(gives, np.array([1e-6]))])
    paused = drift_with_pauses([Pause(20.0, str(table.run[0]), 5.0)], 20)
    frames, families = free_frames(table, False), list(backgrounds(arm, table).values())
    return build_model_space(frames, families, [*effects, *payloads, paused])


def number(space: EffectSpace, *wanted: str) -> int:
    """Of the candidate of a kind at a location, in a variant."""
    return next(n for n, c in enumerate(space.candidates) if (c.kind, c.location, c.variant) == wanted)


def test_every_candidate_has_the_columns_of_its_terms(space: EffectSpace) -> None:
    for candidate, placed in zip(space.candidates, space.placed, strict=True):
        assert [space.layout.terms[n] for n in candidate.columns] == list(placed.terms)
        assert candidate.key == placed.key


def test_what_excludes_another_is_excluded_by_it(space: EffectSpace) -> None:
    for n, candidate in enumerate(space.candidates):
        assert n not in candidate.excludes
        assert all(n in space.candidates[other].excludes for other in candidate.excludes)
        assert candidate.special_cases <= candidate.excludes


def test_a_curve_of_the_angle_contains_what_follows_the_angle(space: EffectSpace) -> None:
    curve = space.candidates[number(space, "unknown", "joint 3", "angle")]
    kinds = {space.candidates[n].kind for n in curve.special_cases}
    assert {"joint_offset", "gear_ratio", "gear_eccentricity"} <= kinds
    assert "joint_compliance" not in kinds
    assert curve.side_by_side == 1
    assert {space.candidates[n].location for n in curve.special_cases} == {"joint 3"}


@pytest.mark.parametrize(("joint", "as_one"), [("joint 4", True), ("joint 3", False)])
def test_a_gear_may_be_off_its_centre_and_oval(space: EffectSpace, joint: str, as_one: bool) -> None:
    """Both waves stand side by side; over half a turn (joint 4) they count as one, over less they may be a bend."""
    once, twice = (number(space, "gear_eccentricity", joint, per_turn) for per_turn in ("1", "2"))
    assert twice not in space.candidates[once].excludes
    curve = space.candidates[number(space, "unknown", joint, "angle")]
    ratio = number(space, "gear_ratio", joint, "")
    assert curve.as_one == ({once, twice} if as_one else set())
    assert curve.excess(frozenset({once, twice})) == (0 if as_one else 1)
    assert curve.excess(frozenset({once, ratio})) == 1
    assert curve.excess(frozenset({once, twice, ratio})) == (1 if as_one else 2)


def test_a_wrong_payload_shows_only_through_what_gives_way(space: EffectSpace) -> None:
    for n, needed in space.requires.items():
        assert space.candidates[n].kind == "payload_error"
        assert {space.candidates[other].family for other in needed} == {"elastic"}
        assert not space.requirements_met(frozenset({n}))
        assert space.requirements_met(frozenset({n, min(needed)}))
    assert space.requires


def test_stated_masses_are_trusted_with_a_wrong_payload(space: EffectSpace) -> None:
    (exchange,) = space.exchanges
    assert set(exchange.entering) == set(space.requires)
    for doubted, stated in exchange.twins.items():
        assert stated is not None
        assert space.candidates[doubted].key == space.candidates[stated].key
        assert space.candidates[stated].variant == ""


def test_a_drift_leaves_with_one_more_effect_of_the_base_where_there_are_pauses(space: EffectSpace) -> None:
    drift = space.candidates[number(space, "base_drift", "base", "rows")]
    assert {space.candidates[n].location for n in drift.removed_with} == {"base"}
    assert all(not c.removed_with for c in space.candidates if c.kind != "base_drift")


def test_tolerances_are_free_and_other_backgrounds_pay(space: EffectSpace) -> None:
    assert [family.name for family in space.families] == list(FAMILIES)
    assert [family.is_priced for family in space.families] == [family != GEOMETRIC for family in FAMILIES]
    geometric, elastic, *_ = space.families
    scale = np.full(len(space.layout.terms), 1000.0)
    # the whole tolerance of a millimetre, of columns that move the tool by a metre per metre
    np.testing.assert_allclose(geometric.prior_variance(geometric.sizes - 1, scale), 1.0)
    # the others' by what is plausible in their own units, of which no more than three tenths go without a name
    plausible = np.array([space.layout.terms[column].plausible for column in elastic.columns])
    np.testing.assert_allclose(np.sqrt(elastic.prior_variance(elastic.sizes - 1, scale)), 300 * plausible)
    assert elastic.label(0) == 0.0
    assert elastic.label(2) == 0.01


def test_soft_starts_are_the_backgrounds_and_enter_by_no_other_way(space: EffectSpace) -> None:
    arm, table = planted("six-axis", {}, 60, 0.03, seed=2)
    starts = list(soft_starts(arm, table))
    assert starts
    own = build_model_space(
        free_frames(table, False), list(backgrounds(arm, table).values()), [*library(arm, table), *starts]
    )
    soft = {n for n, candidate in enumerate(own.candidates) if candidate.variant == SOFT_START}
    assert len(soft) == len(starts)
    (family,) = [family for family in own.families if family.name == SOFT]
    assert set(family.columns) == {int(own.candidates[n].columns[0]) for n in soft}
    for n in soft:
        candidate = own.candidates[n]
        assert candidate.nonnegative
        assert not candidate.competes
        assert not any(n in other.special_cases for other in own.candidates)
    # nor is any other name dearer for them
    np.testing.assert_array_equal(
        [cost for n, cost in enumerate(prior_costs(own)) if n not in soft],
        prior_costs(replace(own, candidates=tuple(c for n, c in enumerate(own.candidates) if n not in soft))),
    )


def test_what_looks_like_a_soft_start_may_be_taken_for_it(space: EffectSpace) -> None:
    alike = {(c.kind, c.variant, c.family) for c in space.candidates if c.taken_up_by == SOFT}
    assert alike == {("backlash", "load", "transmission"), ("unknown", "load", "unknown")}


def test_families_without_members_are_in_no_start() -> None:
    arm, table = planted("six-axis", {}, 60, 0.03, seed=2)
    families = backgrounds(arm, table)
    whole = build_model_space(free_frames(table, False), list(families.values()), [])
    assert max(start[FAMILIES.index(ELASTIC)] for start in whole.starts) > 0
    rigid = build_model_space(free_frames(table, False), list({**families, ELASTIC: [], SOFT: []}.values()), [])
    assert all(start[FAMILIES.index(ELASTIC)] == 0 for start in rigid.starts)
    assert len(set(rigid.starts)) == len(rigid.starts)


def test_a_round_base_is_known_to_be_in_a_background_that_has_it_about_two_axes(space: EffectSpace) -> None:
    base = space.candidates[number(space, "base_compliance", "base", "")]
    structure = space.families[FAMILIES.index(STRUCTURE)]
    assert not set(base.columns) & set(structure.columns)
    assert [space.layout.terms[n].name for n in sorted(base.summed)] == ["compliance_x", "compliance_y"]
    assert base.is_in(structure.columns)
    assert not base.is_in(np.array([min(base.summed)]))
    assert base.summed < set(base.held)
    others = [c for c in space.candidates if c is not base]
    assert all(not c.summed and list(c.held) == sorted(c.columns) for c in others)
