"""What makes motion that took no part worse has no name."""

from __future__ import annotations

from dataclasses import replace

import pytest

from armscope.inference.search import Search
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.pipeline import diagnose_motion
from armscope.motion.summary import harming
from armscope.motion.summary.harming import without_what_harms
from armscope.motion.summary.holding_out import folds
from armscope.motion.summary.intervals import Sureness, sureness
from armscope.motion.summary.step_by_step import error_with, waterfall
from tests.motion.moving import moved
from tests.motion.planar import planar


@pytest.fixture(scope="module")
def named() -> tuple[SelectedCauses, Sureness]:
    """One name, which helps."""
    selected = diagnose_motion(planar(), moved(planar((1.0, 1.3)), 2)).selected
    assert len(selected.best.chosen) == 1
    return selected, sureness(selected)


@pytest.mark.parametrize(("by", "kept"), [(0.01, False), (0.0004, True), (-0.01, True)])
def test_a_name_that_harms_goes_and_one_that_helps_or_hardly_harms_stays(
    named: tuple[SelectedCauses, Sureness], monkeypatch: pytest.MonkeyPatch, by: float, kept: bool
) -> None:
    monkeypatch.setattr(harming, "error_with", lambda parts, best: 0.05 + by * len(best.chosen))
    selected, sure = without_what_harms(*named, [])
    assert bool(selected.best.chosen) is kept
    assert (selected is named[0]) is kept
    assert (sure is named[1]) is kept


def test_of_several_the_worst_goes_first_and_what_helps_beside_it_stays(
    named: tuple[SelectedCauses, Sureness], monkeypatch: pytest.MonkeyPatch
) -> None:
    selected, sure = named
    good, other = selected.best.chosen[0], next(n for n, c in enumerate(selected.space.candidates) if c.competes)
    bad = replace(good, candidate=other)
    both = replace(selected, best=Search.on(selected.problem).evaluated([good, bad], selected.best))
    worth = {good.candidate: -0.01, bad.candidate: 0.02}
    error = lambda parts, best: 0.05 + sum(worth[each.candidate] for each in best.chosen)
    monkeypatch.setattr(harming, "error_with", error)
    assert without_what_harms(both, sure, [])[0].best.candidates == {good.candidate}


def test_what_really_helps_stays_by_its_own_errors(named: tuple[SelectedCauses, Sureness]) -> None:
    selected, sure = named
    parts = folds(selected)
    with_it, without = (error_with(parts, replace(selected.best, chosen=each)) for each in (selected.best.chosen, ()))
    assert with_it < without
    assert without_what_harms(selected, sure, parts)[0] is selected
    steps = waterfall(selected, parts, [selected.best.chosen[0].candidate], ["link 2"])
    assert steps[-1].held_out == with_it
