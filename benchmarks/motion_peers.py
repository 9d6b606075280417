"""Other packages beside armscope's fit of the same parameters: one motion, another path of it held out, one thread.

Here, and in figaroh and mujoco.sysid, angles are low-passed and derived alike, and what is foretold of the held-out
path is compared low-passed alike: aurt alone has a preparation of its own. What each fits stands in `benchmarks/peers`.
"""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from time import process_time

import numpy as np
import pandas as pd
import pinocchio as pin
from benchmarks.diagnosis import ONE_THREAD

from armscope.motion.fitting.model_estimate import stated_model
from armscope.motion.fitting.rows import MotionRows, build_rows
from armscope.motion.fitting.weights import fitted_together
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.samples.preparation import Preparation, parts, preparation
from armscope.motion.samples.timing import Stretch
from armscope.motion.verdict import relative
from armscope.robot.dynamics import MovingArm

PEERS = Path(__file__).parent / "peers"
CUTOFF_HZ = 10.0


@dataclass(frozen=True)
class Pythons:
    """Interpreters of the peers' environments; None: not asked for."""

    figaroh: str | None = None
    sysid: str | None = None
    aurt: str | None = None


@dataclass(frozen=True, eq=False)
class Problem:
    """An arm, as a URDF too, stretches that are fitted and stretches that are held out."""

    arm: MovingArm
    urdf: Path
    train: Sequence[Stretch]
    test: Sequence[Stretch]

    @property
    def how(self) -> Preparation:
        """The same for all."""
        return preparation(self.train[0].rate, CUTOFF_HZ, "given")


def here(problem: Problem) -> tuple[float, float, MotionRows]:
    """(held-out error, CPU s) of masses, friction, rotors and offsets by least squares, and the held-out rows."""
    import scipy.signal  # noqa: F401  # loaded before the clock runs, as the peers' packages are

    layout = TorqueLayout(problem.arm, (), False)
    started = process_time()
    rows = build_rows(layout, problem.train, problem.how, stated_model(problem.arm))
    found = fitted_together(rows, np.arange(layout.width))
    seconds = process_time() - started
    apart = build_rows(layout, problem.test, problem.how, stated_model(problem.arm))
    return relative(apart.torque - apart.nominal - apart.modelled(found), apart.torque), seconds, apart


def compare(title: str, problem: Problem, pythons: Pythons) -> None:
    """Fit here and by figaroh and mujoco.sysid, and print errors and times, as ratios too."""
    error, seconds, apart = here(problem)
    print(f"{title}\n{'':10} same parameters, here: {seconds:.2f} s CPU, held out {100 * error:.2f} %")
    with tempfile.TemporaryDirectory() as made:
        home = Path(made)
        laid = {"every": np.array(problem.how.every), "rate": np.array(problem.train[0].rate)}
        for name, some in (("train", problem.train), ("test", problem.test)):
            laid |= _laid(name, some, problem.how)
        np.savez(home / "motion.npz", **laid)
        if pythons.figaroh:
            told = asked(pythons.figaroh, "motion_with_figaroh.py", problem.urdf, home / "motion.npz")
            tell("figaroh", told, error, seconds)
        if pythons.sysid:
            (home / "arm.xml").write_text(mjcf(problem.arm))
            files = (home / "arm.xml", home / "motion.npz", home / "said.npz")
            for which in ("joints", "all"):
                told = asked(pythons.sysid, "motion_with_sysid.py", *files, which)
                if told:
                    said = _low_passed(np.load(home / "said.npz")["said"], problem)
                    told["held_out"] = relative(apart.torque - said, apart.torque)
                tell(f"mujoco.sysid, {which}", told, error, seconds)


def _laid(name: str, some: Sequence[Stretch], how: Preparation) -> dict[str, np.ndarray]:
    """Samples of stretches one below the other: smooth angles and their derivatives, torque as recorded."""
    found: dict[str, list[np.ndarray]] = {each: [] for each in ("q", "dq", "ddq", "tau", "run")}
    for number, stretch in enumerate(some):
        smooth = list(parts([stretch], how, every_sample=True))
        for each in ("q", "dq", "ddq"):
            found[each] += [getattr(part, each)[part.kept] for part in smooth]
        found["tau"].append(stretch.effort)
        found["run"].append(np.full(len(stretch), number))
    return {f"{each}_{name}": np.concatenate(values) for each, values in found.items()}


def _low_passed(said: np.ndarray, problem: Problem) -> np.ndarray:
    """Torques of every held-out sample as rows of the fit are made of them."""
    found, start, how = [], 0, problem.how
    for stretch in problem.test:
        rows = np.arange(how.edge, len(stretch) - how.edge, how.every)
        found.append(how.low_passed(said[start : start + len(stretch)], rows))
        start += len(stretch)
    return np.concatenate(found)


def beside_aurt(title: str, problem: Problem, python: str) -> None:
    """Fit one path of an arm of D-H rows here and by aurt, and compare errors on another."""
    error, seconds, _ = here(problem)
    print(f"{title}\n{'':10} same parameters, here: {seconds:.2f} s CPU, held out {100 * error:.2f} %")
    description = problem.arm.description
    assert description.dh is not None
    given = description.dh.joints
    rows = [(1e-3 * row.d_mm, 1e-3 * row.a_mm, np.radians(row.alpha_deg)) for row in given]
    rows[-1] = (0.0, 0.0, 0.0)  # what stands behind the last axis moves nothing, nor does the first height
    rows[0] = (0.0, *rows[0][1:])
    offset = np.radians([row.theta_offset_deg for row in given])
    with tempfile.TemporaryDirectory() as made:
        home = Path(made)
        pd.DataFrame(rows, columns=["d", "a", "alpha"]).to_csv(home / "rows.csv", index=False)
        for name, (stretch,) in (("train", problem.train), ("test", problem.test)):
            _aurt_table(stretch, offset).to_csv(home / f"{name}.csv", sep=" ", index=False)
        files = [home / f"{name}.csv" for name in ("rows", "train", "test")]
        for load in ("none", "square"):
            told = asked(python, "motion_with_aurt.py", *files, load, *description.gravity_m_s2)
            tell(f"aurt, load friction {load}", told, error, seconds)


def _aurt_table(stretch: Stretch, offset: np.ndarray) -> pd.DataFrame:
    """A motion in its columns; it reads targets, too, and does not use them."""
    columns = {"timestamp": stretch.time - stretch.time[0]}
    for j in range(stretch.q.shape[1]):
        angle = stretch.q[:, j] + offset[j]
        columns |= {f"actual_q_{j}": angle, f"actual_current_{j}": stretch.effort[:, j], f"target_q_{j}": angle}
        rest = ("target_qd", "target_qdd", "target_current", "target_moment", "actual_qd")
        columns |= {f"{name}_{j}": np.zeros(len(stretch)) for name in rest}
    return pd.DataFrame(columns)


def asked(python: str, program: str, *words: object) -> dict[str, float]:
    """What a peer's process says in its last line; nothing, with its reason printed, where it fails."""
    command = [python, str(PEERS / program), *map(str, words)]
    ended = subprocess.run(command, capture_output=True, text=True, check=False, env=os.environ | ONE_THREAD)
    if ended.returncode:
        print(f"{'':10} {program} failed: {ended.stderr.strip().splitlines()[-1]}")
        return {}
    found: dict[str, float] = json.loads(ended.stdout.splitlines()[-1])
    return found


def tell(name: str, told: dict[str, float], error: float, seconds: float) -> None:
    """A peer's line, if it ran."""
    if not told:
        return
    ratios = f"{told['held_out'] / error:.2f} x the error, {told['cpu_s'] / seconds:.1f} x the time"
    compiled = f" (compiled before in {told['compile_cpu_s']:.1f} s)" if "compile_cpu_s" in told else ""
    figures = f"{told['cpu_s']:.2f} s CPU{compiled}, held out {100 * told['held_out']:.2f} %"
    print(f"{'':10} {name}: {figures} with {told['parameters']:.0f} parameters ({ratios})", flush=True)


def mjcf(arm: MovingArm) -> str:
    """The arm as stated for MuJoCo: bodies, a motor for each joint, sensors of all angles and then of all speeds."""
    words = lambda values: " ".join(repr(float(each)) for each in values)
    root = ET.Element("mujoco", model=arm.name)
    ET.SubElement(root, "compiler", angle="radian")
    option = ET.SubElement(root, "option", gravity=words(arm.model.gravity.linear), integrator="implicitfast")
    ET.SubElement(option, "flag", contact="disable", limit="disable")
    body, motors, sensors = ET.SubElement(root, "worldbody"), ET.Element("actuator"), ET.Element("sensor")
    data = arm.model.createData()
    pin.forwardKinematics(arm.model, data, pin.neutral(arm.model), np.zeros(arm.model.nv))
    for joint in range(1, arm.model.njoints):
        placed, inertia = arm.model.jointPlacements[joint], arm.model.inertias[joint]
        turn = pin.Quaternion(placed.rotation).coeffs()[[3, 0, 1, 2]]
        body = ET.SubElement(body, "body", name=f"link {joint}", pos=words(placed.translation), quat=words(turn))
        about = inertia.inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        more = {"mass": repr(float(inertia.mass)), "fullinertia": words(about)}
        ET.SubElement(body, "inertial", pos=words(inertia.lever), **more)
        axis = np.asarray(data.joints[joint].S).ravel()
        kind, way = ("slide", axis[:3]) if np.any(axis[:3]) else ("hinge", axis[3:])
        ET.SubElement(body, "joint", name=f"joint {joint}", type=kind, axis=words(way))
        ET.SubElement(motors, "motor", name=f"motor {joint}", joint=f"joint {joint}")
    for what in ("jointpos", "jointvel"):
        for joint in range(1, arm.model.njoints):
            ET.SubElement(sensors, what, name=f"{what} {joint}", joint=f"joint {joint}")
    root.extend((motors, sensors))
    return ET.tostring(root, encoding="unicode")
