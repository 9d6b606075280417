"""What changed more than once is told from recording to recording: wear that goes on is no repair."""

import numpy as np
import pytest

from armscope.comparison import compare
from armscope.comparison.dispersion import Possible
from armscope.comparison.steps import as_steps
from tests.comparison.test_changes import ARM, session


def change(number, sets, against):
    return Possible(None, number, np.ones(1), np.ones(3, dtype=bool), sets, against)  # type: ignore[arg-type]


STEPS = [change(0, (1, 2), (0,)), change(0, (2,), (0, 1))]
ALONE = change(0, (1,), (0, 2))


def test_from_the_third_on_and_in_the_second_alone_are_two_steps():
    other = change(7, (2,), (0, 1))
    assert as_steps([STEPS[1], other, ALONE], [*STEPS, ALONE, other]) == [other, *STEPS]


def test_what_came_and_was_put_right_stays_one_change_and_a_step_that_may_not_be_named_none():
    assert as_steps([ALONE], [*STEPS, ALONE]) == [ALONE]
    assert as_steps([STEPS[1], ALONE], [STEPS[1], ALONE]) == [STEPS[1], ALONE]


@pytest.mark.long
@pytest.mark.parametrize("zeros", [(0.0, 4e-4, 9e-4), (0.0, 3e-4, 6e-4, 9e-4)])
def test_a_zero_that_wears_on_came_or_grew_in_each_recording_and_shrank_in_none(zeros):
    tables = {str(n): session(7300 + n, rows=60, offsets={3: zero}) for n, zero in enumerate(zeros)}
    found = compare(ARM, tables).changes
    assert {(each.location, each.where) for each in found} == {("joint 3", (str(n),)) for n in range(1, len(zeros))}
    assert not {each.kind for each in found} & {"went", "shrank"}
    for each in found:
        step = zeros[int(each.where[0])] - zeros[int(each.where[0]) - 1]
        assert abs(each.parameters[0].difference - step) < 0.1e-3
