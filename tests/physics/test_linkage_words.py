"""A parallelogram tells the bars that are off, and of which length its shares are."""

import pytest

from armscope.physics.clause import Number, Told
from armscope.physics.linkage_words import bars_differ


def said(**bars: Number) -> str:
    return bars_differ(Told("parallelogram_geometry", "parallelogram", "angle of joint 3", bars))


def test_each_bar_that_is_off_is_told_the_rocker_first() -> None:
    both = said(rod=Number(5.2e-5, "m/m", 2e-6), rocker=Number(-2.87e-4, "m/m", 3e-6))
    assert both.startswith("the parallelogram's bars differ: rocker by −287 ")
    assert " and rod by +52 " in both
    assert both.endswith("of the rocker's length")


def test_a_bar_whose_error_may_be_none_is_not_told() -> None:
    one = said(rod=Number(2.4e-6, "m/m", 2.3e-6), rocker=Number(-2.69e-4, "m/m", 3e-6))
    assert "rod" not in one
    assert "rocker by −269 " in one
    unsure = said(rod=Number(0.2, "mm", 0.4), rocker=Number(0.1, "mm", 0.4))
    assert "rod by +0.2" in unsure
    assert "rocker" not in unsure, "lengths are of nothing"


def test_without_a_number_another_clause_is_said() -> None:
    with pytest.raises(KeyError):
        said()
