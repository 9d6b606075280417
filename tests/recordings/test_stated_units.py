"""Units that a foreign table states: behind a name, or in the line below it."""

from __future__ import annotations

import pytest

from armscope.recordings.importing.stated_units import ANGLE_UNITS, LENGTH_UNITS, stated_unit


@pytest.mark.parametrize(
    ("name", "below", "units", "expected"),
    [
        ("X [mm]", "", LENGTH_UNITS, "mm"),
        ("X(in)", "", LENGTH_UNITS, "in"),
        ("x_m", "", LENGTH_UNITS, "m"),
        ("Y (Zoll)", "", LENGTH_UNITS, "in"),
        ("A1 [°]", "", ANGLE_UNITS, "deg"),
        ("A1", "[deg]", ANGLE_UNITS, "deg"),
        ("X", "cm", LENGTH_UNITS, "cm"),
        ("X [mm]", "m", LENGTH_UNITS, "mm"),
        ("X", "", LENGTH_UNITS, None),
        ("X tracker", "1.5", LENGTH_UNITS, None),
    ],
)
def test_a_unit_is_read_from_the_name_first_and_else_from_below(
    name: str, below: str, units: dict[str, str], expected: str | None
) -> None:
    assert stated_unit(name, below, units) == expected
