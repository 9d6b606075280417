"""Orientations in any of their shapes become unit quaternions, or one clear error."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.core.inputs import InputError

from .raw import convert, with_columns


def test_euler_angles_turn_about_moving_or_fixed_axes_as_declared(tmp_path):
    def about(axis, degrees):
        return Rotation.from_rotvec(np.radians(degrees) * np.eye(3)["xyz".index(axis)]).as_matrix()

    raw = "j1,j2,x,y,z,a,b,c\n0,0,1,2,3,10,20,30\n"
    for sequence, expected in [
        ("XYZ", about("x", 10) @ about("y", 20) @ about("z", 30)),
        ("xyz", about("z", 30) @ about("y", 20) @ about("x", 10)),
        ("ZYX", about("z", 10) @ about("y", 20) @ about("x", 30)),
    ]:
        mapping = with_columns(orientation={"euler": ["a", "b", "c"], "sequence": sequence, "unit": "deg"})
        _, table = convert(tmp_path, raw, mapping)
        w, x, y, z = table[["qw", "qx", "qy", "qz"]].to_numpy()[0]
        np.testing.assert_allclose(Rotation.from_quat([x, y, z, w]).as_matrix(), expected, atol=1e-9)


@pytest.mark.parametrize(("unit", "size"), [("rad", 1.0), ("deg", 180 / np.pi)])
def test_a_rotation_vector_is_the_axis_times_the_angle(tmp_path, unit, size):
    """Rodrigues' formula, written out; Universal Robots' controllers write rx, ry, rz so."""
    vector = np.array([-1.502279, 1.602762, -2.063273])
    angle = np.linalg.norm(vector)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    expected = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    raw = "j1,j2,x,y,z,a,b,c\n0,0,1,2,3," + ",".join(map(repr, (vector * size).tolist())) + "\n"
    mapping = with_columns(orientation={"rotation_vector": ["a", "b", "c"], "unit": unit})
    _, table = convert(tmp_path, raw, mapping)
    w, x, y, z = table[["qw", "qx", "qy", "qz"]].to_numpy()[0]
    np.testing.assert_allclose(Rotation.from_quat([x, y, z, w]).as_matrix(), expected, atol=1e-9)


@pytest.mark.parametrize(
    "orientation",
    [
        {"rotation_vector": ["a", "b", "c"]},
        {"rotation_vector": ["a", "b", "c"], "unit": "rad", "sequence": "XYZ"},
        {"rotation_vector": ["a", "b", "c"], "euler": ["a", "b", "c"], "unit": "rad", "sequence": "XYZ"},
    ],
)
def test_a_rotation_vector_has_a_unit_and_nothing_else(tmp_path, orientation):
    with pytest.raises(InputError, match=r"unit|one of the four"):
        convert(tmp_path, "j1,j2,x,y,z,a,b,c\n0,0,1,2,3,0,0,1\n", with_columns(orientation=orientation))


POSE = {
    "columns": {
        "angles": {"columns": ["j1", "j2"], "unit": "rad"},
        "pose": {"matrix": [f"m{r}{c}" for r in range(4) for c in range(4)], "unit": "m"},
    }
}
POSE_HEADER = "j1,j2," + ",".join(f"m{r}{c}" for r in range(4) for c in range(4)) + "\n"


def pose_row(matrix):
    return POSE_HEADER + "0,0," + ",".join(map(repr, np.asarray(matrix, dtype=float).ravel().tolist())) + "\n"


def test_a_homogeneous_matrix_gives_position_and_quaternion(tmp_path):
    turn = Rotation.from_euler("XYZ", [0.3, -0.5, 2.0])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn.as_matrix(), [0.1, 0.2, 0.3]
    _, table = convert(tmp_path, pose_row(matrix), POSE)
    np.testing.assert_allclose(table[["x_mm", "y_mm", "z_mm"]].to_numpy()[0], [100, 200, 300], rtol=1e-9)
    x, y, z, w = turn.as_quat(canonical=True)
    np.testing.assert_allclose(table[["qw", "qx", "qy", "qz"]].to_numpy()[0], [w, x, y, z], atol=1e-9)


def test_matrices_that_are_no_poses_are_refused(tmp_path):
    mirrored = np.diag([1.0, 1.0, -1.0, 1.0])
    with pytest.raises(InputError, match="right-handed"):
        convert(tmp_path, pose_row(mirrored), POSE)
    by_columns = np.eye(4)
    by_columns[3, :3] = 1
    with pytest.raises(InputError, match="column by column"):
        convert(tmp_path, pose_row(by_columns), POSE)
    with pytest.raises(InputError, match="unit axes"):
        convert(tmp_path, pose_row(np.diag([1.0, 2.0, 1.0, 1.0])), POSE)


def test_a_quaternion_that_is_not_of_unit_length_is_refused(tmp_path):
    mapping = with_columns(orientation={"quaternion": ["a", "b", "c", "w"], "order": "xyzw"})
    with pytest.raises(InputError, match=r"line 2.*length 1, this one 1\.26"):
        convert(tmp_path, "j1,j2,x,y,z,a,b,c,w\n0,0,1,2,3,0.6,0,0,1.1091\n", mapping)
