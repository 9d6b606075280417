"""That there is less of a cause is said where it is known: the other errors of an arm decide nothing by chance."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.comparison import Valued, compare
from armscope.comparison.gained import least_seen_mm, more_or_less, own_values, stands
from armscope.comparison.remedies import remedy_of
from armscope.comparison.sets import stacked
from armscope.comparison.shared_model import SharedModel
from armscope.physics.registry import library
from tests.comparison.test_at_the_tool import of_zero
from tests.comparison.test_changes import ARM, session
from tests.comparison.test_remedies import CHANGE
from tests.comparison.worlds import recorded
from tests.seeds import seeds

PLACED = {each.name: each for each in library(ARM, session(1))}


def number(difference, half, values=(1e-5, 1e-5)):
    interval = (difference - half, difference + half)
    return Valued("any", "rad", values, (1e-3,) * 2, (0.0, difference), (0.0, half / 2), difference, interval)


@pytest.mark.parametrize("cause", ["joint_compliance", "bearing_compliance", "backlash"])
def test_what_cannot_be_negative_is_more_where_it_rose_and_less_where_it_fell(cause):
    """Whatever else the arm has: seen, a drive that became 2.2 times as soft was a repair that worked."""
    told = {
        size: more_or_less(PLACED[cause], [number(size, 1e-6)], sigmas=-np.sign(size) * 9) for size in (2e-6, -2e-6)
    }
    assert told == {2e-6: "more", -2e-6: "less"}
    assert more_or_less(PLACED[cause], [number(1e-7, 1e-6)], sigmas=9.0) == ""


def test_a_zero_is_more_or_less_where_its_size_says_so():
    told = {s: more_or_less(PLACED["joint_offset"], [number(1e-3, 1e-5)], s) for s in (-3.0, -1.0, 0.0, 1.0, 3.0)}
    assert told == {-3.0: "less", -1.0: "", 0.0: "", 1.0: "", 3.0: "more"}


@pytest.mark.parametrize("seed", [11, 13])
def test_a_crash_of_an_arm_whose_other_zeros_are_off_is_no_repair(seed):
    """From ±0.1 to ±0.6 mrad. Other zeros make up for a part of it, so that taking it back leaves more."""
    rng, joint = np.random.default_rng(seed), 2 + seed % 4
    own = {each: rng.normal(0, 1e-3) for each in range(2, 6)}
    own[joint] = np.sign(own[joint]) * 1e-4
    q = session(seed).motor_angles
    found = compare(ARM, {"a": recorded(q, own, rng), "b": recorded(q, own | {joint: 6 * own[joint]}, rng)})
    (change,) = found.changes
    assert change.location == f"joint {joint}"
    assert change.taken_back_mm > change.left_mm, "and still"
    told = remedy_of(found, change)
    assert (change.is_less, change.known_sense) == (False, "")
    assert "there is less of it" not in told.instruction
    assert "repair worked" not in told.why
    assert told.instruction.startswith("Whether there is more of it in b than in a or less is not known")
    assert f"After a crash: Reset the zero of joint {joint}: it moved by" in told.instruction


@pytest.mark.parametrize("seed", seeds(1, 3))
def test_where_hardly_anything_else_is_off_it_is_known(seed):
    rng, joint, q = np.random.default_rng(seed), 2 + seed % 4, session(seed).motor_angles
    two = {"off": recorded(q, {joint: 1e-3}, rng), "set": recorded(q, {}, rng)}
    (came,), (went,) = (compare(ARM, {name: two[name] for name in order}).changes for order in (("set", "off"), two))
    assert (came.known_sense, went.known_sense) == ("more", "less")


def test_what_became_of_it_is_not_told_against_what_is_known():
    wave = replace(number(-1e-3, 1e-5))
    assert more_or_less(PLACED["gear_eccentricity"], [wave, wave], sigmas=-5.0) == "less"


def test_how_large_it_is_is_known_the_better_the_less_others_may_be():
    """A zero of 1 mrad that came: its change is known to a tenth, its size only beside what else there may be."""
    model, zero = of_zero({"a": session(1), "b": session(2, offsets={3: 1e-3})}, 3)
    since = np.array([-1.0, 1.0])
    errors = []
    for prior in (3.0, 0.3):
        values, covariance, _ = own_values(model, zero.number, (), 2, prior)
        assert abs(since @ values - 1e-3) < 3 * np.sqrt(since @ covariance @ since) < 2e-4
        errors.append(np.sqrt(covariance[0, 0]))
    assert errors[1] < 0.5 * errors[0]


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
