"""Units of pasted D-H rows: a column's own, then that of the other of its kind, then a guess that is said."""

import pytest

from armscope.core.inputs import InputError
from armscope.robot.dh_cells import DHLine, read_dh_cell
from armscope.robot.dh_units import all_units, in_file_units


def line(number, a, alpha, d, theta):
    named = zip(("a_mm", "alpha_deg", "d_mm", "theta_offset_deg"), (a, alpha, d, theta), strict=True)
    return DHLine(number, {name: read_dh_cell(text) for name, text in named}, theta)


def test_every_column_has_its_own_unit():
    units = all_units({"a_mm": "m", "d_mm": "mm", "alpha_deg": "rad", "theta_offset_deg": "deg"}, [], {})
    row = in_file_units(line(1, "0.27", "1.5", "290", "q1+90"), units)
    assert row == pytest.approx({"a_mm": 270, "alpha_deg": 85.943669269, "d_mm": 290, "theta_offset_deg": 90})


@pytest.mark.parametrize(("unit", "millimetres"), [("mm", 2), ("cm", 20), ("m", 2000), ("in", 50.8)])
def test_lengths_in_other_units(unit, millimetres):
    units = all_units({"a_mm": unit, "alpha_deg": "deg"}, [], {})
    assert in_file_units(line(1, "2", "0", "0", "0"), units)["a_mm"] == pytest.approx(millimetres)


def test_pi_needs_no_guess():
    source = {}
    units = all_units({"a_mm": "mm"}, [line(1, "0", "pi/2", "100", "q1-π")], source)
    assert in_file_units(line(1, "0", "pi/2", "100", "q1-π"), units)["alpha_deg"] == pytest.approx(90)
    assert source == {"dh angles": "stated: by pi or °"}


def test_pi_beside_degrees_is_each_in_its_own():
    units = all_units({"a_mm": "mm"}, [line(1, "0", "pi/2", "100", "q1-90")], {})
    row = in_file_units(line(1, "0", "pi/2", "100", "q1-90"), units)
    assert (row["alpha_deg"], row["theta_offset_deg"]) == pytest.approx((90, -90))


def test_a_quarter_turn_without_a_unit_beside_degrees_is_refused():
    with pytest.raises(InputError, match=r"line 2, alpha: found '1\.5708'"):
        all_units({}, [line(1, "0", "90", "1", "q1"), line(2, "0", "1.5708", "1", "q2")], {})
