"""A name of masses is told from a link that is off in some other way, not only from one that is as stated."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

from armscope.inference.edits import by_posterior
from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.motion.fitting.consistency import PathAgreement
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.summary import tenable
from armscope.motion.summary.names_of_masses import likeliest_name
from armscope.motion.summary.unnamed_masses import all_held_alike, odds_of_name, off_without_a_name
from armscope.verdict.effects import INDISTINGUISHABLE_NATS
from tests.motion.moving import ROBOT, moved, robot
from tests.motion.summary.test_tenable import STATED

FIRST, SECOND, LAST = ROBOT["links"]  # type: ignore[misc]


def with_the_second(**otherwise: object) -> SelectedCauses:
    """What is selected on motion of an arm whose second link is not as stated."""
    true = robot(links=[FIRST, {**SECOND, **otherwise}, LAST])  # type: ignore[dict-item]
    return diagnose_motion(robot(), moved(true, 5), MotionSettings(cutoff=10.0)).selected


def placed(selected: SelectedCauses, name: str, place: str) -> int:
    causes = enumerate(selected.rows.layout.placed)
    return next(n for n, each in causes if (each.cause.name, each.location) == (name, place))


def named(selected: SelectedCauses, number: int) -> SelectedCauses:
    """With that name alone."""
    search = Search.on(selected.problem)
    best = search.with_best_sizes(search.evaluated([SelectedEffect(number, 0)], selected.best))
    return dataclasses.replace(selected, best=best)


@pytest.mark.long
def test_a_heavier_link_is_told_from_one_that_is_otherwise_off(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where every path tells its size it stands, too, though masses without a name foretell as much."""
    heavier: dict[str, Any] = {
        "mass_kg": 1.2 * SECOND["mass_kg"],
        "inertia_kg_m2": [1.2 * each for each in SECOND["inertia_kg_m2"]],
    }
    selected = with_the_second(**heavier)
    mass = placed(selected, "link_mass", "link 2")
    assert selected.best.candidates == {mass}
    assert odds_of_name(selected, mass) > 3 * INDISTINGUISHABLE_NATS
    monkeypatch.setattr(tenable, "held_out_gains", lambda at: dict.fromkeys(at.best.candidates, -0.1))
    assert list(tenable._of_one_path(selected)) == []
    no_path = PathAgreement(np.ones(2), np.full(2, np.inf))
    monkeypatch.setattr(tenable, "agreement", lambda at, number: no_path)
    assert list(tenable._of_one_path(selected)) == [mass]


@pytest.mark.long
def test_what_the_last_link_weighs_does_not_make_all_others_doubtful() -> None:
    """A share by which all links' weights are off takes the name's place only where another link asks for it, too."""
    lighter = {"mass_kg": 0.6 * LAST["mass_kg"], "inertia_kg_m2": [0.6 * each for each in LAST["inertia_kg_m2"]]}
    true = robot(links=[FIRST, SECOND, {**LAST, **lighter}])
    selected = diagnose_motion(robot(), moved(true, 5), MotionSettings(cutoff=10.0)).selected
    mass = placed(selected, "link_mass", "link 3")
    assert selected.best.candidates == {mass}
    assert odds_of_name(selected, mass) > 3 * INDISTINGUISHABLE_NATS


@pytest.mark.long
def test_a_link_whose_centre_is_elsewhere_is_not_told_as_heavier() -> None:
    """Beside masses that are held as the other links' it would be: by hundreds of nats."""
    selected = all_held_alike(with_the_second(com_mm=[-130, 30, 50], inertia_kg_m2=[0.06, 0.2, 0.16, 0.01, 0.0, 0.02]))
    mass = placed(selected, "link_mass", "link 2")
    heavier = named(selected, mass)
    held = dataclasses.replace(heavier.best, background=(1, *heavier.best.background[1:]))
    near = dataclasses.replace(heavier, best=Search.on(heavier.problem).evaluated(held.chosen, held, held.background))
    assert Search.on(near.problem).log_odds(near.best, mass) > 100
    assert odds_of_name(heavier, mass) < INDISTINGUISHABLE_NATS
    assert mass not in selected.best.candidates


@pytest.mark.long
def test_a_link_whose_centre_alone_is_elsewhere_has_that_name() -> None:
    """Ten numbers of that link without a name say it, too, and nothing but their number speaks against them.

    So that names stay where a link is singled out, that has the price of a name: no strength of an effect would make up
    for it.
    """
    x, y, z = SECOND["com_mm"]
    selected = with_the_second(com_mm=[x, y + 20, z])
    shift = placed(selected, "link_first_moment", "link 2")
    assert selected.best.candidates == {shift}
    assert odds_of_name(selected, shift) > INDISTINGUISHABLE_NATS


@pytest.mark.long
def test_a_name_that_is_all_a_link_can_say_has_no_rival_without_a_name() -> None:
    """The first link stands upright: of its ten numbers its inertia about the axis is the only one that shows."""
    wider = {**FIRST, "inertia_kg_m2": [0.3, 0.48, 0.3, 0, 0, 0]}  # type: ignore[dict-item]
    true = robot(links=[wider, SECOND, LAST])
    selected = diagnose_motion(robot(drives=STATED), moved(true, 5), MotionSettings(cutoff=10.0)).selected
    inertia = placed(selected, "link_inertia", "link 1")
    search = Search.on(selected.problem)
    bare = search.evaluated((), selected.best, selected.space.no_background)
    best = max((search.evaluated([SelectedEffect(inertia, n)], bare) for n in range(5)), key=by_posterior)
    alone = dataclasses.replace(selected, best=best)
    assert odds_of_name(alone, inertia) > 10 * INDISTINGUISHABLE_NATS
    assert {selected.rows.layout.placed[n].location for n in selected.best.candidates} <= {"link 1", "joint 1"}
    assert selected.best.candidates


@pytest.mark.long
def test_a_link_far_off_without_a_name_is_fitted_as_far_off_as_it_is() -> None:
    """By the share of all links gains and friction took it: right on these paths, 24 % of the torque off on another."""
    selected = with_the_second(inertia_kg_m2=[3.0, 3.0, 3.0, 0, 0, 0])
    inertia = placed(selected, "link_inertia", "link 2")
    alone = named(selected, inertia)
    unnamed = off_without_a_name(alone, inertia)
    assert inertia not in unnamed.best.candidates
    assert unnamed.best.log_posterior > alone.best.log_posterior - 10 * INDISTINGUISHABLE_NATS
    kept = Search.on(alone.problem).evaluated((), alone.best)
    assert kept.log_posterior < unnamed.best.log_posterior - 30 * INDISTINGUISHABLE_NATS
    # asked once more, the name competes with one share for all links
    found = likeliest_name(unnamed)
    assert found is not None
    assert found.number == inertia
