"""What a change moves the tool by, and what taking it back does, beyond what base and tool take up."""

import numpy as np
import pytest

from armscope.comparison.at_the_tool import moved_mm, taken_back_mm, worse_sigmas
from armscope.comparison.sets import stacked
from armscope.comparison.shared_model import SharedModel
from tests.comparison.test_changes import ARM, session
from tests.comparison.worlds import off, recorded


def of_zero(tables, joint):
    model = SharedModel(ARM, *stacked(ARM, tables))
    title = f"joint_offset at joint {joint}"
    return model, next(each for each in model.possible_changes([((1,), (0,))]) if str(each.placed) == title)


def test_what_came_is_gone_when_it_is_taken_back_and_what_was_repaired_comes_again():
    """0.03 mm of noise, and a zero of 1 mrad: executed on the simulated arm, base and tool fitted anew."""
    q, rng = session(1).motor_angles, np.random.default_rng(5)
    for before, after in ((0.0, 1e-3), (1e-3, 0.0)):
        tables = {"a": recorded(session(9).motor_angles, {3: before}, rng), "b": recorded(q, {3: after}, rng)}
        left, back = taken_back_mm(*of_zero(tables, 3), np.array([after - before]))
        assert left == pytest.approx(off(q, {3: after}), rel=0.05)
        assert back == pytest.approx(off(q, {3: before}), rel=0.05)


def test_a_change_moves_the_tool_by_as_much_as_it_is_large():
    model, zero = of_zero({"a": session(1), "b": session(2)}, 2)
    assert moved_mm(model, zero, np.array([2e-3])) == pytest.approx(2 * moved_mm(model, zero, np.array([1e-3])))
    none = {"a": session(1), "b": session(2)}
    assert moved_mm(*of_zero(none, 1), np.array([1e-3])) < 1e-6, "the base turns as the first joint does"


def test_what_is_left_when_it_is_taken_back_is_weighed_by_its_rows():
    """1 mrad in an arm that has nothing else is surely better back; a thousandth of it nobody can tell."""
    tables = {"a": session(1), "b": session(2, offsets={3: 1e-3})}
    surely, hardly = (worse_sigmas(*of_zero(tables, 3), np.array([size])) for size in (1e-3, 1e-6))
    assert surely < -3
    assert worse_sigmas(*of_zero(tables, 3), np.array([-1e-3])) > 3
    assert np.sign(surely) == np.sign(hardly), "of next to nothing the rows all say the same, and it is worth nothing"
