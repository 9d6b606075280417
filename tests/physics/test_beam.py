"""A link as a cantilever under its own weight: against the sum of many point loads on it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from armscope.core.types import Array
from armscope.physics.beam import bent, spread_weight

LENGTH, E = 0.8, np.array([0.6, 0.0, 0.8])
NONE = np.zeros((1, 3))


def by_point_loads(points: list[tuple[float, Array, Array]]) -> Array:
    """(6,) shift and turn of the end under forces at (x from the root, beside the beam)."""
    shift, turn = np.zeros(3), np.zeros(3)
    for x, beside, load in points:
        force, moment = load - (load @ E) * E, np.cross(beside, load)
        moment = moment - (moment @ E) * E
        turn += x * moment + x**2 / 2 * np.cross(E, force)
        shift += x * (LENGTH - x / 2) * np.cross(moment, E) + x**2 * (3 * LENGTH - x) / 6 * force
    return np.concatenate([shift, turn])


@given(st.floats(-1.4, 0.4), st.tuples(*[st.floats(-0.2, 0.2)] * 3), st.tuples(*[st.floats(-50, 50)] * 3))
def test_own_weight_keeps_its_sum_and_its_centre(along, off, load) -> None:
    centre = along * LENGTH * E + np.array(off)
    spread = spread_weight(centre, E, LENGTH)
    at_root = 1 - spread.even - spread.at_end
    assert min(spread.even, spread.at_end, at_root) >= -1e-12
    from_root = 1 + float(centre @ E) / LENGTH
    if 0 <= from_root <= 1:
        assert spread.even / 2 + spread.at_end == pytest.approx(from_root)
        beside = centre - (centre @ E) * E
        np.testing.assert_allclose(
            spread.even * spread.off_beam + spread.at_end * spread.off_end, (1 - at_root) * beside, atol=1e-12
        )
    weight = np.array(load)
    pieces = 2000
    points = [((k + 0.5) / pieces * LENGTH, spread.off_beam, spread.even * weight / pieces) for k in range(pieces)]
    points.append((LENGTH, spread.off_end, spread.at_end * weight))
    found = bent(E, LENGTH, NONE, NONE, weight[None], spread)[0]
    np.testing.assert_allclose(found, by_point_loads(points), atol=1e-6 * (1 + np.abs(weight).max()))


def test_a_uniform_beam_sags_by_an_eighth_and_turns_by_a_sixth() -> None:
    e = np.array([1.0, 0.0, 0.0])
    weight = np.array([[0.0, -10.0, 0.0]])
    sag = bent(e, 2.0, NONE, NONE, weight, spread_weight(np.array([-1.0, 0.0, 0.0]), e, 2.0))[0]
    np.testing.assert_allclose(sag, [0, -10 * 2**3 / 8, 0, 0, 0, -10 * 2**2 / 6])


def test_a_mass_at_the_root_bends_nothing_and_one_at_the_end_by_a_third() -> None:
    e = np.array([1.0, 0.0, 0.0])
    weight = np.array([[0.0, -10.0, 0.0]])
    assert not bent(e, 2.0, NONE, NONE, weight, spread_weight(np.array([-2.0, 0.0, 0.0]), e, 2.0)).any()
    end = bent(e, 2.0, NONE, NONE, weight, spread_weight(np.zeros(3), e, 2.0))
    np.testing.assert_allclose(end, bent(e, 2.0, weight, NONE, NONE, spread_weight(np.zeros(3), e, 2.0)))
    assert end[0, 1] == pytest.approx(-10 * 2**3 / 3)
