"""An arm that can't move or turn its tool any way is led as far as it can be."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from armscope.compensation.compensate import compensate_physical
from armscope.compensation.path import as_path
from armscope.compensation.physical import identified_on
from armscope.compensation.reachable import reachable_by
from armscope.compensation.task import Options
from armscope.physics.effect import Part
from armscope.physics.geometric import JOINT_OFFSET
from armscope.physics.model import Base, FittedModel
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription

from ..physics.scenes import arm_named

LENGTHS_M, TOOL_M, ZEROS = (0.35, 0.3), np.array([0.045, 0.02]), np.array([0.0, 1.2e-3, -0.8e-3])


def scara() -> Arm:
    """Three upright axes, the quill held."""
    rows = [(350.0, 0.0, 400.0), (300.0, 180.0, 0.0), (0.0, 0.0, 150.0)]
    joints = [{"a_mm": a, "alpha_deg": alpha, "d_mm": d} for a, alpha, d in rows]
    content = {"name": "scara", "dh": {"joints": joints}, "tool_mm": [45.0, 20.0, 60.0]}
    return build_arm(RobotDescription.model_validate(content))


def in_the_plane(angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(N, 2) m and (N,) rad of the real arm's tool, whose zeros are off, written down by hand."""
    first, second, third = (angles + ZEROS).T
    beyond = first + second
    turned = beyond - third  # behind the second row all is upside down
    x, y = TOOL_M[0], -TOOL_M[1]
    along = LENGTHS_M[0] * np.cos(first) + LENGTHS_M[1] * np.cos(beyond) + x * np.cos(turned) - y * np.sin(turned)
    across = LENGTHS_M[0] * np.sin(first) + LENGTHS_M[1] * np.sin(beyond) + x * np.sin(turned) + y * np.cos(turned)
    return np.column_stack([along, across]), turned


def known() -> tuple[FittedModel, Recordings]:
    arm, count = scara(), 80
    angles = np.random.default_rng(1).uniform(-1.8, 1.8, (count, 3))
    one, ids = np.full(count, ""), np.arange(count).astype(str)
    table = Recordings(angles, np.zeros((count, 3)), run=one, target=one, id=ids)
    zeros = [p for p in JOINT_OFFSET.place(arm, table) if p.location != "joint 1"]
    parts = tuple(Part(p, np.array([ZEROS[int(p.location[-1]) - 1]])) for p in zeros)
    return FittedModel(arm, {"": Base(np.eye(3), np.zeros(3))}, parts=parts), table


@pytest.mark.parametrize("pose", [False, True])
@pytest.mark.parametrize("by_points", [False, True])
def test_a_scara_arm_is_led_in_its_plane_and_about_its_axis(pose: bool, by_points: bool) -> None:
    """All rows were refused: a pole, as the tool could not be moved in all directions."""
    model, table = known()
    angles = np.random.default_rng(2).uniform(-1.2, 1.2, (30, 3)) + np.array([0, 1.3, 0])
    wanted, turned = in_the_plane(angles - ZEROS)
    columns = dict(zip(("q1_rad", "q2_rad", "q3_rad"), angles.T, strict=True))
    if by_points and not pose:
        columns = {"x_mm": 1e3 * wanted[:, 0], "y_mm": 1e3 * wanted[:, 1], "z_mm": np.full(30, 190.0)}
    path = as_path(pd.DataFrame(columns), "path", model.arm)
    options = Options(pose=pose, separate_points=True, allowed_outside=np.inf, start_rad=np.array([0, 1.3, 0]))
    found = compensate_physical(model, identified_on(model.arm, table), path, options)
    good = found.reasons == ""
    assert good.mean() > 0.9
    reached, stands = in_the_plane(found.commands[good])
    before = in_the_plane(angles[good])[0] - wanted[good]
    assert np.abs(before).max() > 2e-4
    np.testing.assert_allclose(reached, wanted[good], atol=1e-8)
    if pose:
        np.testing.assert_allclose(np.sin(stands - turned[good]), 0, atol=1e-8)
    (note,) = [note for note in found.notes if "can't be moved along z" in note]
    assert ("turned about x or y" in note) == pose


def test_a_point_far_off_the_plane_is_refused() -> None:
    model, table = known()
    points = pd.DataFrame({"x_mm": [400.0, 400.0], "y_mm": [200.0, 200.0], "z_mm": [190.4, 240.0]})
    options = Options(separate_points=True, allowed_outside=np.inf, start_rad=np.array([0, 1.3, 0]))
    found = compensate_physical(model, identified_on(model.arm, table), as_path(points, "path", model.arm), options)
    assert found.reasons[0] == ""
    assert "no motor leads out of its plane" in found.reasons[1]
    assert any("leave what it misses there as it is (up to 0.4 mm)" in note for note in found.notes)


def test_an_arm_of_six_axes_is_led_anywhere() -> None:
    arm = arm_named("six-axis")
    can = reachable_by(arm, np.full(6, True))
    assert can.is_everywhere
    assert can.told(np.zeros(3), pose=True) == ""
    assert not reachable_by(arm, np.arange(6) < 1).is_everywhere


def test_five_motors_are_asked_for_points_not_for_every_orientation() -> None:
    rows = [(0.0, 90.0, 400.0), (350.0, 0.0, 0.0), (300.0, 0.0, 0.0), (0.0, 90.0, 0.0), (0.0, 0.0, 120.0)]
    joints = [{"a_mm": a, "alpha_deg": alpha, "d_mm": d} for a, alpha, d in rows]
    arm = build_arm(RobotDescription.model_validate({"name": "five", "dh": {"joints": joints}, "tool_mm": [50, 0, 80]}))
    angles = np.random.default_rng(4).uniform(-1, 1, (40, 5)) + np.array([0, 0.6, -1.0, 0.5, 0])
    one, ids = np.full(40, ""), np.arange(40).astype(str)
    table = Recordings(angles, np.zeros((40, 3)), run=one, target=one, id=ids)
    model = FittedModel(arm, {"": Base(np.eye(3), np.zeros(3))})
    path = as_path(pd.DataFrame(angles[:10], columns=[f"q{j}_rad" for j in range(1, 6)]), "path", arm)
    for pose, reasons in (
        (False, {""}),
        (True, {"5 motors can't set every orientation: leave it free (without --pose)"}),
    ):
        options = Options(pose=pose, separate_points=True, allowed_outside=np.inf)
        assert set(compensate_physical(model, identified_on(arm, table), path, options).reasons) == reasons
