"""The arm of a world measured at further poses, for instance those that a diagnosis asks for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd

from armscope.core.types import Array
from armscope.world.statics import Session
from armscope.world.strength import make_scene
from armscope.world.virtual_arm import TO_TEN_NANOMETRES, VirtualArm, true_points


def measure_at(arm: VirtualArm, poses: pd.DataFrame, rng: np.random.Generator) -> pd.DataFrame:
    """The same arm measured at further poses, for instance those that a diagnosis asks for.

    Args:
        arm: the virtual arm.
        poses: columns q1_rad ... and, where it matters, payload_kg, time_s, temperature_c, approach1 ..., dq1_rad_s ...
            (otherwise none, after the session's end, 20 degrees, from below, at rest).
        rng: of the Gaussian noise.

    Returns:
        ``poses`` with x_mm, y_mm, z_mm.
    """
    session = _asked(arm, poses)
    scene, _ = make_scene(arm.scene.description, session)
    points, _ = true_points(arm, replace(scene, torque_scale=arm.scene.torque_scale))
    readings = (points + rng.normal(0, arm.spec.sigma_mm * 1e-3, points.shape)).round(TO_TEN_NANOMETRES)
    return poses.assign(**{f"{axis}_mm": (readings[:, k] * 1e3).round(4) for k, axis in enumerate("xyz")})


def _asked(arm: VirtualArm, poses: pd.DataFrame) -> Session:
    motors = range(1, arm.scene.geometry.n_motors + 1)
    count = len(poses)

    def column(name: str, otherwise: Array | float) -> Array:
        return np.asarray(poses[name] if name in poses else np.full(count, otherwise), dtype=float)

    def per_motor(name: str, otherwise: float) -> Array:
        return np.column_stack([column(name.format(m), otherwise) for m in motors])

    return Session(
        commanded=np.column_stack([np.asarray(poses[f"q{m}_rad"], dtype=float) for m in motors]),
        payload=column("payload_kg", 0.0),
        time=column("time_s", arm.scene.session.time[-1] + 30.0),
        temperature=column("temperature_c", 20.0),
        run=np.full(count, arm.scene.session.run[-1]),
        approach=per_motor("approach{}", 1.0),
        speed=per_motor("dq{}_rad_s", 0.0),
    )
