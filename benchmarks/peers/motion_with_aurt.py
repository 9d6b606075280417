"""aurt: a symbolic model compiled from modified D-H rows, base parameters and friction by weighted least squares.

As its commands compile-rbd, compile-rd, calibrate and predict do, on one process: its own low-pass (10 Hz),
differences, parallel filter and decimation; Coulomb and viscous friction of every joint beside the inertial parameters,
with or without friction that grows with the square of the load. It knows no rotors and no offsets. Each table is one
motion, so that it is fitted to one path. Measured and foretold torque of the other path are compared as its own filter
leaves them.

    PYTHON motion_with_aurt.py rows.csv train.csv test.csv load gx gy gz    # load: none or square; prints JSON
"""

from __future__ import annotations

import json
import logging
import sys
import tempfile
import time

import numpy as np
from aurt.caching import PersistentPickleCache
from aurt.data_processing import convert_file_to_mdh
from aurt.rigid_body_dynamics import RigidBodyDynamics
from aurt.robot_calibration import RobotCalibration
from aurt.robot_data import RobotData
from aurt.robot_dynamics import RobotDynamics


def main() -> None:
    """Compile, identify on train, foretell test."""
    rows, train, test, load, *gravity = sys.argv[1:]
    logger, down = logging.getLogger("aurt"), np.array([float(each) for each in gravity])
    with tempfile.TemporaryDirectory() as made:
        cache = PersistentPickleCache(made)
        started = time.process_time()
        bodies = RigidBodyDynamics(logger, convert_file_to_mdh(rows), cache, multi_processing=False)
        bodies.regressor()
        model = RobotDynamics(bodies, logger, cache, viscous_friction_powers=[1], friction_torque_model=load)
        model.regressor()
        compiled = time.process_time()
        apart = RobotData(logger, test, delimiter=" ", interpolate_missing_samples=True)
        read = time.process_time()
        calibration = RobotCalibration(logger, model, train, down, robot_data_predict=apart, multi_processing=False)
        found = calibration.calibrate()
        fitted = time.process_time()
        inner = {"start_index": 1, "end_index": len(apart.time) - 1}  # at 100 Hz its own predict miscounts rows
        measured = calibration._measurement_vector(apart, **inner)
        said = calibration._observation_matrix(apart, down, **inner) @ found
    error = float(np.linalg.norm(measured - said) / np.linalg.norm(measured))
    told = {"compile_cpu_s": compiled - started, "cpu_s": fitted - read, "held_out": error, "parameters": len(found)}
    print(json.dumps(told))


if __name__ == "__main__":
    main()
