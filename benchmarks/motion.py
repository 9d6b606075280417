"""What a diagnosis of an arm in motion costs, by samples: CPU time, memory, and what it says of what was planted.

Motions are generated: six joints on random Fourier paths of 50 s, inverse dynamics of the stated masses, ordinary
friction and rotors, 2 % of noise, and two causes: friction that grows with load at joint 2, torque 20 ms late at
joint 4. Each command runs in a process of its own, on one thread, reading of the table included.

With --figaroh, --sysid and --aurt (interpreters of environments with benchmarks/peers/requirements-*.txt) the same
parameters are also fitted by these, the last path of the shortest motion held out, with ratios to the same parameters
here, without a diagnosis (`benchmarks.motion_peers`). figaroh gets three paths and one of them; mujoco.sysid, which
simulates, one; aurt gets one path of a planar arm of two axes, for its symbolic model of six axes was not
compiled when it was stopped, after 12 minutes of CPU. With --motions FOLDER two real sets are fitted as well, run by
run: aurt does not take part, for it knows neither sliding joints (EMPS) nor, within that time, six axes (UR10e).

    python -m benchmarks.motion [--samples 20000 1000000] [--figaroh PYTHON] [--sysid PYTHON] [--aurt PYTHON]
        [--motions FOLDER]
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import yaml
from benchmarks.motion_peers import Problem, Pythons, beside_aurt, compare
from benchmarks.scale import cost

from armscope.design.fourier import Limits, random_path
from armscope.motion.fitting.gains import torque_of
from armscope.motion.samples.timing import mended, stretches
from armscope.recordings.motions import read_motions
from armscope.robot.dynamics import MovingArm, load_moving_arm

CONFIG = Path(__file__).parents[1] / "config"
ARM, TWO = (CONFIG / "motion" / f"{name}-axis.yaml" for name in ("six", "two"))
SETS = CONFIG / "motions"
REAL = {"emps": ("trapezoids", "pulses"), "ur10e-currents": ("14harm50sec", "50sec_12harm")}
SECONDS, HARMONICS, NOISE, LATE_S, PER_LOAD = 50.0, 12, 0.02, 0.02, 0.08
RATES = {20_000: 100.0, 1_000_000: 1000.0}
"""Samples per second by samples: four paths of 50 s, twenty paths of 50 s."""
PLANTED = {("load_friction", "joint 2"), ("torque_delay", "joint 4")}


def robot(folder: Path, source: Path = ARM) -> Path:
    """robot.yaml of the arm without its friction and rotors, which the diagnosis is to fit."""
    content = yaml.safe_load(source.read_text())
    for drive in content["drives"]:
        for stated in ("rotor_inertia_kg_m2", "coulomb_nm", "viscous_nm_s_rad"):
            del drive[stated]
    (folder / "robot.yaml").write_text(yaml.safe_dump(content))
    return folder / "robot.yaml"


def motions(samples: int, rate: float, path: Path, source: Path = ARM) -> None:
    """Write motions.csv of an arm with so many samples."""
    arm, rng = load_moving_arm(source), np.random.default_rng(samples)
    drives = arm.description.drives or ()
    limits = Limits(
        np.radians(np.array(arm.description.joint_limits_deg)),
        np.radians([drive.speed_deg_s for drive in drives]),
        np.radians([drive.acceleration_deg_s2 for drive in drives]),
    )
    each = int(SECONDS * rate)
    for run in range(samples // each):
        time = np.arange(each) / rate
        q, dq, ddq = random_path(limits, HARMONICS, SECONDS, rng).at(time)
        torque = _torque(arm, q, dq, ddq, time)
        torque += NOISE * torque.std(axis=0) * rng.normal(size=torque.shape)
        columns = {"run": f"path {run + 1}", "time_s": time}
        columns |= {f"q{j + 1}_rad": q[:, j] + 1e-5 * rng.normal(size=each) for j in range(arm.n_motors)}
        columns |= {f"tau{j + 1}_nm": torque[:, j] for j in range(arm.n_motors)}
        pd.DataFrame(columns).to_csv(path, mode="a", index=False, header=run == 0, float_format="%.9g")


def _torque(arm: MovingArm, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray, time: np.ndarray) -> np.ndarray:
    _, coulomb, viscous, rotor = arm.stated_background.T
    rigid = arm.torques(q, dq, ddq, arm.inertial)
    torque = rigid + coulomb * np.sign(dq) + viscous * dq + rotor * ddq
    torque[:, 1] += PER_LOAD * np.abs(rigid[:, 1]) * np.sign(dq[:, 1])
    if torque.shape[1] > 3:
        torque[:, 3] = np.interp(time - LATE_S, time, torque[:, 3])
    return np.asarray(torque)


def main() -> None:
    """See the module's docstring."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--samples", type=int, nargs="+", default=[20_000, 1_000_000])
    for peer in ("figaroh", "sysid", "aurt"):
        parser.add_argument(f"--{peer}", help="interpreter of its environment")
    parser.add_argument("--motions", type=Path, help="folder of the imported real sets")
    asked = parser.parse_args()
    pythons = Pythons(asked.figaroh, asked.sysid, asked.aurt)
    with tempfile.TemporaryDirectory() as made:
        home, first = Path(made), None
        for samples in sorted(asked.samples):
            folder = home / str(samples)
            folder.mkdir()
            motions(samples, RATES.get(samples, 1000.0), folder / "motions.csv")
            command = [sys.executable, "-m", "armscope", "diagnose", str(folder / "motions.csv"), "--no-report"]
            taken = cost([*command, "-r", str(robot(folder)), "-o", str(folder / "out")])
            first = first or taken
            ratios = " and ".join(f"{ratio:.1f} x" for ratio in np.divide(taken, first))
            print(f"{samples:10,} samples{taken[0]:8.1f} s CPU{taken[1]:8.0f} MB ({ratios} the shortest)")
            _tell(json.loads((folder / "out" / "verdict.json").read_text()))
            if samples == min(asked.samples) and (asked.figaroh or asked.sysid or asked.aurt):
                beside_peers(folder, pythons)
    if asked.motions:
        beside_real(asked.motions, pythons)


def beside_peers(folder: Path, pythons: Pythons) -> None:
    """The last path held out: three or one fitted by figaroh, one by mujoco.sysid, one of two axes by aurt."""
    arm, table = load_moving_arm(folder / "robot.yaml"), read_motions(folder / "motions.csv")
    *train, test = stretches(table)
    urdf = folder / "out" / "corrected.urdf"
    compare("three paths, six axes", Problem(arm, urdf, train, [test]), replace(pythons, sysid=None))
    compare("one path, six axes", Problem(arm, urdf, train[:1], [test]), pythons)
    if pythons.aurt:
        (folder / "two").mkdir()
        motions(2 * int(SECONDS * 100), 100.0, folder / "two" / "motions.csv", TWO)
        two = load_moving_arm(robot(folder / "two", TWO))
        fitted, apart = stretches(read_motions(folder / "two" / "motions.csv"))
        beside_aurt("one path, two axes", Problem(two, urdf, [fitted], [apart]), pythons.aurt)


def arm_of_set(source: Path, folder: Path) -> MovingArm:
    """The arm of a real set imported to a folder of the set's name; robot.yaml and robot.urdf are put into another."""
    for file in ("robot.yaml", "robot.urdf"):
        kept = SETS / source.name / file
        (folder / file).write_bytes((kept if kept.exists() else source / file).read_bytes())
    return load_moving_arm(folder / "robot.yaml")


def beside_real(folder: Path, pythons: Pythons) -> None:
    """Real sets (imported to folder/NAME/motions.csv.gz, with the arm's URDF): one run fitted, another held out."""
    for name, (fitted, held_out) in REAL.items():
        source = folder / name
        with tempfile.TemporaryDirectory() as made:
            arm = arm_of_set(source, Path(made))
            whole, _ = mended(read_motions(source / "motions.csv.gz", arm.n_motors))
            laid = [replace(s, effort=torque_of(arm, s.effort, whole.kind)) for s in stretches(whole)]
            train, test = ([each for each in laid if each.run == run] for run in (fitted, held_out))
            problem = Problem(arm, Path(made) / "robot.urdf", train, test)
            compare(f"{name}: {fitted} fitted, {held_out} held out", problem, pythons)


def _tell(verdict: dict) -> None:
    named = {(each["effect"], each["location"]) for each in verdict["effects"] if not each["minor"]}
    found = f"planted causes named: {len(named & PLANTED)} of {len(PLANTED)}, others: {len(named - PLANTED)}"
    print(f"{'':10} {verdict['rows']:,} rows kept; {found}")
    before, after = (f"{100 * verdict['held_out'][name]:.2f} %" for name in ("background", "model"))
    print(f"{'':10} held out: {before} with friction and rotors, {after} with causes")


if __name__ == "__main__":
    main()
