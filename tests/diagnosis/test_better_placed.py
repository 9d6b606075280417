"""A name out of a background goes to the member that explains the rows, on columns that are no robot's."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.diagnosis.curve_shapes import DRIVE
from armscope.diagnosis.naming import _better_placed
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.model_space import Candidate, ModelSpace, ToleranceFamily
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.problem import Problem, SelectedEffect, build_problem
from armscope.inference.search import Search

FRAMES, ROWS, NOISE = 2, 200, 0.1
DRIVE_AT, TILT_AT = 0, 1


def rows_where(made_by: int, alike: float, drive: float = 0.0) -> tuple[Array, Array]:
    """Rows (N, P) of a drive and a bearing whose columns correlate, and five others that do nothing; one made y (N,).

    Args:
        made_by: the one.
        alike: the drive's and the bearing's correlation.
        drive: by how much the drive gives way besides.

    Returns:
        X and y.
    """
    rng = np.random.default_rng(3)
    X = rng.normal(size=(ROWS, FRAMES + 7))
    X[:, FRAMES + TILT_AT] = alike * X[:, FRAMES + DRIVE_AT] + np.sqrt(1 - alike**2) * X[:, FRAMES + TILT_AT]
    y = 0.3 * X[:, FRAMES + made_by] + drive * X[:, FRAMES + DRIVE_AT] + rng.normal(0, NOISE, ROWS)
    return X, y


def sums(X: Array, y: Array) -> NormalEquations:
    """The normal equations of some rows."""
    return NormalEquations(X.T @ X, X.T @ y, float(y @ y), float(len(y)))


def problem_where(made_by: int, alike: float, drive: float = 0.0, in_family: int = 7) -> Problem:
    """The problem on `rows_where`.

    Args:
        made_by: as there.
        alike: as there.
        drive: as there.
        in_family: how many are in the background: the drive and the last ones; 0: there is none.

    Returns:
        The problem.
    """
    members = FRAMES + np.array([DRIVE_AT, *range(8 - in_family, 7)])
    kinds = [DRIVE, *["bearing_compliance"] * 6]
    elastic = ToleranceFamily("elastic", members, np.full(len(members), 0.3), (0.0, 0.1, 1.0), is_priced=True)
    space = ModelSpace(
        np.arange(FRAMES),
        (elastic,) if in_family else (),
        tuple(Candidate(k, f"joint {n}", np.array([FRAMES + n]), np.ones(1)) for n, k in enumerate(kinds)),
    )
    return build_problem(space, sums(*rows_where(made_by, alike, drive)), 0.5 * NOISE)


def with_drive_named(problem: Problem) -> Hypothesis:
    """The drive named out of the background, at the size that suits it best."""
    sized = [SelectedEffect(DRIVE_AT, size, nested=True) for size in range(len(problem.sizes))]
    background = (1,) * len(problem.space.families)
    return max((evaluate(problem, (name,), background, NOISE) for name in sized), key=lambda h: h.log_posterior)


@pytest.mark.parametrize("alike", [0.6, 0.9])
def test_what_explains_the_rows_better_takes_the_drives_name(alike: float) -> None:
    problem = problem_where(TILT_AT, alike)
    placed = _better_placed(Search.on(problem), with_drive_named(problem))
    assert placed.candidates == {TILT_AT}
    assert all(c.nested for c in placed.chosen)


@pytest.mark.parametrize("alike", [0.0, 0.6, 0.9, 0.999])
def test_a_drive_that_gave_way_keeps_its_name(alike: float) -> None:
    problem = problem_where(DRIVE_AT, alike)
    assert _better_placed(Search.on(problem), with_drive_named(problem)).candidates == {DRIVE_AT}


def test_where_rows_do_not_tell_them_apart_the_drive_keeps_its_name() -> None:
    problem = problem_where(TILT_AT, 0.999)
    assert _better_placed(Search.on(problem), with_drive_named(problem)).candidates == {DRIVE_AT}


def test_only_the_drives_own_family_is_asked() -> None:
    problem = problem_where(TILT_AT, 0.6, in_family=6)
    assert _better_placed(Search.on(problem), with_drive_named(problem)).candidates == {DRIVE_AT}


def test_what_explains_the_rows_only_with_the_drive_beside_it_does_not_take_its_name() -> None:
    problem = problem_where(TILT_AT, 0.0, drive=0.1)
    assert _better_placed(Search.on(problem), with_drive_named(problem)).candidates == {DRIVE_AT}


def test_a_drive_that_no_background_holds_is_not_asked() -> None:
    problem = problem_where(TILT_AT, 0.6, in_family=0)
    assert _better_placed(Search.on(problem), with_drive_named(problem)).candidates == {DRIVE_AT}


def test_columns_that_are_held_take_no_part() -> None:
    problem = problem_where(DRIVE_AT, 0.6)
    held = problem.holding(np.array([FRAMES + DRIVE_AT]))
    without = evaluate(held, (), (1,), NOISE)
    assert FRAMES + DRIVE_AT not in without.columns
    assert set(without.columns) == set(range(FRAMES + 7)) - {FRAMES + DRIVE_AT}
    with_all = evaluate(problem, (), (1,), NOISE)
    others = np.delete(np.arange(FRAMES + 7), FRAMES + DRIVE_AT)
    np.testing.assert_allclose(without.variance, with_all.variance[others])
