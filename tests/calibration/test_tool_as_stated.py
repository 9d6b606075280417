"""A tool that its poses do not tell from the base stays as stated, and nobody says how well it is known."""

import numpy as np
import pytest
import yaml

from armscope.calibration.calibrate import calibrate
from armscope.calibration.export import export
from armscope.robot import chain, load_arm
from tests.compensation.keeping import downward_poses, level_poses, palletiser, recordings, six_axes

KEEPING = {"palletiser": (palletiser, level_poses), "flange down": (six_axes, downward_poses)}


@pytest.mark.parametrize("redundancy", ["fixed", "priors"])
@pytest.mark.parametrize("kind", KEEPING)
def test_a_tool_whose_attitude_is_kept_is_held_as_stated(kind, redundancy):
    made, poses = KEEPING[kind]
    arm, rng = made(), np.random.default_rng(4)
    found = calibrate(arm, recordings(arm, poses(rng, 60), rng), "offsets", redundancy=redundancy)
    assert found.state.tools[0, 2] == pytest.approx(arm.tool[2], abs=2e-5)
    assert "tool z: as base z; kept as stated" in found.text()
    assert "tool z" not in set(found.table["parameter"])
    assert "base z" in set(found.table["parameter"])


@pytest.mark.parametrize("kind", KEEPING)
def test_the_calibrated_arm_is_right_in_its_own_base_frame(kind, tmp_path):
    made, poses = KEEPING[kind]
    arm, rng = made(), np.random.default_rng(4)
    angles = poses(rng, 80)
    zeros = np.zeros(arm.n_motors)
    zeros[2] = 8e-4
    found = calibrate(arm, recordings(arm, angles, rng, zeros))
    export(found, tmp_path)
    corrected = load_arm(tmp_path / "robot.yaml")
    real = chain(arm, angles + zeros).tool
    before, after = (np.linalg.norm(chain(each, angles).tool - real, axis=1).mean() for each in (arm, corrected))
    assert after < 0.1 * before
    (tool,) = yaml.safe_load((tmp_path / "frames.yaml").read_text(encoding="utf-8"))["tools"]
    assert tool["not_identified"] == ["z"]


def test_a_tool_that_poses_tell_is_free_however_wrongly_it_is_stated():
    arm, rng, tool = six_axes((0.0, 0.0, 0.0)), np.random.default_rng(5), np.array([0.03, -0.045, 0.15])
    found = calibrate(arm, recordings(arm, rng.uniform(-2, 2, (80, 6)), rng, tool=tool), "offsets")
    np.testing.assert_allclose(found.state.tools[0], tool, atol=3e-5)
    assert not any(each.name.startswith("tool") for each in found.held)


@pytest.mark.parametrize(("true_z", "is_held"), [(0.08, True), (0.3, False)])
def test_a_lean_that_hardly_tells_the_tool_counts_only_against_a_tool_far_off(true_z, is_held):
    """A thousandth of lean at a noise of 0.1 mm: known to a centimetre or two, which a stated tool is not wrong by."""
    arm, rng = six_axes(), np.random.default_rng(6)
    angles = downward_poses(rng, 60) + 1e-3 * rng.normal(size=(60, 6)) * [0, 0, 0, 1, 1, 0]
    rows = recordings(arm, angles, rng, tool=np.array([0.03, -0.045, true_z]), noise=1e-4)
    found = calibrate(arm, rows, "nominal")
    assert ("tool z" in {each.name for each in found.held}) == is_held
    assert found.state.tools[0, 2] == pytest.approx(true_z, abs=1e-4 if is_held else 0.08)
