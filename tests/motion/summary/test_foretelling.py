"""Backgrounds must foretell motion that took no part, too."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.inference.evidence import evaluate
from armscope.inference.model_space import Candidate, ModelSpace, ToleranceFamily
from armscope.inference.normal_equations import NormalEquations, total
from armscope.inference.problem import SelectedEffect, build_problem
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.summary import foretelling
from armscope.motion.summary.foretelling import misfits, surprises, with_backgrounds_that_foretell
from tests.motion.moving import moved, presliding, robot


@pytest.fixture(scope="module")
def selected() -> SelectedCauses:
    found = diagnose_motion(robot(), moved(robot(), 3, presliding, seconds=10.0), MotionSettings(cutoff=10.0)).selected
    assert found.best.background[1], "friction changes sides at times of its own to begin with"
    return found


def harming(selected: SelectedCauses, share: float) -> Array:
    """Nats of the four choices in two blocks; without reversals so many of the noise's power less."""
    nats = np.zeros((4, len(selected.blocks)))
    nats[2:] -= share * selected.problem.n / (2 * len(selected.blocks))
    return nats


@pytest.mark.long
def test_a_background_that_does_harm_elsewhere_goes(selected: SelectedCauses, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(foretelling, "surprises", lambda at, asked: harming(selected, 0.5))
    found, without = with_backgrounds_that_foretell(selected)
    assert without == {"reversals"}
    assert not np.isin(selected.space.families[1].columns, found.best.columns).any()


def test_one_that_does_hardly_any_stays(selected: SelectedCauses, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(foretelling, "surprises", lambda at, asked: harming(selected, 0.05))
    assert with_backgrounds_that_foretell(selected) == (selected, frozenset())


def test_where_the_library_has_all_that_there_is_nothing_goes(selected: SelectedCauses) -> None:
    assert with_backgrounds_that_foretell(selected)[1] == frozenset()


def of_two_runs(slope_of_slow: float, slope_of_fast: float, slow: float) -> Any:
    """A column, ``slow`` times as large in one run as in the other, and what it makes in each; a frame beside."""
    rng, rows, noise, blocks = np.random.default_rng(6), 200, 0.1, []
    for slope, size in ((slope_of_slow, slow), (slope_of_fast, 1.0)):
        X = np.column_stack([np.ones(rows), size * rng.normal(size=rows)])
        y = slope * X[:, 1] + rng.normal(0, noise, rows)
        blocks.append(NormalEquations(X.T @ X, X.T @ y, float(y @ y), float(rows)))
    space = ModelSpace(np.arange(1), (), (Candidate("law", "here", np.array([1]), np.ones(1)),))
    problem = build_problem(space, total(blocks), 0.5 * noise)
    best = evaluate(problem, (SelectedEffect(0, len(problem.sizes) - 1),), (), noise)
    return SimpleNamespace(blocks=blocks, problem=problem, best=best)


def worth(law: Any, of: Callable[..., Array]) -> float:
    """Nats by which the law betters the blocks that took no part."""
    without, with_it = of(law, [(law.best, ()), (law.best, law.best.chosen)])
    return float(np.median(without - with_it))


def test_what_a_slow_run_leaves_open_is_no_surprise() -> None:
    """By its best guess, which is off by more than the law itself, the fast one is met worse than by none."""
    law = of_two_runs(1.0, 1.0, 0.002)
    assert worth(law, misfits) < 0 < worth(law, surprises)


def of_a_run_that_turns_back_and_moves() -> Any:
    """A law in both; in the second friction changes sides in its own way, of which its few starts show little."""
    rng, rows, noise, blocks = np.random.default_rng(6), 200, 0.1, []
    for often, side in ((1.0, 1.0), (0.05, 5.0)):
        sides = often * rng.normal(size=rows)
        law = 0.5 * sides + rng.normal(size=rows)
        X = np.column_stack([np.ones(rows), law, sides])
        y = law + side * sides + rng.normal(0, noise, rows)
        blocks.append(NormalEquations(X.T @ X, X.T @ y, float(y @ y), float(rows)))
    sides = ToleranceFamily("reversals", np.array([2]), np.array([10.0]), (0.0, 1.0))
    space = ModelSpace(np.arange(1), (sides,), (Candidate("law", "here", np.array([1]), np.ones(1)),))
    problem = build_problem(space, total(blocks), 0.5 * noise)
    best = evaluate(problem, (SelectedEffect(0, len(problem.sizes) - 1),), (1,), noise)
    return SimpleNamespace(blocks=blocks, problem=problem, best=best)


def test_no_name_is_blamed_for_how_friction_changes_sides_elsewhere() -> None:
    """A tilted base was no name, nor an offset: what moves guess of reversals was worse beside them than without."""
    assert worth(of_a_run_that_turns_back_and_moves(), misfits) > 0


def test_what_a_run_is_sure_of_and_is_another_elsewhere_surprises() -> None:
    assert worth(of_two_runs(-1.0, 1.0, 0.5), surprises) < 0 < worth(of_two_runs(1.0, 1.0, 0.5), surprises)
