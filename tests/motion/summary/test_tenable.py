"""Names that the evidence asks for and that still can't stand."""

import dataclasses
import itertools
from typing import Any

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.inference.search import Search
from armscope.motion.fitting.cutoff import chosen_cutoff
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import select_causes
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.placing import place_causes
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.samples.timing import stretches
from armscope.motion.summary import tenable as judging
from armscope.motion.summary.names_of_masses import NameOfMasses
from armscope.motion.summary.tenable import held_out_gains, samples_near_rest, tenable
from tests.motion.moving import COULOMB, ROTOR, VISCOUS, moved, robot

STATED = [
    {"coulomb_nm": float(c), "viscous_nm_s_rad": float(v), "rotor_inertia_kg_m2": float(r)}
    for c, v, r in zip(COULOMB, VISCOUS, ROTOR, strict=True)
]


def test_samples_near_rest_are_those_of_reversals_alone() -> None:
    speeds = np.array([0.3, 0.1, 0.02, -0.01, -0.2, 0.05, 0.02, -0.3, 0.4, 0.05, 0.3, 0.01])
    assert samples_near_rest(speeds, 0.06).tolist() == [2, 0]  # back at once, then to and fro without turning back
    assert samples_near_rest(speeds, 0.15).tolist() == [3, 0]


def test_a_steady_reversal_has_as_many_samples_near_rest_as_it_takes() -> None:
    rate, acceleration, slow = 200.0, 1.5, 0.09
    (found,) = samples_near_rest(acceleration * (np.arange(-300, 300) + 0.5) / rate, slow)
    assert found == pytest.approx(2 * slow / acceleration * rate, abs=1)


def driving(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """Dry friction at joint 2 that pushes instead of resisting."""
    return np.column_stack([np.zeros(len(q)), -1.6 * COULOMB[1] * np.sign(dq[:, 1]), np.zeros(len(q))])


@pytest.fixture(scope="module")
def selected() -> SelectedCauses:
    arm = robot(drives=STATED)
    train = list(stretches(moved(robot(), 8, driving)))
    how, first = chosen_cutoff(arm, train, 10.0)
    layout = TorqueLayout(arm, tuple(place_causes(seen_in(arm, train, 0.02))), False)
    return select_causes(layout, train, how, ("path 1", "path 2"), lambda text, share: None, first.model)


@pytest.fixture(scope="module")
def stands(selected: SelectedCauses) -> SelectedCauses:
    """What of it can stand."""
    return tenable(selected, 200.0)


def names(selected: SelectedCauses) -> set[tuple[str, str]]:
    return {selected.space.candidates[number].key for number in selected.best.candidates}


def test_friction_below_zero_is_no_friction(selected: SelectedCauses, stands: SelectedCauses) -> None:
    assert ("coulomb_friction", "joint 2") in names(selected)
    assert ("coulomb_friction", "joint 2") not in names(stands)
    assert ("unknown", "joint 2") in names(stands)


@pytest.mark.long
def test_what_comes_in_place_of_a_struck_name_foretells_motion(
    selected: SelectedCauses, monkeypatch: pytest.MonkeyPatch
) -> None:
    """However long evidence goes on to name what no other path shows."""
    useless = itertools.cycle(n for n, cause in enumerate(selected.rows.layout.placed) if cause.location == "joint 3")
    usual = judging.chosen

    def with_another(*asked: Any) -> SelectedCauses:
        found = usual(*asked)
        search = Search.on(found.problem)
        while (number := next(useless)) in found.best.candidates:
            pass
        more = dataclasses.replace(found.best.chosen[0], candidate=number)
        worse = search.evaluated([*found.best.chosen, more], found.best)
        return dataclasses.replace(found, best=worse)

    monkeypatch.setattr(judging, "chosen", with_another)
    found = tenable(selected, 200.0)
    assert all(gain > 0 for gain in held_out_gains(found).values())


def test_a_name_of_masses_that_is_hardly_likelier_than_none_goes_and_nothing_takes_its_place(
    stands: SelectedCauses, monkeypatch: pytest.MonkeyPatch
) -> None:
    mass = next(n for n, each in enumerate(stands.rows.layout.placed) if each.cause.name == "link_mass")
    more = dataclasses.replace(stands.best.chosen[0], candidate=mass)
    both = dataclasses.replace(
        stands, best=Search.on(stands.problem).evaluated([*stands.best.chosen, more], stands.best)
    )
    monkeypatch.setattr(judging, "far_off", lambda at, best: False)  # masses near the stated ask for no name at all
    for odds, kept in ((3.1, True), (2.9, False)):
        monkeypatch.setattr(judging, "odds_of_name", lambda at, number, told=odds: told)
        found = judging._told_apart(both, 200.0)
        assert (mass in found.best.candidates) is kept
        assert found.best.candidates - {mass} == stands.best.candidates


@pytest.mark.parametrize(("nats", "untenable", "taken"), [(3.1, (), True), (2.9, (), False), (3.1, (0,), False)])
def test_another_name_of_masses_takes_the_place_of_one_that_goes_if_it_is_likely_and_can_stand(
    stands: SelectedCauses, monkeypatch: pytest.MonkeyPatch, nats: float, untenable: tuple[int, ...], taken: bool
) -> None:
    placed = stands.rows.layout.placed
    mass = next(n for n, each in enumerate(placed) if each.cause.name == "link_mass")
    inertia = next(n for n, each in enumerate(placed) if each.cause.name == "link_inertia")

    def beside(at: SelectedCauses, number: int) -> SelectedCauses:
        more = dataclasses.replace(stands.best.chosen[0], candidate=number)
        return dataclasses.replace(at, best=Search.on(at.problem).evaluated([*at.best.chosen, more], at.best))

    monkeypatch.setattr(judging, "odds_of_name", lambda at, number: 1.0 if number == mass else 9.0)
    monkeypatch.setattr(judging, "likeliest_name", lambda at, gone: NameOfMasses(beside(at, inertia), inertia, nats))
    monkeypatch.setattr(judging, "_untenable", lambda at, rate: frozenset(untenable))
    found = judging._told_apart(beside(stands, mass), 200.0)
    assert mass not in found.best.candidates
    assert (inertia in found.best.candidates) is taken
