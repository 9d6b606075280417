"""Recordings beside each other keep their own frames, and only context that all of them hold."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.comparison.result import Comparison
from armscope.comparison.sets import left_out_context, stacked
from armscope.core.inputs import InputError
from tests.comparison.test_changes import ARM, session


def test_runs_and_targets_are_named_by_recording():
    first = replace(session(1, rows=20), payload=np.ones(20))
    table, group = stacked(ARM, {"a": first, "b": session(2, rows=30)})
    assert set(table.run) == {"a: ", "b: "}
    assert np.bincount(group).tolist() == [20, 30]
    assert table.payload is None


def test_nothing_is_said_to_have_changed_where_nothing_is_listed():
    assert "Nothing changed" in Comparison("arm", ("a", "b"), (1, 1), 0.1, 0.7, 0.05, 10, ()).headline


@pytest.mark.parametrize("word", ["run", "target"])
def test_rows_that_base_and_tool_use_up_say_nothing_of_a_change(word):
    first, second = session(1, rows=20), session(2, rows=30)
    scattered = replace(first, **{word: np.array([f"{row}" for row in range(20)])})
    with pytest.raises(InputError, match="20 rows, which hold 60 numbers"):
        stacked(ARM, {"a": scattered, "b": second})


def test_a_recording_is_not_compared_with_its_own_rows():
    first, second = session(1, rows=30), session(2, rows=30)
    for copy in (first, first.rows(np.arange(30) < 12)):
        with pytest.raises(InputError, match=r"points of a in c, to the last digit.*named twice"):
            stacked(ARM, {"a": first, "b": second, "c": copy})


def test_what_only_some_recordings_hold_is_said_to_be_left_out():
    plain = session(1)
    sided = replace(plain, approach=np.ones((len(plain), 6)))
    assert left_out_context({"a": plain, "b": plain}) == left_out_context({"a": sided, "b": sided}) == ""
    said = left_out_context({"a": plain, "b": sided})
    assert 'approach1 … (only in "b")' in said
    assert "record it in all of them" in said
