"""The sealed truth of moving worlds, as scoring reads it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from armscope.core.types import Array
from armscope.proof.definitions import Name
from armscope.proof.truth import Concealed, concealed, unsealed
from armscope.verdict.effects import UNKNOWN

COMPARED = {
    "coulomb_friction": ("coulomb",), "viscous_friction": ("viscous",), "asymmetric_friction": ("viscous_difference",),
    "stribeck_friction": ("stribeck",), "load_friction": ("per_load",), "thermal_friction": ("per_kelvin",),
    "rotor_inertia": ("inertia",), "torque_offset": ("offset",), "motor_constant": ("gain",),
    "torque_delay": ("delay",), "joint_compliance": ("compliance",),
    "link_mass": ("mass",), "payload_error": ("mass",), "torque_ripple": ("amplitude",),
    "joint_elasticity": ("compliance",), "joint_play": ("half",), "gear_ratio": ("share",), "encoder_lag": ("lag",),
    "encoder_wave": ("sine", "cosine"),
    "coupled_friction": ("coulomb", "viscous"), "coupled_inertia": ("inertia",), "gravity_direction": ("x", "y"),
}  # fmt: skip
"""Numbers whose meaning does not hang on what else is fitted; scanned ones (speed, waves per turn) have no interval."""
BACKGROUND = {"coulomb": "coulomb_nm", "viscous": "viscous_nm_s_rad", "inertia": "rotor_inertia_kg_m2"}
"""Ordinary friction and rotors: a verdict's name and the truth's."""


@dataclass(frozen=True, eq=False)
class MotionTruth:
    """What a moving world conceals.

    Attributes:
        world, category, arm, fresh, rows, stated: as made.
        outside: whether no library has it.
        effects: what is concealed.
        rough: what a rough arm has everywhere; nobody is asked to name it.
        also_allowed: names that are no wrong ones besides those of both.
        background: by joint, the friction and rotors of this arm.
        zeros: (n,) rad, of links' encoders beside their motors'; empty where links have none.
        left_nm: (n,) RMS that the truth itself leaves on the test path; left_moving_nm: where the joint moves.
        test: the test path with its torques, and where each joint moves.
    """

    world: str
    category: str
    arm: str
    fresh: bool
    rows: int
    stated: bool
    outside: bool
    effects: tuple[Concealed, ...]
    rough: tuple[Concealed, ...]
    also_allowed: tuple[Name, ...]
    background: dict[str, dict[str, float]]
    zeros: Array
    left_nm: Array
    left_moving_nm: Array
    test: pd.DataFrame


def unseal(archive: Path) -> dict[str, MotionTruth]:
    """The truths of an archive, by world.

    Raises:
        InputError: it holds something else.
    """
    return {world: _truth(world, content, test) for world, (content, test) in unsealed(archive).items()}


def _truth(world: str, content: dict[str, Any], test: pd.DataFrame) -> MotionTruth:
    about = content["scoring"]
    return MotionTruth(
        world=world,
        category=about["category"],
        arm=about["arm"],
        fresh=about["fresh"],
        rows=about["rows"],
        stated=about["stated"],
        outside=about["outside_library"],
        effects=tuple(_effect(each) for each in content["effects"]),
        rough=tuple(replace(_effect(each), minor=True) for each in content["rough"]),
        also_allowed=tuple((effect, location) for effect, location in content["also_allowed"]),
        background={each["location"]: {name: each[key] for name, key in BACKGROUND.items()} 
                    for each in content["background"]},
        zeros=np.array(content["zeros_rad"], dtype=float),
        left_nm=np.array(content["left_on_test_nm"]),
        left_moving_nm=np.array(content["left_moving_nm"]),
        test=test,
    )  # fmt: skip


def _effect(content: dict[str, Any]) -> Concealed:
    found, kept = concealed(content), COMPARED.get(content["effect"], ())
    numbers = {name: number for name, number in found.parameters.items() if name in kept}
    return replace(found, parameters=numbers, comparable=found.effect != UNKNOWN)
