import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.paper.reading import reading

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

    monkeypatch.setattr(sys.modules["armscope.paper.reading"], "printed_matrix", lambda model: planted)
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
