"""Recordings beside each other keep their own frames, and only context that all of them hold."""

from dataclasses import replace

import numpy as np

from armscope.comparison.result import Comparison
from armscope.comparison.sets import stacked
from tests.comparison.test_changes import ARM, session


def test_runs_and_targets_are_named_by_recording():
    first = replace(session(1, rows=20), payload=np.ones(20))
    table, group = stacked(ARM, {"a": first, "b": session(2, rows=30)})
    assert set(table.run) == {"a: ", "b: "}
    assert np.bincount(group).tolist() == [20, 30]
    assert table.payload is None


def test_nothing_is_said_to_have_changed_where_nothing_is_listed():
    assert "Nothing changed" in Comparison("arm", ("a", "b"), (1, 1), 0.1, 0.7, 0.05, 10, ()).headline
