"""A link as a cantilever under its own weight: against the sum of many point loads on it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from armscope.core.types import Array
from armscope.physics.beam import bent, spread_weight
from armscope.physics.effect import Part
from armscope.physics.elastic import LINK_BENDING
from armscope.recordings import Recordings
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription
from tests.physics.test_tilting import moved
from tests.robot.arms import STANDARD, as_urdf

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


def test_a_links_bending_is_the_same_by_d_h_rows_and_by_a_urdf(tmp_path: Path) -> None:
    """The body between joints j and j+1 is link j of standard rows, and link j+1 of a URDF, which stands before it."""
    file = tmp_path / "arm.urdf"
    file.write_text(as_urdf(STANDARD))
    by_urdf = build_arm(RobotDescription(name="u", urdf=str(file), tip="flange", tool_mm=(40.0, 20.0, 150.0)))
    links = []
    for number, (a, alpha, d, theta) in enumerate(STANDARD, start=1):
        turned = Rotation.from_euler("z", -theta, degrees=True).apply([100.0, 20.0, 100.0 * number])
        centre = Rotation.from_euler("x", -alpha, degrees=True).apply(turned - [a, 0.0, d])
        links.append({"mass_kg": float(number), "com_mm": centre.tolist()})
    rows = [dict(zip(("a_mm", "alpha_deg", "d_mm", "theta_offset_deg"), row, strict=True)) for row in STANDARD]
    content = {"name": "d", "dh": {"joints": rows}, "links": links, "tool_mm": [40.0, 20.0, 150.0]}
    by_rows = build_arm(RobotDescription.model_validate(content))
    angles = np.random.default_rng(2).uniform(-2, 2, (20, 6))
    table = Recordings(angles, np.zeros((20, 3)), *(np.full(20, "1") for _ in range(3)))
    asked = 0
    for j in range(1, 6):
        of_rows, of_urdf = (
            [p for p in LINK_BENDING.place(arm, table) if p.location == f"link {link}"]
            for arm, link in ((by_rows, j), (by_urdf, j + 1))
        )
        assert len(of_rows) == len(of_urdf)
        for one, other in zip(of_rows, of_urdf, strict=True):
            bend = moved(by_rows, table, Part(one, np.array([1e-7])))
            np.testing.assert_allclose(
                moved(by_urdf, table, Part(other, np.array([1e-7]))), bend, atol=1e-4 * np.abs(bend).max()
            )
            asked += 1
    assert asked >= 3
