"""An arm of two upright axes, as a SCARA has: few combinations of its masses move anything."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import MovingArm, build_moving_arm

PLANAR: dict[str, Any] = {
    "name": "two upright axes",
    "dh": {"joints": [{"a_mm": 350, "alpha_deg": 0, "d_mm": 300}, {"a_mm": 250, "alpha_deg": 0, "d_mm": 0}]},
    "links": [
        {"mass_kg": 8, "com_mm": [-170, 0, 0], "inertia_kg_m2": [0.02, 0.1, 0.1, 0, 0, 0]},
        {"mass_kg": 6, "com_mm": [-130, 0, 0], "inertia_kg_m2": [0.01, 0.05, 0.05, 0, 0, 0]},
    ],
}


def planar(heavier: tuple[float, float] = (1.0, 1.0), by_mm: float = 0.0, **more: object) -> MovingArm:
    """The arm, with links by some times heavier and their centres elsewhere along them, and other keys."""
    description = deepcopy(PLANAR)
    for link, times in zip(description["links"], heavier, strict=True):
        link["mass_kg"] *= times
        link["inertia_kg_m2"] = [times * each for each in link["inertia_kg_m2"]]
        link["com_mm"][0] += by_mm
    return build_moving_arm(RobotDescription.model_validate({**description, **more}))
