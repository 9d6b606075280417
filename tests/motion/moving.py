"""Arms in motion for tests: smooth random paths, torques by Newton-Euler, and whatever a test plants on top."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pandas as pd
import pinocchio as pin
from scipy.interpolate import make_interp_spline

from armscope.core.types import Array
from armscope.recordings.motions import Motions, as_motions
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import MovingArm, build_moving_arm

Plant = Callable[[Array, Array, Array, Array], Array]
"""Torque (N, m) on top, from positions, velocities, accelerations and the rigid torque."""

ROBOT = {
    "name": "three joints",
    "dh": {
        "joints": [
            {"a_mm": 0, "alpha_deg": -90, "d_mm": 300},
            {"a_mm": 400, "alpha_deg": 0, "d_mm": 0},
            {"a_mm": 300, "alpha_deg": 0, "d_mm": 0},
        ]
    },
    "links": [
        {"mass_kg": 12, "com_mm": [0, 50, 0], "inertia_kg_m2": [0.1, 0.08, 0.1, 0, 0, 0]},
        {"mass_kg": 8, "com_mm": [-180, 0, 20], "inertia_kg_m2": [0.02, 0.12, 0.12, 0, 0, 0]},
        {"mass_kg": 4, "com_mm": [-150, 10, 0], "inertia_kg_m2": [0.01, 0.04, 0.04, 0, 0, 0]},
    ],
}
COULOMB, VISCOUS, ROTOR = np.array([4.0, 5.0, 2.0]), np.array([3.0, 4.0, 1.5]), np.array([0.5, 0.6, 0.2])


def robot(**more: object) -> MovingArm:
    """The arm of the tests."""
    return build_moving_arm(RobotDescription.model_validate({**ROBOT, **more}))


def path(rng: np.random.Generator, joints: int, seconds: float, rate: float) -> tuple[Array, Array, Array, Array]:
    """Time, positions, velocities, accelerations of a random band-limited path."""
    time = np.arange(int(seconds * rate)) / rate
    q = np.zeros((len(time), joints))
    dq, ddq = np.zeros_like(q), np.zeros_like(q)
    for j in range(joints):
        for k in range(1, 7):
            omega, phase = 2 * np.pi * k * 0.11, rng.uniform(0, 2 * np.pi)
            size = rng.uniform(0.4, 1.0) / k
            q[:, j] += size * np.sin(omega * time + phase)
            dq[:, j] += size * omega * np.cos(omega * time + phase)
            ddq[:, j] -= size * omega**2 * np.sin(omega * time + phase)
    return time, q, dq, ddq


def table(
    arm: MovingArm, seed: int, plant: Plant | None = None, runs: int = 2, noise: float = 0.02, seconds: float = 10.0
) -> pd.DataFrame:
    """motions.csv of an arm with ordinary friction and rotors, and what is planted."""
    rng, pieces = np.random.default_rng(seed), []
    for run in range(runs):
        time, q, dq, ddq = path(rng, arm.n_motors, seconds, 200.0)
        data = arm.model.createData()
        rigid = np.array([pin.rnea(arm.model, data, *row).copy() for row in zip(q, dq, ddq, strict=True)])
        n = arm.n_motors
        torque = rigid + COULOMB[:n] * np.sign(dq) + VISCOUS[:n] * dq + ROTOR[:n] * ddq
        if plant is not None:
            torque = torque + plant(q, dq, ddq, rigid)
        torque = torque + noise * torque.std(axis=0) * rng.normal(size=torque.shape)
        columns = {"run": f"path {run + 1}", "time_s": time}
        columns |= {f"q{j + 1}_rad": q[:, j] + 1e-5 * rng.normal(size=len(q)) for j in range(n)}
        pieces.append(pd.DataFrame(columns | {f"tau{j + 1}_nm": torque[:, j] for j in range(n)}))
    return pd.concat(pieces, ignore_index=True)


def moved(arm: MovingArm, seed: int, plant: Plant | None = None, **how: float) -> Motions:
    """The same as `Motions`."""
    return as_motions(table(arm, seed, plant, **how), "motions.csv", arm.n_motors)  # type: ignore[arg-type]


def carrying(seed: int, mass: float) -> Motions:
    """Three runs, in the second of which that many kg sit at the last link's centre of mass."""
    *others, last = ROBOT["links"]  # type: ignore[misc]
    heavier = robot(links=[*others, {**last, "mass_kg": last["mass_kg"] + mass}])
    without, loaded = (moved(arm, seed, runs=3) for arm in (robot(), heavier))
    there = (without.run == without.runs[1])[:, None]
    return replace(without, effort=np.where(there, loaded.effort, without.effort))


def clinging(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """Dahl's friction at joint 2: it comes back over a way, and no cause of the library does."""
    extra, state = np.zeros_like(q), 0.0
    for row in range(1, len(q)):
        step = q[row, 1] - q[row - 1, 1]
        state = np.sign(step) + (state - np.sign(step)) * np.exp(-abs(step) / 0.1)
        extra[row, 1] = 3 * state
    return extra


WAY = 1.5e-3
"""Over which friction takes hold, rad: ten times a stiff gear's, as these arms turn slowly."""


def presliding(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """What friction of every joint lacks after each reversal (Dahl 1968)."""
    held = np.sign(dq).copy()
    for row in range(1, len(q)):
        step = q[row] - q[row - 1]
        held[row] = np.sign(step) + (held[row - 1] - np.sign(step)) * np.exp(-np.abs(step) / WAY)
    return 4 * COULOMB * (held - np.sign(dq)) + 3 * COULOMB * np.sign(dq)


def behind_its_drive(
    arm: MovingArm, joint: int, compliance: float, seed: int = 1, noise: float = 0.02, seconds: float = 10.0
) -> pd.DataFrame:
    """motions.csv of an arm one of whose drives gives way, exactly: links move as they do, the motor where it must be.

    Its encoder stands at the link's angle and compliance x the link's torque; friction and rotor are the motor's.
    """
    rng, pieces, n = np.random.default_rng(seed), [], arm.n_motors
    data = arm.model.createData()
    for run in range(2):
        time, q, dq, ddq = path(rng, n, seconds, 200.0)
        rigid = np.array([pin.rnea(arm.model, data, *row).copy() for row in zip(q, dq, ddq, strict=True)])
        lag = make_interp_spline(time, compliance * rigid[:, joint], k=5)
        for order, values in enumerate((q, dq, ddq)):
            values[:, joint] += lag(time, order)
        torque = rigid + COULOMB[:n] * np.sign(dq) + VISCOUS[:n] * dq + ROTOR[:n] * ddq
        torque += noise * torque.std(axis=0) * rng.normal(size=torque.shape)
        columns = {"run": f"path {run + 1}", "time_s": time}
        columns |= {f"q{j + 1}_rad": q[:, j] + 1e-5 * rng.normal(size=len(q)) for j in range(n)}
        pieces.append(pd.DataFrame(columns | {f"tau{j + 1}_nm": torque[:, j] for j in range(n)}))
    return pd.concat(pieces, ignore_index=True)
