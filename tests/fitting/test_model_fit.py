"""When an exact refit ends: where what is still to come is next to nothing beside what noise leaves uncertain."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from armscope.fitting.constants import STEPS
from armscope.fitting.model_fit import ModelFit


def ends_after(moves: list[float], rows: int) -> int:
    """The step after which a fit of so many rows ends that moves points by so many mm, 0.02 mm being uncertain."""
    fit = object.__new__(ModelFit)
    fit.table, fit.steps_mm, fit.negligible = range(rows), [], STEPS.converged_share  # type: ignore[assignment]
    fit.noise, fit.effective_dof, fit.equations = 0.2, 1.0, SimpleNamespace(n=100.0)  # type: ignore[assignment]
    before, at = SimpleNamespace(points_mm=np.zeros((4, 3))), 0.0
    for number, moved in enumerate(moves, 1):
        fit.steps_mm.append(np.inf)  # as `quadratic` does
        after = SimpleNamespace(points_mm=before.points_mm + moved)
        if fit.settled(before, after):  # type: ignore[arg-type]
            return number
        before, at = after, at + moved
    raise AssertionError(f"it went on after {at} mm")


@pytest.mark.parametrize(
    ("moves", "short", "long"),
    [
        ([1.0, 0.02, 0.0004], 3, 2),  # what follows a fiftieth of the step before is foretold
        ([1.0, 0.25, 0.06, 0.015, 0.003, 0.0006], 6, 5),  # a quarter of 0.003 is less than 0.001, of 0.015 it is not
        ([0.01, 0.008, 0.006, 0.0005], 4, 4),  # steps that hardly shrink foretell nothing
        ([0.0005], 1, 1),
    ],
)
def test_a_fit_of_a_long_table_ends_where_the_next_step_is_foretold_to_be_nothing(
    moves: list[float], short: int, long: int
) -> None:
    assert ends_after(moves, STEPS.quickly_passed) == short
    assert ends_after(moves, STEPS.quickly_passed + 1) == long
