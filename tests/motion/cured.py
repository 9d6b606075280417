"""Cures of an arm in motion, executed as they are printed: an arm that conceals one thing, and its simulator's owner.

The truth is pinocchio's recursive Newton-Euler of bodies as robot.yaml has them, friction and rotors in plain NumPy.
Who cures it has robot.yaml, a simulator of that arm, and the sentence on the card; what he reads there he does.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import pinocchio as pin

from armscope.core.types import Array
from armscope.motion.pipeline import diagnose_motion
from armscope.motion.verdict import FoundCause
from armscope.recordings.motions import as_motions
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import build_moving_arm
from tests.motion.moving import COULOMB, ROBOT, ROTOR, VISCOUS, path

Spec = dict[str, Any]
JOINT, MOVES_RAD_S, NOISE = 1, 0.05, 0.01
"""The joint that most causes are planted at, from 0; the speed below which a joint turns back; of its torque."""
SHORT, LONG = (2, 10.0), (3, 15.0)
"""How many paths are recorded, and s of each: a whole period of them is what most cures need."""
DRIVES = [
    {"coulomb_nm": float(dry), "viscous_nm_s_rad": float(viscous), "rotor_inertia_kg_m2": float(rotor)}
    for dry, viscous, rotor in zip(COULOMB, VISCOUS, ROTOR, strict=True)
]
STATED: Spec = {**ROBOT, "drives": DRIVES}


@dataclass(frozen=True)
class Motion:
    """T samples of a path: s, rad and its derivatives (T, 3), deg C."""

    time: Array
    q: Array
    dq: Array
    ddq: Array
    warmth: Array

    @property
    def moving(self) -> Any:
        """(T,) where no joint turns back."""
        return np.abs(self.dq).min(axis=1) > MOVES_RAD_S


Torque = Callable[[Motion, Array], Array]
"""What becomes of the torque (T, 3) of a motion."""


def as_it_is(motion: Motion, torque: Array) -> Array:
    return torque


def at_joint(pull: Callable[[Array, Array, Array, Array], Array], joint: int = JOINT) -> Torque:
    """Torque on top at one joint, of its position, speed, acceleration and temperature."""

    def more(motion: Motion, torque: Array) -> Array:
        found = torque.copy()
        own = (each[:, joint] for each in (motion.q, motion.dq, motion.ddq))
        found[:, joint] += pull(*own, motion.warmth)
        return found

    return more


def edited(change: Callable[[Spec], None]) -> Spec:
    """The stated robot.yaml with something else in it."""
    spec = copy.deepcopy(STATED)
    change(spec)
    return spec


def rigid(spec: Spec, motion: Motion) -> Array:
    """Newton-Euler of the bodies."""
    model = build_moving_arm(RobotDescription.model_validate(spec)).model
    data = model.createData()
    rows = zip(motion.q, motion.dq, motion.ddq, strict=True)
    return np.array([pin.rnea(model, data, *row).copy() for row in rows])


def simulated(spec: Spec, motion: Motion) -> Array:
    """With friction and rotors of its drives."""
    names = ("coulomb_nm", "viscous_nm_s_rad", "rotor_inertia_kg_m2")
    dry, viscous, rotor = (np.array([drive[name] for drive in spec["drives"]]) for name in names)
    return rigid(spec, motion) + dry * np.sign(motion.dq) + viscous * motion.dq + rotor * motion.ddq


def moved(seed: int, run: int, seconds: float = LONG[1]) -> Motion:
    time, q, dq, ddq = path(np.random.default_rng([seed, run]), 3, seconds, 200.0)
    return Motion(time, q, dq, ddq, 22 + 6 * run + 8 * (1 - np.exp(-time / 8)))


def diagnosed(
    spec: Spec, plant: Torque, seed: int, warm: bool = False, paths: tuple[int, float] = SHORT
) -> tuple[FoundCause, ...]:
    """What is named on some paths of an arm that is not as stated."""
    pieces, rng = [], np.random.default_rng([seed, 99])
    for run in range(paths[0]):
        motion = moved(seed, run, paths[1])
        torque = plant(motion, simulated(spec, motion))
        torque = torque + NOISE * torque.std(axis=0) * rng.normal(size=torque.shape)
        columns = {"run": f"path {run + 1}", "time_s": motion.time}
        columns |= {f"q{j + 1}_rad": motion.q[:, j] + 1e-5 * rng.normal(size=len(torque)) for j in range(3)}
        columns |= {f"tau{j + 1}_nm": torque[:, j] for j in range(3)}
        pieces.append(pd.DataFrame(columns | ({"temperature_c": motion.warmth} if warm else {})))
    arm = build_moving_arm(RobotDescription.model_validate(STATED))
    return diagnose_motion(arm, as_motions(pd.concat(pieces, ignore_index=True), "motions.csv", 3)).verdict.effects


def left(truth: tuple[Spec, Torque], cured: tuple[Spec, Torque, Torque], seed: int) -> float:
    """What the cure leaves of the torque that was missing, on a path that nobody has seen.

    Args:
        truth: what the arm is, and what is planted on top.
        cured: robot.yaml after the cure, what it adds to the simulated torque, and what it does to the recorded one.
        seed: of the path.

    Returns:
        RMS of what is left over RMS of what was missing, of all joints where they move.
    """
    motion = moved(seed, 7)
    recorded = truth[1](motion, simulated(truth[0], motion))
    after = cured[2](motion, recorded) - cured[1](motion, simulated(cured[0], motion))
    before = recorded - simulated(STATED, motion)
    return float(np.linalg.norm(after[motion.moving]) / np.linalg.norm(before[motion.moving]))


def told(text: str, after: str = "") -> list[float]:
    """The numbers that stand in a sentence after some words, without what follows a ±."""
    start = text.index(after) + len(after)
    plain = re.sub(r"± [\d.]+", "", text[start:]).replace("−", "-")
    plain = re.sub(r"([+-]) (?=\d)", r"\1", plain)
    return [float(each) for each in re.findall(r"(?<![\w.^])[+-]?\d+\.?\d*", plain)]
