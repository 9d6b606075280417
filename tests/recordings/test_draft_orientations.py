"""A quaternion proves itself by its length; three angles are offered as a comment, and read right when taken."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from armscope.recordings.importing.draft import draft_mapping
from armscope.recordings.importing.draft_orientations import COMPUTED
from armscope.recordings.importing.tables import import_recordings

ROTATIONS = Rotation.random(12, random_state=3)


def table(orientation: dict[str, np.ndarray]) -> pd.DataFrame:
    rng = np.random.default_rng(0)
    angles = {f"J{j}": rng.uniform(-90, 90, 12) for j in range(1, 7)}
    return pd.DataFrame(angles | {axis: rng.uniform(-900, 900, 12) for axis in "XYZ"} | orientation)


def drafted(tmp_path: Path, orientation: dict[str, np.ndarray]) -> str:
    table(orientation).to_csv(tmp_path / "log.csv", index=False)
    return draft_mapping(tmp_path / "log.csv")


def imported(tmp_path: Path, mapping: str) -> Rotation:
    (tmp_path / "mapping.yaml").write_text(mapping)
    import_recordings([tmp_path / "log.csv"], tmp_path / "mapping.yaml", tmp_path / "recordings.csv")
    read = pd.read_csv(tmp_path / "recordings.csv")
    return Rotation.from_quat(read[["qw", "qx", "qy", "qz"]].to_numpy(), scalar_first=True)


def parts(values: np.ndarray, names: str) -> dict[str, np.ndarray]:
    return dict(zip(names.split(), values.T, strict=True))


ROS = " ".join(f"pose.orientation.{axis}" for axis in "xyzw")


@pytest.mark.parametrize("names", ["quat_x quat_y quat_z quat_w", "qx qy qz qw", ROS])
def test_a_quaternion_is_read_whatever_order_it_stands_in(tmp_path, names):
    read = imported(tmp_path, drafted(tmp_path, parts(ROTATIONS.as_quat(), names)))
    assert (read * ROTATIONS.inv()).magnitude().max() < 1e-6


def test_four_columns_of_another_length_are_no_quaternion(tmp_path):
    assert "orientation" not in drafted(tmp_path, parts(1.1 * ROTATIONS.as_quat(), "qx qy qz qw"))


@pytest.mark.parametrize(
    ("names", "values"),
    [
        ("A B C", ROTATIONS.as_euler("ZYX", degrees=True)),
        ("W P R", ROTATIONS.as_euler("xyz", degrees=True)),
        ("roll_rad pitch_rad yaw_rad", ROTATIONS.as_euler("xyz")),
        ("rx ry rz", ROTATIONS.as_rotvec()),
    ],
)
def test_three_angles_are_offered_and_read_right_when_taken(tmp_path, names, values):
    mapping = drafted(tmp_path, parts(values, names))
    assert "  # orientation:" in mapping
    assert COMPUTED in mapping
    taken = mapping.replace("  # orientation:", "  orientation:")
    assert (imported(tmp_path, taken) * ROTATIONS.inv()).magnitude().max() < 1e-6


@pytest.mark.parametrize("first", [0, 1])
def test_four_numbered_columns_of_length_one_beside_the_motors_are_a_quaternion(first, tmp_path):
    """As ABB's controllers number them, w first."""
    named = parts(ROTATIONS.as_quat(scalar_first=True), " ".join(f"q{n}" for n in range(first, first + 4)))
    mapping = drafted(tmp_path, named)
    assert "w first, as ABB counts them" in mapping
    assert (imported(tmp_path, mapping) * ROTATIONS.inv()).magnitude().max() < 1e-6


def test_four_numbered_columns_of_another_length_are_none(tmp_path):
    named = parts(1.1 * ROTATIONS.as_quat(scalar_first=True), "q1 q2 q3 q4")
    assert "orientation" not in drafted(tmp_path, named)
