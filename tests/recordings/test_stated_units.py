"""Units that a foreign table states: behind a name, or in the line below it."""

from __future__ import annotations

import pytest

from armscope.recordings.importing.stated_units import ANGLE_UNITS, LENGTH_UNITS, SPEED_UNITS, stated_unit, unknown_unit


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
        ("X [um]", "", LENGTH_UNITS, "um"),
        ("X [µm]", "", LENGTH_UNITS, "um"),
        ("X [μm]", "", LENGTH_UNITS, "um"),
        ("X / mm", "", LENGTH_UNITS, "mm"),
        ("X [ft]", "", LENGTH_UNITS, "ft"),
        ("X (measured) [mm]", "", LENGTH_UNITS, "mm"),
        ("J1 [gon]", "", ANGLE_UNITS, "gon"),
        ("J1 [mrad]", "", ANGLE_UNITS, "mrad"),
        ("J1 [Grad]", "", ANGLE_UNITS, "deg"),
        ("dq1 [deg/s]", "", SPEED_UNITS, "deg/s"),
        ("X [furlong]", "", LENGTH_UNITS, None),
        ("X", "", LENGTH_UNITS, None),
        ("X tracker", "1.5", LENGTH_UNITS, None),
    ],
)
def test_a_unit_is_read_from_the_name_first_and_else_from_below(
    name: str, below: str, units: dict[str, str], expected: str | None
) -> None:
    assert stated_unit(name, below, units) == expected


@pytest.mark.parametrize(
    ("name", "below", "expected"),
    [
        ("X [furlong]", "", "furlong"),
        ("X", "[furlong]", "[furlong]"),
        ("X [mm]", "", ""),
        ("X (measured)", "", ""),
        ("X (Leica)", "mm", ""),
        ("X[1]", "", ""),
        ("X", "", ""),
        ("X_tracker", "", ""),
    ],
)
def test_a_unit_that_is_stated_and_not_known_is_its_word(name: str, below: str, expected: str) -> None:
    assert unknown_unit(name, below, LENGTH_UNITS) == expected
