"""That there is less of a cause is said where it is known: the other errors of an arm decide nothing by chance."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.comparison import Valued, compare
from armscope.comparison.gained import more_or_less
from armscope.comparison.remedies import remedy_of
from armscope.physics.registry import library
from tests.comparison.test_changes import ARM, session
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
