"""Files in the layout of a controller: read as its maker reads them, they put the tool in the right place."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import yaml

from armscope.report.pages.diagnosis import write_work_order
from armscope.report.subject import Subject
from armscope.robot.arm import build_arm
from armscope.robot.kinematics import forward_kinematics
from armscope.verdict.controllers import corrected_ur_kinematics
from armscope.verdict.effects import Parameter
from tests.report import verdicts
from tests.report.verdicts import found
from tests.robot.test_controllers import tool_of, ur5e
from tests.verdict.test_corrections import saying


def test_a_nominal_arm_is_not_offered_as_a_corrected_one() -> None:
    """On a real arm it would undo the maker's own calibration."""
    assert corrected_ur_kinematics(saying(ur5e())) is None


def test_zeros_and_rows_that_were_found_have_their_signs_in_the_file() -> None:
    arm = ur5e()
    row = found(
        "link_geometry", "link 2", Parameter("a", "mm", 0.8, 0.01), Parameter("alpha", "rad", 7e-4, 1e-5),
        Parameter("d", "mm", 0.3, 0.01), Parameter("beta", "rad", 5e-4, 1e-5),
    )  # fmt: skip
    zero = found("joint_offset", "joint 4", Parameter("offset", "rad", -3e-3, 1e-5))
    written = corrected_ur_kinematics(saying(arm, row, zero))
    assert written is not None
    content = arm.description.model_dump()
    stated = content["dh"]["joints"][1]
    stated |= {"a_mm": stated["a_mm"] + 0.8, "alpha_deg": np.degrees(7e-4), "d_mm": 0.3, "beta_deg": np.degrees(5e-4)}
    real = build_arm(type(arm.description).model_validate(content))
    for angles in np.random.default_rng(3).uniform(-2, 2, (8, 6)):
        actual = angles + np.array([0, 0, 0, -3e-3, 0, 0])
        np.testing.assert_allclose(tool_of(written, angles), forward_kinematics(real, actual[None])[0], atol=1e-9)
        assert np.linalg.norm(tool_of(written, angles) - forward_kinematics(arm, angles[None])[0]) > 1e-4


def test_who_loads_the_file_is_told_not_to_reset_zeros_as_well(tmp_path: Path) -> None:
    """Both were advised of one arm: 0.71 mm by the zeros alone, 1.25 mm by both, of 1.38."""
    case = verdicts.single()
    model = replace(case.verdict.model, arm=ur5e())
    zero = found("joint_offset", "joint 4", Parameter("offset", "rad", -3e-3, 1e-5))
    verdict = replace(case.verdict, model=model, effects=(*case.verdict.effects, zero))
    tables = write_work_order(Subject(verdict), tmp_path)
    assert tables == ("zero_offsets.csv", "corrected_dh.csv", "ur_kinematics.yaml")
    assert all((tmp_path / name).is_file() for name in tables)
    for name in ("ur_kinematics.yaml", "work-order.html"):
        assert "never as well" in (tmp_path / name).read_text()
    assert set(yaml.safe_load((tmp_path / "ur_kinematics.yaml").read_text())) == {"kinematics"}
