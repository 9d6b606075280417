"""Numbers that somebody enters into a controller."""

from armscope.verdict.entries import angle, length


def test_an_angle_has_its_sign_in_degrees_and_in_mrad() -> None:
    assert angle(-1e-3) == "−0.0573° (−1.000 mrad)"
    assert angle(0.0) == "0.0000° (0.000 mrad)"


def test_what_is_entered_has_its_interval_and_no_digit_that_means_nothing() -> None:
    assert angle(-3.1034e-3, 2e-4) == "−0.178° (−3.10 mrad ± 0.39)"
    assert angle(-3.1034e-3, 5e-7) == "−0.1778° (−3.103 mrad ± 0.001)"
    assert length(0.5951, 0.009) == "+0.595 mm (± 0.018)"
    # known only together with another: what all of them do must survive the rounding of each, to 0.01 mm
    assert length(-0.1152, 1.7) == "−0.12 mm (± 3.33)"
