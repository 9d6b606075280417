"""Rows far off one after another: a jump that was taken for bad shots, and bad shots that no jump explains."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.diagnosis.sustained_outliers import far_off_together
from armscope.recordings import Recordings
from tests.seeds import seeds

from .numpy_arms import ROWS, UR5E, said, still

JUMP_M = np.array([3e-3, -2e-3, 2e-3])


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(1, 2))
def test_a_base_that_jumped_far_and_early_is_named_not_listed_as_bad_shots(seed: int) -> None:
    def early(points: Array, row: Array) -> None:
        points[row < 20] -= JUMP_M

    verdict = said(UR5E, still, seed, early, time=15.0 * np.arange(ROWS))
    (found,) = (e for e in verdict.effects if e.family == "drift")
    assert (found.effect, found.location) == ("base_shift", "base")
    numbers = {p.name: p.value for p in found.parameters}
    np.testing.assert_allclose([numbers[axis] for axis in "xyz"], 1e3 * JUMP_M, atol=0.05)
    assert numbers["time"] == pytest.approx(15.0 * 20, abs=15)
    assert not verdict.suspects


@pytest.mark.long
def test_a_dozen_bad_shots_in_a_row_stay_bad_shots_and_get_no_name() -> None:
    rng = np.random.default_rng(3)

    def lost(points: Array, row: Array) -> None:
        points[60:72] += rng.normal(0, 5e-3, (12, 3))

    verdict = said(UR5E, still, 3, lost, time=15.0 * np.arange(ROWS))
    assert not [e for e in verdict.effects if e.family == "drift" or e.driver == "time"]
    assert {suspect.id for suspect in verdict.suspects} == {str(row + 1) for row in range(60, 72)}


def test_rows_far_off_lie_together_in_the_order_of_time_and_single_ones_do_not() -> None:
    time = np.random.default_rng(1).permutation(100).astype(float)
    one = np.full(100, "1")
    table = Recordings(np.zeros((100, 6)), np.zeros((100, 3)), run=one, target=one, id=one, time=time)
    together, single = time < 9, time % 10 == 0
    np.testing.assert_array_equal(far_off_together(table, together | (time == 80)), together)
    assert not far_off_together(table, single).any()
