"""What a motion must keep: the limits of robot.yaml or the URDF, or assumed ones that are told."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.design.fourier import Limits
from armscope.poses.exciting.constants import DRIVES
from armscope.poses.obstacles import ranges
from armscope.robot import Arm
from armscope.robot.description import Drive


@dataclass(frozen=True, eq=False)
class MotionLimits:
    """Angles, speeds, accelerations (`path`), (m,) torques, N m (infinite: none), and what was assumed, in words."""

    path: Limits
    torque: Array
    assumed: tuple[str, ...]


def limits_of(arm: Arm) -> MotionLimits:
    """Of an arm; `drives` in robot.yaml come before the URDF. Raises InputError: an arm without masses, of which no
    torque is known."""
    if not arm.has_masses:
        rule = "torques need masses: state `links`, or a URDF with inertias"
        raise InputError(arm.name, "", "no masses", rule)
    drives = arm.description.drives or (Drive(),) * arm.n_motors
    assumed = []
    if not np.isfinite(arm.limits).all():
        assumed.append("joints without stated limits turn half a turn to either side")
    speed = _first(_of_urdf(arm, arm.model.velocityLimit), [d.speed_deg_s for d in drives], np.pi / 180)
    if not np.isfinite(speed).all():
        assumed.append(f"joints without a stated speed limit move at {DRIVES.speed_rad_s:g} rad/s at most")
        speed = np.where(np.isfinite(speed), speed, DRIVES.speed_rad_s)
    none = np.full(arm.n_motors, np.inf)
    acceleration = _first(none, [d.acceleration_deg_s2 for d in drives], np.pi / 180)
    if not np.isfinite(acceleration).all():
        assumed.append(f"joints without a stated acceleration reach full speed in {DRIVES.rise_s:g} s")
        acceleration = np.where(np.isfinite(acceleration), acceleration, speed / DRIVES.rise_s)
    torque = _first(_of_urdf(arm, arm.model.effortLimit), [d.torque_nm for d in drives], 1.0)
    if not np.isfinite(torque).all():
        assumed.append("torques of joints without a stated limit are not limited")
    low, high = ranges(arm)
    return MotionLimits(Limits(np.column_stack([low, high]), speed, acceleration), torque, tuple(assumed))


def _of_urdf(arm: Arm, values: Array) -> Array:
    """(m,) of the file where every joint has a motor of its own, else infinite."""
    if arm.description.urdf is None or arm.description.actuation is not None:
        return np.full(arm.n_motors, np.inf)
    values = np.asarray(values, dtype=float)
    return np.where((values > 0) & (values < DRIVES.unlimited), values, np.inf)


def _first(otherwise: Array, stated: list[float | None], unit: float) -> Array:
    found = np.array(otherwise)
    for motor, value in enumerate(stated):
        if value is not None:
            found[motor] = value * unit
    return found
