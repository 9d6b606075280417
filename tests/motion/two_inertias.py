"""An arm whose motor and link are two inertias at one joint, simulated forward in time by MuJoCo: both are recorded.

Between them is a spring, a play, or nothing. A controller follows paths with the motors; nothing of the package's
dynamics or laws takes part.
"""

from __future__ import annotations

from functools import lru_cache

import mujoco
import numpy as np
import pandas as pd

from armscope.motion.pipeline import MotionDiagnosis, diagnose_motion
from armscope.recordings.motions import as_motions
from armscope.robot.description import RobotDescription
from armscope.world.layout import Geometry
from armscope.world.motion.mechanism import Dynamics, mjcf_of
from tests.motion.moving import COULOMB, ROBOT, ROTOR, VISCOUS, path, robot

STEP_S, RATE_HZ, SECONDS = 0.0005, 200.0, 15.0
NOISE_RAD = 2e-6
"""Of each encoder: a third of a step of 20 bits."""
RIGID = ""


def spring(stiffness: float, damping: float = 2.0) -> str:
    """A second hinge behind the motor's, held by a spring."""
    return f'<joint name="behind" axis="0 0 1" stiffness="{stiffness!r}" damping="{damping!r}"/>'


def play(half: float) -> str:
    """A second hinge that is free between two stops."""
    stops = f'limited="true" range="{-half!r} {half!r}" solreflimit="0.002 1" solimplimit="0.99 0.999 1e-5"'
    return f'<joint name="behind" axis="0 0 1" damping="0.5" {stops}/>'


def recorded(behind: str, joint: int = 2, seed: int = 1, runs: int = 2, noise: float = 0.02) -> pd.DataFrame:
    """motions.csv of the arm with something behind the motor of a joint (from 1) whose link has an encoder, too."""
    return _simulated(behind, joint, seed, runs, noise).copy()


@lru_cache  # what several modules ask of it, in one process
def said_of(behind: str, joint: int, seed: int = 1) -> MotionDiagnosis:
    """What is said of what was recorded."""
    return diagnose_motion(robot(), as_motions(recorded(behind, joint, seed), "motions.csv", 3))


def wound_up() -> MotionDiagnosis:
    """What is said of the arm whose third joint has a soft spring."""
    return said_of(spring(3000.0), 3, 4)


@lru_cache  # the rigid arm is the same in many tests, and a second of MuJoCo's steps
def _simulated(behind: str, joint: int, seed: int, runs: int, noise: float) -> pd.DataFrame:
    rng = np.random.default_rng(seed)
    model = mujoco.MjModel.from_xml_string(_xml(behind, joint))
    return pd.concat([_run(model, (f"path {n + 1}", joint), rng, noise) for n in range(runs)], ignore_index=True)


def _xml(behind: str, joint: int) -> str:
    description = RobotDescription.model_validate(ROBOT)
    assert description.links is not None
    dynamics = Dynamics(
        mass=np.array([link.mass_kg for link in description.links]),
        centre=np.array([link.com_mm for link in description.links]) * 1e-3,
        inertia=np.array([link.inertia_kg_m2 for link in description.links], dtype=float),
        rotor=ROTOR,
        coulomb=COULOMB,
        viscous=VISCOUS,
        gravity=np.array([0, 0, -9.81]),
    )
    whole = mjcf_of(Geometry(description), dynamics)
    head, motor, tail = whole.partition(f'<joint name="joint {joint}"')
    own, close, rest = tail.partition("/>")
    assert close
    changed = f"{head}{motor}{own}{close}{behind}{rest}"
    return changed.replace("<option ", f'<option timestep="{STEP_S!r}" integrator="implicitfast" ', 1)


def _run(model: mujoco.MjModel, named: tuple[str, int], rng: np.random.Generator, noise: float) -> pd.DataFrame:
    run, joint = named
    data = mujoco.MjData(model)
    dofs = [int(model.joint(f"joint {j + 1}").dofadr[0]) for j in range(3)]
    behind = [n for n in range(model.nv) if n not in dofs]
    time, q, dq, _ = path(rng, 3, SECONDS, 1 / STEP_S)
    every = round(1 / RATE_HZ / STEP_S)
    data.qpos[dofs], data.qvel[dofs] = q[0], dq[0]
    stiff, damped = np.array([4e3, 8e3, 2e3]), np.array([200.0, 400.0, 60.0])
    friction = VISCOUS * dq + COULOMB * np.tanh(dq / 0.02)  # what it takes, so that the path is followed
    position, speed, applied = data.qpos, data.qvel, data.qfrc_applied  # views: asking for one takes as long as a step
    rows = []
    for k in range(len(time)):
        torque = stiff * (q[k] - position[dofs]) + damped * (dq[k] - speed[dofs]) + friction[k]
        applied[dofs] = torque
        if k % every == 0:
            twist = float(position[behind].sum())
            rows.append([time[k], *position[dofs], position[dofs[joint - 1]] + twist, *torque])
        mujoco.mj_step(model, data)
    names = ["time_s", "q1_rad", "q2_rad", "q3_rad", f"q{joint}_link_rad", "tau1_nm", "tau2_nm", "tau3_nm"]
    table = pd.DataFrame(rows, columns=names)
    table[names[1:5]] += NOISE_RAD * rng.normal(size=(len(table), 4))
    torques = table[names[5:]]
    table[names[5:]] += noise * torques.std().to_numpy() * rng.normal(size=torques.shape)
    table.insert(0, "run", run)
    return table[table["time_s"] > 1.0]  # the controller has caught the path by then
