"""Metres and radians in robot.yaml are told; a URDF in its place is an arm whose guesses are labelled."""

import numpy as np
import pytest
import yaml

from armscope.core.inputs import InputError
from armscope.robot import forward_kinematics, load_arm
from armscope.robot.description_file import describe_urdf, guesses, load_description
from armscope.robot.library import nominal_description
from tests.robot.test_urdf import TORSO_ARM, build

UR5_MM = [(0, 90, 89.2), (-425, 0, 0), (-392, 0, 0), (0, 90, 109.3), (0, -90, 94.75), (0, 0, 82.5)]


def write(folder, rows, **more):
    joints = [dict(zip(("a_mm", "alpha_deg", "d_mm", "theta_offset_deg"), row, strict=False)) for row in rows]
    file = folder / "robot.yaml"
    file.write_text(yaml.safe_dump({"name": "arm", "dh": {"joints": joints}, **more}))
    return file


def test_metres_are_told_with_their_cure(tmp_path):
    with pytest.raises(InputError, match=r"dh\.joints: found '1\.193 mm'.*multiply a_mm and d_mm by 1000"):
        load_arm(write(tmp_path, [(a / 1e3, alpha, d / 1e3) for a, alpha, d in UR5_MM]))
    assert load_arm(write(tmp_path, UR5_MM)).n_joints == 6
    assert load_arm(write(tmp_path, [(0, 90, 0), (0, 0, 0)], tool_mm=[0, 0, 100])).n_joints == 2


def test_centres_of_mass_in_metres_are_told_with_their_cure(tmp_path):
    for factor in (1, 1e-3):
        links = [{"mass_kg": 3, "com_mm": [0, 0, 100 * factor]} for _ in UR5_MM]
        file = write(tmp_path, UR5_MM, links=links)
        if factor == 1:
            assert load_arm(file).n_joints == 6
        else:
            with pytest.raises(InputError, match=r"links: found '0\.1 mm'.*multiply com_mm by 1000"):
                load_arm(file)
    assert load_arm(write(tmp_path, UR5_MM, links=[{"mass_kg": 3, "com_mm": [0, 0, 0]} for _ in UR5_MM])).n_joints == 6


@pytest.mark.parametrize("digits", [2, 4, 9])
def test_alpha_in_radians_is_told_with_its_value_in_degrees(tmp_path, digits):
    rows = [(a, round(float(np.radians(alpha)), digits), d) for a, alpha, d in UR5_MM]
    with pytest.raises(InputError, match=r"dh\.joints\[0\]\.alpha_deg.*radians.*Write 90 in degrees"):
        load_arm(write(tmp_path, rows))


def test_theta_offsets_and_limits_in_radians_are_told(tmp_path):
    rows = [(*row, offset) for row, offset in zip(UR5_MM, (0, -1.5708, 0, 3.1416, 0, 0), strict=True)]
    with pytest.raises(InputError, match=r"dh\.joints\[1\]\.theta_offset_deg.*Write -90"):
        load_arm(write(tmp_path, rows))
    with pytest.raises(InputError, match=r"joint_limits_deg.*6\.3 degrees.*radians"):
        load_arm(write(tmp_path, UR5_MM, joint_limits_deg=[[-3.14, 3.14]] * 6))


def test_small_angles_of_a_calibrated_arm_are_no_radians(tmp_path):
    rows = [(a, alpha + 1.5, d, 0.3) for a, alpha, d in UR5_MM]
    assert load_arm(write(tmp_path, rows)).n_joints == 6


def test_a_urdf_is_an_arm_by_itself_and_says_what_was_guessed():
    arm = load_arm(TORSO_ARM)
    assert arm.joint_names == ("pan", "lift", "elbow", "roll", "bend", "turn")
    told = guesses(arm.description)
    assert any(each.startswith("tip: guessed") for each in told)
    assert any("hold_joints.torso_lift" in each for each in told)
    angles = np.random.default_rng(0).uniform(-1, 1, (5, 6))
    stated = build(tip=arm.description.tip, hold_joints=arm.description.hold_joints)
    np.testing.assert_array_equal(forward_kinematics(arm, angles), forward_kinematics(stated, angles))


def test_a_stated_tip_is_no_guess():
    described = describe_urdf(TORSO_ARM, "wrist_2")
    assert described.tip == "wrist_2"
    assert not any(each.startswith("tip") for each in guesses(described))
    with pytest.raises(InputError, match=r"tip: found 'wrist_22'.*'wrist_2'"):
        describe_urdf(TORSO_ARM, "wrist_22")


def test_a_file_that_is_not_there_is_one_error(tmp_path):
    with pytest.raises(InputError, match="readable"):
        load_description(tmp_path / "arm.urdf")


def test_an_arm_of_the_library_is_asked_for_by_its_name_where_no_file_has_that_name(tmp_path, monkeypatch):
    assert load_description("UR-5e") == nominal_description("ur5e")
    monkeypatch.chdir(tmp_path)
    write(tmp_path, UR5_MM).rename("ur5e")
    assert load_description("ur5e").name == "arm"
    with pytest.raises(InputError, match="readable"):
        load_description("ur5x")
