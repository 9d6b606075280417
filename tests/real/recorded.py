"""Recordings of an arm whose frames are known, in the form of the real sets' tables."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from armscope.robot import chain, forward_kinematics, load_arm

ROBOT = Path(__file__).parents[2] / "config" / "robots" / "six-axis.yaml"
BASE = Rotation.from_euler("xyz", [0.4, -0.3, 1.2])
SHIFT_MM = np.array([4000.0, -1500.0, 900.0])


def arm():
    return load_arm(ROBOT)


def table(n_rows=80, noise_mm=0.0, seed=0, torque=None, error_rad=None, run="one", turn_noise_rad=None):
    """``torque`` (N, 6) is recorded beside, orientations with ``turn_noise_rad``; ``error_rad`` (N, 6) is added to the
    commanded angles."""
    rng = np.random.default_rng(seed)
    angles = rng.uniform(-1.2, 1.2, (n_rows, 6))
    real = angles if error_rad is None else angles + error_rad(angles, rng)
    points = BASE.apply(forward_kinematics(arm(), real) * 1e3) + SHIFT_MM + noise_mm * rng.normal(size=(n_rows, 3))
    content = {"id": np.arange(1, n_rows + 1).astype(str), "run": run}
    content |= {f"q{j + 1}_rad": angles[:, j] for j in range(6)}
    content |= {f"{axis}_mm": points[:, k] for k, axis in enumerate("xyz")}
    if torque is not None:
        content |= {f"tau{j + 1}_nm": torque(angles)[:, j] for j in range(6)}
    if turn_noise_rad is not None:
        turns = Rotation.from_matrix(chain(arm(), real).tool_rotation)
        off = Rotation.from_rotvec(turn_noise_rad * np.random.default_rng(seed + 1).normal(size=(n_rows, 3)))
        measured = (BASE * turns * off).as_quat(scalar_first=True)
        content |= {f"q{name}": measured[:, k] for k, name in enumerate("wxyz")}
    return pd.DataFrame(content)
