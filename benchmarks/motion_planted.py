"""Known causes added to real motion: is each found where it was added, with its size, and is nothing else new?

To the recorded torque of one joint something known is added: what no drive did. A set is diagnosed as it is, and again
with each cause, of a size of STRENGTHS times what the model leaves at that joint. Nothing of the package's laws is
used: causes are functions of recorded positions, their differences, and torques. Names that come beside are told
apart: such as the set as it is had not even as an alternative, such as it had, and minor ones.

    python -m benchmarks.motion_planted FOLDER [--sets emps panda-motion ur10e-currents] [--runs ...] [--seed N]

FOLDER holds the imported sets: NAME/motions.csv.gz and, where config/motions lacks it, NAME/robot.urdf.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from benchmarks.motion import arm_of_set

from armscope.motion.pipeline import MotionDiagnosis, diagnose_motion
from armscope.motion.samples.timing import mended
from armscope.recordings.motions import Motions, read_motions
from armscope.robot.dynamics import MovingArm

STRENGTHS = (3.0, 8.0)
Added = Callable[[np.ndarray, np.ndarray, np.ndarray, np.ndarray], np.ndarray]
"""Torque (N,), per unit, from time, position, speed, torque (N,) of one run and joint."""


def _slope(time: np.ndarray, torque: np.ndarray) -> np.ndarray:
    return -np.gradient(_smooth(torque), time)


def _smooth(values: np.ndarray) -> np.ndarray:
    return np.convolve(values, np.hanning(21) / np.hanning(21).sum(), mode="same")


CAUSES: dict[str, tuple[Added, str]] = {
    "torque_offset": (lambda t, q, dq, tau: np.ones_like(q), "offset"),
    "motor_constant": (lambda t, q, dq, tau: tau, "gain"),
    "asymmetric_friction": (lambda t, q, dq, tau: np.abs(dq), "viscous_difference"),
    "gravity_balance": (lambda t, q, dq, tau: q - q.mean(), "stiffness"),
    "torque_ripple": (lambda t, q, dq, tau: np.cos(11 * q), "cosine"),
    "torque_delay": (lambda t, q, dq, tau: _slope(t, tau), "delay"),
}
"""By name, with the parameter that tells its size. A delay is added as such, of as many seconds as make its size."""


def planted(motions: Motions, name: str, joint: int, rms: float) -> tuple[Motions, float]:
    """Motions with a cause at a joint (from 0) whose torque has that RMS, in units of effort; and its size."""
    law, _ = CAUSES[name]
    found, shapes = motions.effort.copy(), np.zeros(len(motions))
    for run in motions.runs:
        rows = np.flatnonzero(motions.run == run)
        q, time = motions.q[rows, joint], motions.time[rows]
        dq = _smooth(np.gradient(q, time)) if motions.dq is None else motions.dq[rows, joint]
        shapes[rows] = law(time, q, dq, motions.effort[rows, joint])
    size = rms / float(np.sqrt(np.mean((shapes - (shapes.mean() if name == "gravity_balance" else 0)) ** 2)))
    for run in motions.runs:
        rows = np.flatnonzero(motions.run == run)
        if name == "torque_delay":
            time = motions.time[rows]
            found[rows, joint] = np.interp(time - size, time, motions.effort[rows, joint])
        else:
            found[rows, joint] += size * shapes[rows]
    return replace(motions, effort=found), size


def said(found: MotionDiagnosis) -> dict[tuple[str, str], dict[str, tuple[float, float]]]:
    """Every cause's parameters: value and standard error."""
    return {
        (each.effect, each.location): {p.name: (p.value, p.stderr) for p in each.parameters}
        for each in found.verdict.effects
    }


def telling(found: MotionDiagnosis) -> set[tuple[str, str]]:
    """Causes that are names and no minor ones: what a reader is told to look at."""
    return {(each.effect, each.location) for each in found.verdict.effects if not (each.minor or each.nameless)}


def alternatives(found: MotionDiagnosis) -> set[tuple[str, str]]:
    """What could stand in the place of its causes."""
    return {(other.effect, other.location) for each in found.verdict.effects for other in each.alternatives}


def judge(arm: MovingArm, motions: Motions, before: MotionDiagnosis, name: str, joint: int, rms: float) -> str:
    """One line: what was added, and what changed in the verdict."""
    unit = 1.0 if motions.kind == "torque" else float(arm.gains[joint])
    changed, size = planted(motions, name, joint, rms / unit)
    after, place = diagnose_motion(arm, changed), f"joint {joint + 1}"
    was, now = said(before), said(after)
    new = now.keys() - was.keys() - {(name, place)}
    size *= unit if name not in ("motor_constant", "torque_delay") else 1.0
    there = "named" if (name, place) in now else "alternative" if (name, place) in alternatives(after) else "MISSED"
    parameter = CAUSES[name][1]
    value, error = now.get((name, place), {}).get(parameter, (float("nan"), float("nan")))
    value -= was.get((name, place), {}).get(parameter, (0.0, 0.0))[0]
    held = abs(value - size) <= 1.96 * error
    large, rivals = new & telling(after), alternatives(before)
    told = {"; new beside: ": large - rivals, "; an alternative before: ": large & rivals, "; minor: ": new - large}
    beside = "".join(words + ", ".join(sorted(f"{e} {p}" for e, p in which)) for words, which in told.items() if which)
    return f"{name} {place}: {there}, {value:.4g} +- {1.96 * error:.2g} for {size:.4g} {held}{beside}"


def main() -> None:
    """See the module's docstring."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--sets", nargs="+", default=["emps", "panda-motion", "ur10e-currents"])
    parser.add_argument("--runs", nargs="+", help="of the set, all by default")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    for name in asked.sets:
        source = asked.folder / name
        with tempfile.TemporaryDirectory() as made:
            arm = arm_of_set(source, Path(made))
        motions, _ = mended(read_motions(source / "motions.csv.gz", arm.n_motors))
        if asked.runs:
            motions = motions.rows(np.isin(motions.run, asked.runs))
        before = diagnose_motion(arm, motions)
        left = [each.noise for each in before.verdict.background]
        rng = np.random.default_rng(asked.seed)
        for strength in STRENGTHS:
            for cause in CAUSES:
                joint = int(rng.integers(arm.n_motors))
                if cause == "torque_ripple" and arm.sliding[joint]:
                    continue
                line = judge(arm, motions, before, cause, joint, strength * left[joint])
                print(f"{name}, {strength:g} x: {line}", flush=True)


if __name__ == "__main__":
    main()
