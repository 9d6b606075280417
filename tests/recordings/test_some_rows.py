"""Rows that stand for a long table hold some of every run and target, and count for all of them together."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.recordings import Recordings
from armscope.recordings.some_rows import some_rows, standing_for

from ..physics.scenes import arm_named, full_table


def table() -> Recordings:
    """A long run, and one of seven rows at its end whose last three look at another target."""
    rows = full_table(arm_named("six-axis"), 1000, 1)
    run, target = np.repeat(["a", "b"], [993, 7]), np.repeat(["", "t"], [997, 3])
    return replace(rows, run=run, target=target)


def test_they_are_spread_and_hold_some_of_every_run_and_target() -> None:
    rows = table()
    some = some_rows(rows, 11, 5)
    assert {0, 999, 99, 499}.issubset(some.tolist())
    assert {0, 1, 2, 3, 4}.issubset(some.tolist())
    assert set(range(993, 1000)).issubset(some.tolist())
    assert (np.diff(some) > 0).all()
    assert len(some) < 30


def test_they_count_for_all_rows_of_their_run_and_target() -> None:
    rows = table()
    some = some_rows(rows, 11, 5)
    stand = standing_for(rows, some)
    of_a = rows.run[some] == "a"
    assert stand[of_a].sum() == pytest.approx(993)
    assert np.unique(stand[of_a]).size == 1
    assert (stand[~of_a] == 1).all()


def test_of_a_short_table_all_rows_stand_for_themselves() -> None:
    rows = table()
    some = some_rows(rows, 2000, 5)
    assert some.tolist() == list(range(1000))
    assert (standing_for(rows, some) == 1).all()
