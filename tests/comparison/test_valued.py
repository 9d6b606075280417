"""A number that changed: what the poses leave open of it is not printed as if it were known."""

import math
from dataclasses import replace

from armscope.comparison.valued import Valued, number_line, wave_part


def length(stderr_m: float, change_stderr_m: float) -> Valued:
    half = 1.96 * change_stderr_m
    values, errors = (2e-4, 5e-4), (stderr_m,) * 2
    return Valued("a", "m", values, errors, (0.0, 3e-4), (0.0, change_stderr_m), 3e-4, (3e-4 - half, 3e-4 + half))


def test_a_known_number_is_told_before_and_after():
    assert number_line(length(1e-5, 1e-5)) == "a: 0.200 -> 0.500 mm; change 0.300 (0.280 ... 0.320) mm"


def test_what_is_alike_in_all_may_be_open_while_the_change_is_known():
    line = number_line(length(1e-3, 1e-5))
    assert "change 0.300 (0.280 ... 0.320) mm" in line
    assert "leave open" in line


def test_an_interval_of_decimetres_is_no_number():
    number = length(0.15, 0.15)
    assert number.unknown
    assert number_line(number) == "a: these poses leave open what it is, and how far it changed"


def test_a_change_that_is_surely_none_of_zero_is_told_however_wide_its_interval():
    """A link that a crash made 12 mm longer, of which the poses leave open how long it was."""
    number = Valued("a", "m", (-1e-3, 11e-3), (0.03,) * 2, (0.0, 12e-3), (0.0, 2e-3), 12e-3, (8e-3, 16e-3))
    assert number.left_open
    assert not number.unknown
    assert "change 12.0 (8.0 ... 16.0) mm" in number_line(number)


def test_a_unit_without_a_known_range_is_told_as_it_is():
    number = Valued("x", "kg", (0.0, 1.0), (9.0, 9.0), (0.0, 1.0), (0.0, 9.0), 1.0, (-17.0, 19.0))
    assert not number.unknown
    assert math.isclose(number.difference, 1.0)


def test_a_direction_that_the_rows_do_not_determine_is_no_number_whatever_its_unit():
    """Seen: 0 (-5764 ... 5764) µrad per m/s², where a drive shows some µrad on any arm."""
    interval, zeros = (-5.8e-3, 5.8e-3), (0.0, 0.0)
    number = Valued("x", "rad/(m/s2)", (1e-3, 1e-3), (3e-3,) * 2, zeros, (0.0, 3e-3), 0.0, interval, plausible=1e-5)
    assert number.unknown
    assert number_line(number) == "x: these poses leave open what it is, and how far it changed"
    sure = replace(number, difference=4e-3, interval_95=(1e-3, 7e-3))
    assert not sure.unknown, "that it changed is told"
    assert not replace(number, interval_95=(-5e-5, 5e-5)).unknown


def test_parts_of_waves_have_names():
    assert wave_part("cosine_2") == "cosine part of the wave, 2 per turn"
    assert wave_part("sine_rx") == "sine part of the wave, about x"
    assert wave_part("offset") == ""
