"""figaroh's dynamic identification: joint torque regressor, parallel decimation, base parameters by QR, least squares.

As in its examples: viscous and dry friction, actuator inertia and offset of every joint beside the inertial parameters;
torque and columns are decimated alike. Its weighted least squares forms a matrix of all rows by all rows, which does
not fit into memory here, so that joints are weighted alike.

    PYTHON motion_with_figaroh.py arm.urdf motion.npz     # q, dq, ddq, tau of train and test; prints one line of JSON
"""

from __future__ import annotations

import json
import sys
import time
import warnings

import numpy as np
import pinocchio as pin
from figaroh.tools.qrdecomposition import build_baseRegressor, get_baseIndex
from figaroh.tools.regressor import build_regressor_basic, build_regressor_reduced, get_index_eliminate
from scipy.signal import decimate

SETTINGS = {"has_friction": True, "has_actuator_inertia": True, "has_joint_offset": True, "is_joint_torques": True}


def columns(robot: pin.RobotWrapper, motion: dict, part: str) -> tuple[np.ndarray, np.ndarray]:
    """Regressor and torque, joint by joint, decimated."""
    q, dq, ddq, tau = (motion[f"{name}_{part}"] for name in ("q", "dq", "ddq", "tau"))
    settings = SETTINGS | {"act_idxv": list(range(tau.shape[1]))}
    whole = build_regressor_basic(robot, q, dq, ddq, settings).reshape(tau.shape[1], len(q), -1)
    every = int(motion["every"])
    thin = decimate(whole, every, axis=1, zero_phase=True)
    return thin.reshape(-1, whole.shape[2]), decimate(tau.T, every, axis=1, zero_phase=True).ravel()


def main() -> None:
    """Identify on train, predict test."""
    warnings.simplefilter("ignore")
    robot, motion = pin.RobotWrapper.BuildFromURDF(sys.argv[1]), dict(np.load(sys.argv[2]))
    started = time.process_time()
    W, tau = columns(robot, motion, "train")
    names = {f"p{k}": 0.0 for k in range(W.shape[1])}
    eliminated, left = get_index_eliminate(W, names)
    reduced = build_regressor_reduced(W, eliminated)
    index = get_baseIndex(reduced, left)
    found = np.linalg.lstsq(build_baseRegressor(reduced, index), tau, rcond=None)[0]
    seconds = time.process_time() - started
    W, tau = columns(robot, motion, "test")
    missed = tau - build_baseRegressor(build_regressor_reduced(W, eliminated), index) @ found
    error = float(np.linalg.norm(missed) / np.linalg.norm(tau))
    print(json.dumps({"cpu_s": seconds, "held_out": error, "parameters": len(index)}))


if __name__ == "__main__":
    main()
