"""Geometric errors as twists against the same errors written into the D-H table."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.robot import chain, forward_kinematics, load_arm
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription
from armscope.world.tolerances import geometric_errors
from tests.robot.arms import SK120, STANDARD, as_urdf

KEYS = {"a": "a_mm", "alpha": "alpha_deg", "d": "d_mm", "theta": "theta_offset_deg"}
ROWS = [
    {"a_mm": 300, "alpha_deg": -90, "d_mm": 800, "theta_offset_deg": 10},
    {"a_mm": 1150, "alpha_deg": 0, "d_mm": 20, "theta_offset_deg": -90},
    {"a_mm": 250, "alpha_deg": 37, "d_mm": -60, "theta_offset_deg": 0},
    {"a_mm": 40, "alpha_deg": 90, "d_mm": 1225, "theta_offset_deg": 0},
]
Q = np.random.default_rng(0).uniform(-2, 2, (20, 4))


def arm(convention, rows=ROWS):
    content = {"name": "t", "dh": {"convention": convention, "joints": rows}, "tool_mm": [200, 10, 30]}
    return build_arm(RobotDescription.model_validate(content))


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize("row", range(4))
@pytest.mark.parametrize("name", list(KEYS))
def test_a_small_error_is_the_changed_table(convention, row, name):
    errors = geometric_errors(arm(convention), link_m=1e-5, link_rad=1e-5)
    k = errors.names.index(f"{name}{row + 1}")
    in_sigmas = np.zeros(len(errors.names))
    in_sigmas[k] = 1.0
    changed = [dict(each) for each in ROWS]
    changed[row][KEYS[name]] += 1e-2 if KEYS[name].endswith("mm") else np.degrees(1e-5)
    expected = forward_kinematics(arm(convention, changed), Q)
    moved = np.abs(expected - forward_kinematics(arm(convention), Q)).max()
    assert moved > 1e-7
    assert np.abs(errors.positions(Q, in_sigmas)[0] - expected).max() < 1e-9


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_the_jacobian_is_the_slope_of_the_exact_positions(convention):
    errors = geometric_errors(arm(convention))
    jacobian = errors.jacobian(chain(errors.arm, Q))
    step = 1e-3
    for k in range(len(errors.names)):
        unit = np.eye(len(errors.names))[k] * step
        slope = (errors.positions(Q, unit)[0] - errors.positions(Q, -unit)[0]) / (2 * step)
        assert np.abs(jacobian[:, :, k] - slope).max() < 1e-9


def test_robots_side_by_side_are_the_robots_one_by_one():
    errors = geometric_errors(arm("standard"))
    many = np.random.default_rng(1).normal(size=(3, len(errors.names)))
    together = errors.positions(Q, many)
    for one, expected in zip(many, together, strict=True):
        assert np.array_equal(errors.positions(Q, one)[0], expected)


def test_parallel_axes_alone_have_a_turn_about_y():
    assert [n for n in geometric_errors(arm("standard")).names if n.startswith("beta")] == ["beta2"]
    assert [n for n in geometric_errors(arm("modified")).names if n.startswith("beta")] == ["beta2"]


def test_the_base_is_registered_with_its_own_tolerance():
    errors = geometric_errors(arm("standard"), base_m=3e-3, base_rad=2e-3)
    shift = np.zeros(len(errors.names))
    shift[errors.names.index("base y")] = 1.0
    nominal = forward_kinematics(errors.arm, Q)
    assert np.allclose(errors.positions(Q, shift)[0] - nominal, [0, 3e-3, 0], atol=1e-15)
    turn = np.zeros(len(errors.names))
    turn[errors.names.index("base rz")] = 1.0
    moved = errors.positions(Q, turn)[0] - nominal
    assert np.allclose(moved[:, 2], 0, atol=1e-15)
    assert np.allclose(np.linalg.norm(moved, axis=1), 2e-3 * np.hypot(nominal[:, 0], nominal[:, 1]), rtol=1e-5)


def test_a_urdf_has_frames_that_are_shifted_and_turned(tmp_path):
    file = tmp_path / "arm.urdf"
    file.write_text(as_urdf(STANDARD))
    errors = geometric_errors(build_arm(RobotDescription(name="u", urdf=str(file), tip="flange")))
    assert len(errors.names) == 6 + 6 * 6
    angles = np.random.default_rng(2).uniform(-1, 1, (5, 6))
    jacobian = errors.jacobian(chain(errors.arm, angles))
    unit = np.eye(len(errors.names))[errors.names.index("ry3")] * 1e-3
    slope = (errors.positions(angles, unit)[0] - errors.positions(angles, -unit)[0]) / 2e-3
    assert np.abs(jacobian[:, :, errors.names.index("ry3")] - slope).max() < 1e-9


def test_one_arms_frames_end_where_its_positions_are():
    """Both ways to the tool agree, and the orientation turns by what the errors' rotations add up to."""
    errors = geometric_errors(load_arm(SK120))
    rng = np.random.default_rng(4)
    sizes, angles = rng.normal(size=len(errors.names)), rng.uniform(-1, 1, (5, 6))
    frames = errors.frames(angles, sizes)
    np.testing.assert_allclose(frames.tool, errors.positions(angles, sizes)[0], atol=1e-12)
    only_turn = np.array([float(name == "base rz") for name in errors.names])
    turned = errors.frames(angles, only_turn).tool_rotation @ np.swapaxes(chain(errors.arm, angles).tool_rotation, 1, 2)
    expected = Rotation.from_rotvec([0, 0, 3e-3]).as_matrix()
    np.testing.assert_allclose(turned, np.broadcast_to(expected, turned.shape), atol=1e-12)
