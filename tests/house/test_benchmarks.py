"""Benchmarks are run by hand, so what they reach into must be there: a part of a diagnosis is timed inside it."""

from pathlib import Path

from benchmarks.diagnosis import measure, told

EXAMPLE = Path(__file__).parents[2] / "examples" / "one-effect"


def test_the_atlas_is_timed_inside_the_diagnosis():
    found = measure(EXAMPLE, 0)
    (whole,), (atlas,) = found["cpu"], found["atlas"]
    assert 0 < atlas < whole
    assert "60 rows" in told("one-effect", found)
