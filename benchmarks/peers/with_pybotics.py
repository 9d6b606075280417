"""pybotics: all 24 modified D-H parameters by MINPACK on its own kinematics; base and tool are told to it.

Its documentation minimises the distance of each row. Distances have a kink at zero, on which MINPACK needs twenty times
as long for the same result, so the three components are given to it here.
"""

from __future__ import annotations

import numpy as np
import scipy.optimize
from conversation import Calibrate, Problem, converse
from pybotics.optimization import OptimizationHandler
from pybotics.robot import Robot


def prepare(problem: Problem) -> Calibrate:
    """The nominal robot in mm and the measured positions."""
    rows = np.array([[row["alpha"], row["a"], row["theta"], row["d"]] for row in problem["modified_rows"]])
    angles, measured = np.array(problem["train"]["angles"]), 1e3 * np.array(problem["train"]["measured"])

    def calibrate():
        robot = Robot.from_parameters(rows.ravel())
        robot.tool.position = 1e3 * np.array(problem["tool"])
        handler = OptimizationHandler(robot, kinematic_chain_mask=True, tool_mask=False, world_mask=False)
        start = handler.generate_optimization_vector()

        def errors(vector):
            handler.apply_optimization_vector(vector)
            return np.array([handler.robot.fk(row)[:3, 3] for row in angles]).ravel() - measured.ravel()

        found, _ = scipy.optimize.leastsq(errors, start)
        handler.apply_optimization_vector(found)

        def predict(asked):
            return [(handler.robot.fk(np.array(row))[:3, 3] * 1e-3).tolist() for row in asked]

        return predict

    return calibrate


if __name__ == "__main__":
    converse(prepare)
