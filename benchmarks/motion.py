"""What a diagnosis of an arm in motion costs, by samples: CPU time, memory, and what it says of what was planted.

Motions are generated: six joints on random Fourier paths of 50 s, inverse dynamics of the stated masses, ordinary
friction and rotors, 2 % of noise, and two causes: friction that grows with load at joint 2, torque 20 ms late at
joint 4. Each command runs in a process of its own, on one thread, reading of the table included.

With --figaroh, the shortest motion is also fitted by figaroh (an environment with
benchmarks/peers/requirements-figaroh.txt), which takes all base parameters, friction, rotors and offsets: its last path
is held out for both, the other paths are low-passed and derived for both alike. Beside it the same parameters are
fitted here, without a diagnosis.

    python -m benchmarks.motion [--samples 20000 1000000] [--figaroh PYTHON]
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from time import process_time

import numpy as np
import pandas as pd
import yaml
from benchmarks.diagnosis import ONE_THREAD
from benchmarks.scale import cost

from armscope.design.fourier import Limits, random_path
from armscope.motion.layout import TorqueLayout
from armscope.motion.preparation import parts, preparation
from armscope.motion.rows import build_rows, stated_model
from armscope.motion.timing import stretches
from armscope.motion.verdict import relative
from armscope.motion.weights import fitted_together
from armscope.recordings.motions import read_motions
from armscope.robot.dynamics import MovingArm, load_moving_arm

ARM = Path(__file__).parents[1] / "config" / "motion" / "six-axis.yaml"
SECONDS, HARMONICS, NOISE, LATE_S, PER_LOAD = 50.0, 12, 0.02, 0.02, 0.08
CUTOFF_HZ = 10.0
RATES = {20_000: 100.0, 1_000_000: 1000.0}
"""Samples per second by samples: four paths of 50 s, twenty paths of 50 s."""
PLANTED = {("load_friction", "joint 2"), ("torque_delay", "joint 4")}


def robot(folder: Path) -> Path:
    """robot.yaml of the arm without its friction and rotors, which the diagnosis is to fit."""
    content = yaml.safe_load(ARM.read_text())
    for drive in content["drives"]:
        for stated in ("rotor_inertia_kg_m2", "coulomb_nm", "viscous_nm_s_rad"):
            del drive[stated]
    (folder / "robot.yaml").write_text(yaml.safe_dump(content))
    return folder / "robot.yaml"


def motions(samples: int, rate: float, path: Path) -> None:
    """Write motions.csv with so many samples."""
    arm, rng = load_moving_arm(ARM), np.random.default_rng(samples)
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
    torque[:, 3] = np.interp(time - LATE_S, time, torque[:, 3])
    return np.asarray(torque)


def main() -> None:
    """See the module's docstring."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--samples", type=int, nargs="+", default=[20_000, 1_000_000])
    parser.add_argument("--figaroh", help="interpreter of its environment")
    asked = parser.parse_args()
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
            if asked.figaroh and samples == min(asked.samples):
                beside_figaroh(folder, asked.figaroh)


def beside_figaroh(folder: Path, python: str) -> None:
    """Fit all but the last path, here and by figaroh, and compare errors on it."""
    arm, table = load_moving_arm(folder / "robot.yaml"), read_motions(folder / "motions.csv")
    *train, test = stretches(table)
    how = preparation(train[0].rate, CUTOFF_HZ, "given")
    layout = TorqueLayout(arm, (), False)
    started = process_time()
    rows = build_rows(layout, train, how, stated_model(arm))
    found = fitted_together(rows, np.arange(layout.width))
    seconds = process_time() - started
    apart = build_rows(layout, [test], how, stated_model(arm))
    missed = apart.torque - apart.nominal - apart.modelled(found)
    print(f"{'':10} same parameters, here: {seconds:.2f} s CPU, held out {100 * relative(missed, apart.torque):.2f} %")
    laid: dict[str, np.ndarray] = {"every": np.array(how.every)}
    for part, some in (("train", train), ("test", [test])):
        smooth = [each for stretch in some for each in parts([stretch], how, every_sample=True)]
        for name in ("q", "dq", "ddq"):
            laid[f"{name}_{part}"] = np.concatenate([getattr(each, name)[each.kept] for each in smooth])
        laid[f"tau_{part}"] = np.concatenate([stretch.effort for stretch in some])
    np.savez(folder / "motion.npz", **laid)
    peer = Path(__file__).parent / "peers" / "motion_with_figaroh.py"
    command = [python, str(peer), str(folder / "out" / "corrected.urdf"), str(folder / "motion.npz")]
    told = subprocess.run(command, capture_output=True, text=True, check=True, env=os.environ | ONE_THREAD).stdout
    theirs = json.loads(told.splitlines()[-1])
    error, count = 100 * theirs["held_out"], theirs["parameters"]
    print(f"{'':10} figaroh: {theirs['cpu_s']:.2f} s CPU, held out {error:.2f} % with {count} parameters")


def _tell(verdict: dict) -> None:
    named = {(each["effect"], each["location"]) for each in verdict["effects"] if not each["minor"]}
    found = f"planted causes named: {len(named & PLANTED)} of {len(PLANTED)}, others: {len(named - PLANTED)}"
    print(f"{'':10} {verdict['rows']:,} rows kept; {found}")
    before, after = (f"{100 * verdict['held_out'][name]:.2f} %" for name in ("background", "model"))
    print(f"{'':10} held out: {before} with friction and rotors, {after} with causes")


if __name__ == "__main__":
    main()
