"""The sealed truth of moving worlds, as scoring reads it."""

from __future__ import annotations

from collections.abc import Sequence
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
    """What a moving world conceals."""

    world: str
    category: str
    arm: str
    fresh: bool
    rows: int
    stated: bool
    outside: bool  # whether no library has it
    effects: tuple[Concealed, ...]
    rough: tuple[Concealed, ...]  # what a rough arm has everywhere; nobody is asked to name it
    also_allowed: tuple[Name, ...]  # names that are no wrong ones besides those of both
    background: dict[str, dict[str, float]]  # by joint, the friction and rotors of this arm
    zeros: Array  # (n,) rad, of links' encoders beside their motors'; empty where links have none
    left_nm: Array  # (n,) RMS that the truth itself leaves on the test path; left_moving_nm: where the joint moves
    left_moving_nm: Array
    test: pd.DataFrame  # the test path with its torques, and where each joint moves


def unseal(archive: Path) -> dict[str, MotionTruth]:
    """The truths of an archive, by world. Raises InputError: it holds something else."""
    return {world: _truth(world, content, test) for world, (content, test) in unsealed(archive).items()}


def _truth(world: str, content: dict[str, Any], test: pd.DataFrame) -> MotionTruth:
    about = content["scoring"]
    rough = tuple(replace(each, minor=True) for each in _effects(content["rough"]))
    return MotionTruth(
        world=world,
        category=about["category"],
        arm=about["arm"],
        fresh=about["fresh"],
        rows=about["rows"],
        stated=about["stated"],
        outside=about["outside_library"],
        effects=_with_what_is_rough(_effects(content["effects"]), rough),
        rough=rough,
        also_allowed=tuple((effect, location) for effect, location in content["also_allowed"]),
        background={each["location"]: {name: each[key] for name, key in BACKGROUND.items()} 
                    for each in content["background"]},
        zeros=np.array(content["zeros_rad"], dtype=float),
        left_nm=np.array(content["left_on_test_nm"]),
        left_moving_nm=np.array(content["left_moving_nm"]),
        test=test,
    )  # fmt: skip


def _effects(contents: Sequence[dict[str, Any]]) -> tuple[Concealed, ...]:
    """What is concealed, two of one name as one: two loads of one flange weigh together."""
    found: dict[Name, Concealed] = {}
    for each in map(_effect, contents):
        known = found.get(each.name)
        found[each.name] = (
            each if known is None else replace(_summed(known, each), strength=known.strength + each.strength)
        )
    return tuple(found.values())


def _with_what_is_rough(effects: Sequence[Concealed], rough: Sequence[Concealed]) -> tuple[Concealed, ...]:
    """Causes with the numbers that the arm has: those of a cause and of the small errors of its name add up."""
    small = {each.name: each for each in rough}
    return tuple(_summed(each, small[each.name]) if each.name in small else each for each in effects)


def _summed(one: Concealed, other: Concealed) -> Concealed:
    """One with the other's numbers added, as far as both have them; others of it are not comparable."""
    both = {
        name: (value + other.parameters[name][0], unit)
        for name, (value, unit) in one.parameters.items()
        if name in other.parameters
    }
    return replace(one, parameters=both)


def _effect(content: dict[str, Any]) -> Concealed:
    found, kept = concealed(content), COMPARED.get(content["effect"], ())
    numbers = {name: number for name, number in found.parameters.items() if name in kept}
    return replace(found, parameters=numbers, comparable=found.effect != UNKNOWN)
