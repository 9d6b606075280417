"""The package's copy of the printed numbers, checked against sentences and sums of the paper."""

import filecmp
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.paper.printed import (
    predict_printed,
    printed_coefficients,
    printed_half_digits,
    printed_matrix,
    printed_table2,
    reading,
)

SHARED = Path(__file__).parents[3] / "shared" / "paper"
DATA = Path(__file__).parents[2] / "src" / "armscope" / "paper" / "data"


@pytest.mark.shared
@pytest.mark.parametrize("name", ["table2.csv", "equations.yaml"])
def test_the_copies_are_exact(name):
    if not (SHARED / name).is_file():
        pytest.skip(f"no {SHARED / name}: the folder of shared material is not beside the checkout")
    assert filecmp.cmp(SHARED / name, DATA / name, shallow=False)


def test_table2_is_complete():
    table = printed_table2()
    assert len(table) == 5 * 4 * 3
    assert not table.duplicated(["model", "trajectory", "axis"]).any()
    assert table.set_index(["model", "trajectory", "axis"])["printed"]["FDP(CI)", "test 1", "y"] == 4.5


def test_equations_9_to_20_have_the_paper_s_numbers_of_coefficients():
    """15 parameters for first-degree angular polynomials, as section 5 counts (it cites Eqs. 15-17, which have 12)."""
    counts = printed_coefficients().groupby("model").size()
    assert counts.to_dict() == {"FDP(AI)": 15, "SDP(AI)": 27, "FDP(CI)": 12, "SDP(CI)": 21}
    equations = printed_coefficients()["equation"]
    assert sorted(equations.unique()) == list(range(9, 21))


def test_equation_15_by_hand():
    p = np.array([[1100.0, 800.0, 600.0]])
    expected = 0.73120 - 0.00130 * 1100 + 0.00089 * 800 - 0.00151 * 600
    assert predict_printed("FDP(CI)", p)[0, 0] == pytest.approx(expected)


def test_equation_14_by_hand():
    t1, t2, t3, t6 = 0.3, -0.4, 0.9, 1.5
    expected = -2.15 - 0.58 * t1 + 0.32 * t1**2 + 1.70 * t2 - 0.53 * t2**2 + 1.87 * t3 + 0.54 * t3**2
    expected += -1.84 * t6 + 0.42 * t6**2
    assert predict_printed("SDP(AI)", [[t1, t2, t3, 0.7, -0.7, t6]])[0, 2] == pytest.approx(expected)


def test_equation_19_by_hand():
    x, y, z = 900.0, -300.0, 1200.0
    expected = -0.41293 - 0.00132 * x + 0.00000004 * x**2 - 0.00108 * y - 0.0000001 * y**2 + 0.00201 * z
    expected -= 0.0000002 * z**2
    assert predict_printed("SDP(CI)", [[x, y, z]])[0, 1] == pytest.approx(expected)


def test_half_digits_follow_the_printed_decimals():
    assert np.allclose(printed_half_digits("FDP(CI)"), 5e-6)
    assert np.allclose(printed_half_digits("FDP(AI)"), 5e-3)
    second = printed_half_digits("SDP(CI)")
    assert second.shape == printed_matrix("SDP(CI)").shape
    assert np.isclose(second, 5e-9).sum() == 1  # 0.00000004 alone has eight decimals
    assert np.isclose(second, 5e-8).sum() == 8


def test_units_of_coefficients():
    units = printed_coefficients().set_index(["model", "axis", "term"])["unit"]
    assert units["SDP(CI)", "x", "px^2"] == "mm/mm^2"
    assert units["FDP(AI)", "x", "theta1"] == "mm/rad"
    assert units["FDP(CI)", "z", "const"] == "mm"


POINTS = np.random.default_rng(0).uniform(-1000, 1000, (50, 3))


def value(table, quantity):
    return table.set_index("quantity")["value"][quantity]


def test_the_printed_equations_are_a_turn_of_2_5_mrad_and_a_scale():
    table = reading(POINTS)
    assert value(table, "rotation") == pytest.approx(2.52, abs=0.01)
    assert value(table, "scale") == pytest.approx(-0.134)
    assert value(table, "rotation about x") == pytest.approx((-0.00183 - 0.00171) / 2 * 1e3)
    assert value(table, "rotation about z") == pytest.approx((-0.00130 - 0.00089) / 2 * 1e3)
    strains = [value(table, f"rest, {name} strain") for name in ("largest", "middle", "smallest")]
    assert sum(strains) == pytest.approx(0)
    assert np.linalg.norm(strains) == pytest.approx(value(table, "rest"))


def test_a_rigid_motion_and_scale_is_read_back(monkeypatch):
    turn = np.array([1e-5, -2e-5, 3e-5])
    gradient = (1 - 2e-5) * Rotation.from_rotvec(turn).as_matrix() - np.eye(3)
    planted = np.column_stack([[0.1, 0.2, 0.3], gradient])
    import sys

    monkeypatch.setattr(sys.modules["armscope.paper.printed"], "printed_matrix", lambda model: planted)
    table = reading(POINTS)
    assert [value(table, f"rotation about {axis}") for axis in "xyz"] == pytest.approx(turn * 1e3, rel=1e-3)
    assert value(table, "scale") == pytest.approx(-0.002, rel=1e-3)
    assert value(table, "rest") < 1e-5
    assert value(table, "translation y") == pytest.approx(0.2)


def test_the_parts_add_up():
    """By the triangle inequality, whatever the points."""
    table = reading(POINTS)
    parts = [
        value(table, f"RMS moved by {name}") for name in ("translation of the centre", "rotation", "scale", "rest")
    ]
    assert value(table, "RMS moved by all") <= sum(parts)
    assert value(table, "RMS moved by all") >= max(parts) - min(parts)
