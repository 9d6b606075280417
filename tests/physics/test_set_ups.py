"""Runs in order of time, and which come before and after one on the same base."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.physics.set_ups import in_order_of_time, runs_around

from .scenes import arm_named, full_table


def test_runs_stand_in_order_of_time_where_their_clocks_agree() -> None:
    table = replace(full_table(arm_named("six-axis"), 12, seed=2), run=np.repeat(["b", "a", "c"], 4), time=None)
    assert in_order_of_time(table) == ["b", "a", "c"]
    clock = np.concatenate([np.arange(4) + start for start in (200.0, 0.0, 100.0)])
    assert in_order_of_time(replace(table, time=clock)) == ["a", "c", "b"]
    assert in_order_of_time(replace(table, time=np.tile(np.arange(4.0), 3))) == ["b", "a", "c"]


def test_runs_of_another_set_up_are_neither_before_nor_after() -> None:
    assert runs_around((("b", "a", "c"), ("d",)), "a") == (("b",), ("c",))
    assert runs_around((("b", "a", "c"), ("d",)), "d") == ((), ())
