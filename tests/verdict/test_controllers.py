"""Files in the layout of a controller: read as its maker reads them, they put the tool in the right place."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from scipy.spatial.transform import Rotation

from armscope.report.pages.diagnosis import write_work_order
from armscope.report.subject import Subject
from armscope.robot.arm import Arm, build_arm
from armscope.robot.kinematics import forward_kinematics
from armscope.robot.library import nominal_description
from armscope.verdict.controllers import UR_JOINTS, ur_kinematics
from armscope.verdict.effects import Parameter
from tests.report import verdicts
from tests.report.verdicts import found
from tests.verdict.test_corrections import saying

UR5E = {
    "shoulder": (0, 0, 0.1625), "upper_arm": (0, 0, 0), "forearm": (-0.425, 0, 0), "wrist_1": (-0.3922, 0, 0.1333),
    "wrist_2": (0, -0.0997, 0), "wrist_3": (0, 0.0996, 0),
}  # fmt: skip
"""Where Universal Robots' own description of a UR5e puts each joint, m (ur_description, nominal numbers)."""


def ur5e() -> Arm:
    return build_arm(nominal_description("ur5e"))


def tool_of(kinematics: dict[str, Any], angles: np.ndarray) -> np.ndarray:
    """(3,) the last joint's place: origins one behind the other, each joint turning about its own z."""
    turn, place = Rotation.identity(), np.zeros(3)
    for name, motor in zip(UR_JOINTS, angles, strict=True):
        at = kinematics["kinematics"][name]
        place = place + turn.apply([at["x"], at["y"], at["z"]])
        turn = turn * Rotation.from_euler("xyz", [at["roll"], at["pitch"], at["yaw"]]) * Rotation.from_euler("z", motor)
    return place


def test_a_nominal_ur5e_is_what_its_maker_publishes() -> None:
    written = ur_kinematics(saying(ur5e()))
    assert written is not None
    for name, place in UR5E.items():
        at = written["kinematics"][name]
        np.testing.assert_allclose([at["x"], at["y"], at["z"]], place, atol=1e-9)
    rolls = [abs(written["kinematics"][name]["roll"]) for name in UR_JOINTS]
    np.testing.assert_allclose(rolls, [0, np.pi / 2, 0, 0, np.pi / 2, np.pi / 2], atol=1e-9)


def test_zeros_and_rows_that_were_found_have_their_signs_in_the_file() -> None:
    arm = ur5e()
    row = found(
        "link_geometry", "link 2", Parameter("a", "mm", 0.8, 0.01), Parameter("alpha", "rad", 7e-4, 1e-5),
        Parameter("d", "mm", 0.3, 0.01), Parameter("beta", "rad", 5e-4, 1e-5),
    )  # fmt: skip
    zero = found("joint_offset", "joint 4", Parameter("offset", "rad", -3e-3, 1e-5))
    written = ur_kinematics(saying(arm, row, zero))
    assert written is not None
    content = arm.description.model_dump()
    stated = content["dh"]["joints"][1]
    stated |= {"a_mm": stated["a_mm"] + 0.8, "alpha_deg": np.degrees(7e-4), "d_mm": 0.3, "beta_deg": np.degrees(5e-4)}
    real = build_arm(type(arm.description).model_validate(content))
    for angles in np.random.default_rng(3).uniform(-2, 2, (8, 6)):
        actual = angles + np.array([0, 0, 0, -3e-3, 0, 0])
        np.testing.assert_allclose(tool_of(written, angles), forward_kinematics(real, actual[None])[0], atol=1e-9)
        assert np.linalg.norm(tool_of(written, angles) - forward_kinematics(arm, angles[None])[0]) > 1e-4


@pytest.mark.parametrize("name", ["irb120", "panda", "kr6-r900"])
def test_other_makers_arms_have_no_such_file(name: str) -> None:
    assert ur_kinematics(saying(build_arm(nominal_description(name)))) is None


def test_who_loads_the_file_is_told_not_to_reset_zeros_as_well(tmp_path: Path) -> None:
    """Both were advised of one arm: 0.71 mm by the zeros alone, 1.25 mm by both, of 1.38."""
    case = verdicts.single()
    model = replace(case.verdict.model, arm=ur5e())
    verdict = replace(case.verdict, model=model)
    write_work_order(Subject(verdict), tmp_path)
    for name in ("ur_kinematics.yaml", "work-order.html"):
        assert "never as well" in (tmp_path / name).read_text()
    assert set(yaml.safe_load((tmp_path / "ur_kinematics.yaml").read_text())) == {"kinematics"}
