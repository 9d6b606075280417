"""figaroh: its selection of parameters and Levenberg-Marquardt on the URDF; base and tool are estimated.

Its default selection ("structural") leaves 0.8 mm on this arm, so its "excitation" selection is used, which keeps as
many parameters as armscope (27) and ends at the same residual; it is told the noise, which saves it one fit.
"""

from __future__ import annotations

import csv
import tempfile
from pathlib import Path

import numpy as np
import pinocchio as pin
import yaml
from conversation import Calibrate, Problem, converse
from figaroh.calibration.base_calibration import BaseCalibration
from figaroh.calibration.calibration_tools import calc_updated_fkm


class PositionCalibration(BaseCalibration):
    """Measured positions only, errors in the measurement frame, unit weights."""

    def cost_function(self, var):
        """Residuals of all points."""
        predicted = calc_updated_fkm(self.model, self.data, var, self.q_measured, self.calib_config)
        return self._compute_logmap_residuals(self.PEE_measured, predicted, position_frame="world")


def prepare(problem: Problem) -> Calibrate:
    """The files that figaroh reads: URDF, settings, measurements."""
    folder = Path(tempfile.mkdtemp())
    (folder / "arm.urdf").write_text(problem["urdf"])
    names = [f"joint_{joint}" for joint in range(1, len(problem["modified_rows"]) + 1)]
    with (folder / "points.csv").open("w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(["x1", "y1", "z1", *names])
        for point, angles in zip(problem["train"]["measured"], problem["train"]["angles"], strict=True):
            writer.writerow([*point, *angles])
    settings = {
        "robot": {"name": "arm", "properties": {"joints": {"active_joints": names}}},
        "tasks": {
            "calibration": {
                "enabled": True,
                "type": "kinematic_calibration",
                "parameters": {
                    "calibration_level": "full_params",
                    "outlier_threshold": 1.0,
                    "estimation": {"method": "excitation", "noise_std": problem["noise"]},
                },
                "kinematics": {"base_frame": "universe", "tool_frame": problem["tip"]},
                "measurements": {"markers": [{"name": "tool", "measurable_dof": [True] * 3 + [False] * 3}]},
                "data": {
                    "source_file": str(folder / "points.csv"),
                    "number_of_samples": len(problem["train"]["angles"]),
                },
            }
        },
    }
    (folder / "settings.yaml").write_text(yaml.safe_dump(settings))

    def calibrate():
        robot = pin.RobotWrapper.BuildFromURDF(str(folder / "arm.urdf"))
        calibration = PositionCalibration(robot, str(folder / "settings.yaml"))
        calibration.calib_config.update(known_baseframe=False, known_tipframe=False)
        calibration.initialize()
        result, _ = calibration.solve_optimisation()

        def predict(asked):
            config = {**calibration.calib_config, "NbSample": len(asked)}
            flat = calc_updated_fkm(calibration.model, calibration.data, result.x, np.array(asked), config)
            return np.asarray(flat).reshape(3, len(asked)).T.tolist()

        return predict

    return calibrate


if __name__ == "__main__":
    converse(prepare)
