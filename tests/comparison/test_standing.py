"""A name stands where its own numbers say that it changed, could have, and moved the tool by more than the noise."""

from dataclasses import replace

import pytest

from armscope.comparison import compare
from armscope.comparison.sets import stacked
from armscope.comparison.shared_model import SharedModel
from armscope.comparison.standing import least_seen_mm, stands
from tests.comparison.test_changes import ARM, session
from tests.comparison.test_remedies import CHANGE

TABLES = {"a": session(81), "b": session(82, offsets={3: 9e-4})}


@pytest.fixture(scope="module")
def zero():
    model = SharedModel(ARM, *stacked(ARM, TABLES))
    possible = model.possible_changes([((1,), (0,))])
    return model, next(each for each in possible if str(each.placed) == "joint_offset at joint 3")


@pytest.mark.long
def test_what_was_planted_stands(zero):
    (change,) = compare(ARM, TABLES).changes
    assert stands(*zero, change, [zero[1]], 100)


def test_a_name_none_of_whose_numbers_surely_changed_does_not(zero):
    """Seen: an axis' wobble of four numbers, all of whose intervals held zero, before the zeros that it stood for."""
    number = replace(CHANGE.parameters[0], interval_95=(-1e-4, 1.8e-3))
    assert not stands(*zero, replace(CHANGE, parameters=(number, number)), [zero[1]], 100)
    assert stands(*zero, replace(CHANGE, parameters=(number, CHANGE.parameters[0])), [zero[1]], 100), "one of them did"


@pytest.mark.parametrize(
    ("effect", "name", "can"),
    [
        ("backlash", "gap", False),
        ("joint_compliance", "compliance", False),
        ("link_bending", "bending", False),
        ("joint_offset", "offset", True),
    ],
)
def test_what_cannot_be_below_zero_is_not_told_to_be(zero, effect, name, can):
    """Seen: play that went from 67 to -129 urad."""
    number = replace(
        CHANGE.parameters[0], name=name, values=(6.7e-5, -1.3e-4), stderrs=(3e-5, 3e-5), interval_95=(-2.3e-4, -1.5e-4)
    )
    told = replace(CHANGE, effect=effect, parameters=(number,))
    assert stands(*zero, told, [zero[1]], 100) == can
    held = replace(number, stderrs=(3e-5, 6e-5))
    assert stands(*zero, replace(told, parameters=(held,)), [zero[1]], 100), "less is nothing and noise"


def test_what_moves_the_tool_by_less_than_noise_hides_is_not_named(zero):
    """0.03 mm per axis, 70 rows and 70: a mean difference of some 0.03 mm x sqrt(2 / 70) is known by one deviation."""
    least = least_seen_mm(*zero, [zero[1]], 100)
    assert 3 < least / (0.03 * (2 / 70) ** 0.5) < 5, "one of a hundred is told from four deviations on"
    assert not stands(*zero, replace(CHANGE, rms_mm=0.9 * least), [zero[1]], 100)
    assert stands(*zero, replace(CHANGE, rms_mm=1.1 * least), [zero[1]], 100)


@pytest.mark.long
def test_what_else_changed_is_no_noise():
    """Seen: a drive whose interval was far from zero had no name, beside a zero that had moved the tool by far more."""
    moved = {2: 2e-3, 3: -2e-3, 5: 2.5e-4}
    found = compare(ARM, {"a": session(83, rows=110), "b": session(84, rows=110, offsets=moved)})
    assert {(each.effect, each.location) for each in found.changes} == {
        ("joint_offset", f"joint {joint}") for joint in moved
    }
