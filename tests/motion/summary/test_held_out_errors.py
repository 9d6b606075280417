"""How well torque is met, in words: one figure, and digits enough to tell it from the one before."""

from __future__ import annotations

from armscope.motion.summary.held_out_errors import HeldOutErrors


def test_figures_that_differ_are_told_so_that_they_do() -> None:
    assert HeldOutErrors(0.0130, 0.0129, 0.0129).words().endswith("met to 1.29 % instead of 1.30 %.")
    assert HeldOutErrors(0.058, 0.058, 0.058).words().endswith("met to 5.8 % by friction and rotors alone.")


def test_what_the_named_causes_meet_comes_first_and_what_is_found_anew_behind_it() -> None:
    words = HeldOutErrors(0.211, 0.0271, 0.0207).words()
    assert "met to 2.1 % instead of 21 % by these causes; to 2.7 %" in words


def test_where_no_cause_is_told_none_is_said_to_meet_it() -> None:
    """It said "by these causes" behind "no cause of the library explains it"."""
    words = HeldOutErrors(0.052, 0.051, 0.044).words(causes=False)
    assert "met to 4.4 % instead of 5.2 % by what is fitted along; to 5.1 % where that, too," in words
    assert "causes" not in words
    words = HeldOutErrors(0.0516, 0.0505, 0.0516).words(causes=False)
    assert words.endswith("met to 5.2 % by friction and rotors alone.")
