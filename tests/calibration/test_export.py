"""What is exported loads back to the calibrated positions."""

import xml.etree.ElementTree as ET
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin
import pytest
import yaml

from armscope.calibration.calibrate import calibrate
from armscope.calibration.export import export
from armscope.core.inputs import InputError
from armscope.robot import chain, forward_kinematics, load_arm
from armscope.robot.arm import build_arm
from armscope.robot.controllers import UR_KINEMATICS
from armscope.robot.description import RobotDescription
from armscope.robot.library import nominal_description
from tests.calibration.test_calibrate import ARMS, arm  # noqa: F401 - the arms in every form
from tests.calibration.worlds import far_away, measured, planted, poses, ur_like
from tests.robot.test_controllers import tool_of

assert ARMS


def test_robot_yaml_and_urdf_load_back_to_the_calibrated_positions(arm, tmp_path):  # noqa: F811
    rng = np.random.default_rng(1)
    tools = {"near": [0.05, 0.1, 0.2], "far": [0.3, 0, 0.1]}
    calibration = calibrate(arm, measured(planted(arm, rng), poses(rng, 80, arm.n_motors), far_away(rng), tools))
    angles = poses(rng, 40, arm.n_motors)
    frames = chain(calibration.arm, angles)
    for number, target in enumerate(tools):
        written = export(calibration, tmp_path / target, target)
        offset = calibration.state.tools[number] - arm.tool
        expected = frames.tool + frames.tool_rotation @ offset
        of_rows = arm.description.dh is not None and arm.description.actuation is None
        alone = ["robot.urdf"] if of_rows else []  # what it has no place for stands in the robot.yaml that names it
        loaded = [path for path in written if path.name in ("robot.yaml", "robot_urdf.yaml", *alone)]
        assert len(loaded) == (1 if arm.description.dh is None else 2) + len(alone)
        for path in loaded:
            again = load_arm(path)
            np.testing.assert_allclose(forward_kinematics(again, angles), expected, atol=1e-8, err_msg=path.name)
            # a negative control: the nominal arm is elsewhere
            assert np.abs(forward_kinematics(arm, angles) - expected).max() > 1e-3


@pytest.mark.parametrize("limited", [True, False])
@pytest.mark.parametrize("weighed", [True, False])
def test_other_engines_load_the_urdf_and_stand_at_the_calibrated_positions(limited, weighed, tmp_path):
    """pinocchio by itself, and MuJoCo, which refuses bodies without mass or inertia unless told otherwise."""
    from tests.robot.arms import random_masses

    rng = np.random.default_rng(5)
    nominal = ur_like(
        links=random_masses(rng, 6) if weighed else None, joint_limits_deg=[[-170, 170]] * 6 if limited else None
    )
    tool = {"": [0.05, 0.1, 0.2]}
    calibration = calibrate(nominal, measured(planted(nominal, rng), poses(rng, 60, 6), far_away(rng), tool))
    export(calibration, tmp_path)
    offset = np.array(yaml.safe_load((tmp_path / "robot.yaml").read_text())["tool_mm"]) * 1e-3
    by_pinocchio = pin.buildModelFromUrdf(str(tmp_path / "robot.urdf"))
    by_mujoco = mujoco.MjModel.from_xml_path(str(tmp_path / "robot.urdf"))
    data, state = by_pinocchio.createData(), mujoco.MjData(by_mujoco)
    flange = by_pinocchio.getFrameId("calibrated_flange")
    angles = poses(rng, 20, 6)
    for q, expected in zip(angles, forward_kinematics(load_arm(tmp_path / "robot.yaml"), angles), strict=True):
        # pinocchio keeps a joint without limits as cosine and sine
        stored = q if limited else np.column_stack([np.cos(q), np.sin(q)]).ravel()
        pin.framesForwardKinematics(by_pinocchio, data, stored)
        np.testing.assert_allclose(data.oMf[flange].act(offset), expected, atol=1e-9)
        state.qpos[:] = q
        mujoco.mj_kinematics(by_mujoco, state)
        body = state.body("calibrated_flange")
        np.testing.assert_allclose(body.xpos + body.xmat.reshape(3, 3) @ offset, expected, atol=1e-9)


def test_base_and_tools_stand_in_frames_yaml_and_give_the_measured_points(tmp_path):
    from scipy.spatial.transform import Rotation

    rng = np.random.default_rng(2)
    recordings = measured(planted(ur_like(), rng), poses(rng, 60, 6), far_away(rng), {"": [0.05, 0.1, 0.2]})
    calibration = calibrate(ur_like(), recordings)
    export(calibration, tmp_path)
    base = yaml.safe_load((tmp_path / "frames.yaml").read_text())["base_frames"][0]
    w, x, y, z = base["quaternion_wxyz"]
    points = forward_kinematics(load_arm(tmp_path / "robot.yaml"), recordings.motor_angles)
    seen = Rotation.from_quat([x, y, z, w]).apply(points) + np.array(base["position_mm"]) * 1e-3
    np.testing.assert_allclose(seen, recordings.positions, atol=1e-7)


def test_masses_and_limits_go_along(tmp_path):
    from tests.robot.arms import random_masses

    rng = np.random.default_rng(3)
    nominal = ur_like(
        links=random_masses(rng, 6), joint_limits_deg=[[-100, 110]] * 6, tool_load={"mass_kg": 3, "com_mm": [0, 0, 50]}
    )
    calibration = calibrate(
        nominal, measured(planted(nominal, rng), poses(rng, 60, 6), far_away(rng), {"": [0, 0, 0.1]})
    )
    export(calibration, tmp_path)
    for name in ("robot.yaml", "robot_urdf.yaml"):
        again = load_arm(tmp_path / name)
        np.testing.assert_allclose(again.masses, calibration.arm.masses)
        np.testing.assert_allclose(again.centres, calibration.arm.centres, atol=1e-8)
        np.testing.assert_allclose(again.limits, nominal.limits)


def test_a_corrected_urdf_keeps_all_else_and_finds_its_meshes(tmp_path):
    (tmp_path / "from").mkdir()
    text = (Path(__file__).parents[1] / "robot" / "torso_arm.urdf").read_text()
    (tmp_path / "from" / "arm.urdf").write_text(text)
    urdf = str(tmp_path / "from" / "arm.urdf")
    nominal = build_arm(RobotDescription(name="t", urdf=urdf, tip="flange", hold_joints={"torso_lift": 0.1}))
    rng = np.random.default_rng(6)
    calibration = calibrate(
        nominal, measured(planted(nominal, rng), poses(rng, 60, 6), far_away(rng), {"": [0, 0, 0.1]})
    )
    export(calibration, tmp_path / "to")
    before, after = (ET.parse(path).getroot() for path in (urdf, tmp_path / "to" / "robot.urdf"))
    meshes = [mesh.get("filename") for mesh in after.iter("mesh")]
    assert meshes == ["package://torso_description/meshes/torso.stl", "../from/meshes/shoulder.stl"]
    added = [each for each in after if "calibrated_tool" in (each.get("name") or "")]
    assert [each.tag for each in added] == ["link", "joint"]
    assert added[1].find("parent").get("link") == "flange"
    for each in added:  # the fitted tool, and nothing else
        after.remove(each)
    for robot in (before, after):
        for element in robot.iter():
            element.text = element.tail = None
            if element.tag in ("origin", "mesh"):
                element.attrib.clear()
    assert ET.tostring(before) == ET.tostring(after)
    again = load_arm(tmp_path / "to" / "robot.yaml")
    np.testing.assert_array_equal(again.masses, nominal.masses)
    np.testing.assert_array_equal(again.limits, nominal.limits)


def test_an_unknown_target_is_named(tmp_path):
    rng = np.random.default_rng(4)
    calibration = calibrate(
        ur_like(), measured(ur_like(), poses(rng, 40, 6), far_away(rng), {"left": [0, 0, 0.1]}), "nominal"
    )
    with pytest.raises(InputError, match="left"):
        export(calibration, tmp_path, "lefft")
    assert not list(tmp_path.iterdir())


def test_the_link_at_the_tool_of_a_corrected_urdf_is_where_points_were_measured(tmp_path):
    """Also of a file that was calibrated before, whose link of then stays where it was."""
    urdf = str(Path(__file__).parents[1] / "robot" / "torso_arm.urdf")
    nominal = build_arm(RobotDescription(name="t", urdf=urdf, tip="flange", hold_joints={"torso_lift": 0.1}))
    rng = np.random.default_rng(8)
    for number, name in enumerate(("calibrated_tool", "calibrated_tool_2")):
        tool = {"": [0.05 * number, 0, 0.1]}
        calibration = calibrate(nominal, measured(planted(nominal, rng), poses(rng, 60, 6), far_away(rng), tool))
        export(calibration, tmp_path / str(number))
        described = {"urdf": str(tmp_path / str(number) / "robot.urdf"), "hold_joints": {"torso_lift": 0.1}}
        at_link = build_arm(RobotDescription(name="t", tip=name, **described))
        nominal = load_arm(tmp_path / str(number) / "robot.yaml")
        angles = poses(rng, 20, 6)
        np.testing.assert_allclose(
            forward_kinematics(at_link, angles), forward_kinematics(nominal, angles), atol=1e-8, err_msg=name
        )


def test_a_calibrated_arm_of_universal_robots_comes_as_its_driver_reads_it(tmp_path):
    rng, ur = np.random.default_rng(5), build_arm(nominal_description("ur5e"))
    recordings = measured(planted(ur, rng), poses(rng, 80, 6), far_away(rng), {"": [0.1, 0.05, 0.1]})
    calibration = calibrate(ur, recordings)
    written = yaml.safe_load(next(p for p in export(calibration, tmp_path) if p.name == UR_KINEMATICS).read_text())
    angles = poses(rng, 20, 6)
    # the last row's a and alpha, for which the file has no place, are the tool's and stay nominal: 0
    expected, nominal = (forward_kinematics(each, angles) for each in (calibration.arm, ur))
    np.testing.assert_allclose([tool_of(written, q) for q in angles], expected, atol=1e-9)
    assert np.abs(nominal - expected).max() > 1e-3
    uncorrected = export(calibrate(ur, recordings, "nominal"), tmp_path / "nominal")
    assert UR_KINEMATICS not in [path.name for path in uncorrected]
