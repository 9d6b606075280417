"""Numbers as sentences say them."""

import pytest

from armscope.core.numerals import or_less, rounded, size_of


@pytest.mark.parametrize(("value", "said"), [(0.0123, "0.012"), (1e-3, "0.001"), (8.4e-8, "below 0.001")])
def test_what_has_converged_is_not_told_to_the_last_bit(value: float, said: str) -> None:
    assert or_less(value) == said


def test_sizes_have_two_digits_and_the_fields_unit() -> None:
    assert (size_of(6.3e-4, "rad"), size_of(-2e-4, "rad", sign=True)) == ("0.63 mrad", "−200 µrad")
    assert (rounded(0.0), rounded(float("nan"))) == ("0", "–")
