"""What breaks a diagnosis of torques: arms by an inverse dynamics of their own, one concealed thing each.

Nothing of the package makes them: Newton-Euler in D-H frames, in plain NumPy (Luh, Walker & Paul 1980), friction,
drives and sensors. Arms have three to six joints and masses drawn anew for each seed. Motions are waves, or moves from
point to point with pauses, in which dry friction stays at a share of what it was. What is concealed is five times as
large as the noise at its joint where it has a size, and some of it is in no library: a dead zone, friction that warms
up unrecorded. A channel that is cut off and a speed that is reported late should name nothing.

    python -m benchmarks.motion_premises [--seeds 1 2 3] [--kinds clean payload ...]
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from benchmarks.motion_own_arms import DOWN, FINE_HZ, MIDDLE, SECONDS, Arm, arm_of, moves, waves
from scipy.interpolate import make_interp_spline
from scipy.signal import lfilter

from armscope.motion.pipeline import diagnose_motion
from armscope.recordings.motions import as_motions
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import build_moving_arm

RATE_HZ, RUNS, NOISE, STRENGTH = 250, 3, 0.015, 5.0

Pull = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
"""Torque (T,) per unit, from position, speed and temperature (T,) of the joint."""
Read = Callable[[np.ndarray, float], np.ndarray]
"""What is recorded of a torque (T,) on the fine grid, whose usual size is given."""


@dataclass(frozen=True)
class Kind:
    """What is concealed.

    Attributes:
        name: that it should have; "" for none, "unknown" for something at its joint that has no name.
        pull: torque beside what the arm has, of `STRENGTH` times the noise.
        read: how the joint's torque is recorded.
        size: of the pull where it is no multiple of the noise: a share of the joint's viscous friction.
        columns: recorded besides.
    """

    name: str = ""
    pull: Pull | None = None
    read: Read | None = None
    size: float = 0.0
    columns: tuple[str, ...] = ()


def _late(torque: np.ndarray, usual: float) -> np.ndarray:
    return np.interp(np.arange(len(torque)) - 0.004 * FINE_HZ, np.arange(len(torque)), torque)


def _warm(q: np.ndarray, dq: np.ndarray, temperature: np.ndarray) -> np.ndarray:
    return -(temperature - 29) * dq


DEAD = STRENGTH * NOISE
KINDS: dict[str, Kind] = {
    "clean": Kind(),
    "stribeck": Kind("stribeck_friction", lambda q, dq, t: np.exp(-((dq / 0.06) ** 2)) * np.tanh(dq / 1e-3)),
    "asymmetric": Kind("torque_offset", lambda q, dq, t: np.abs(np.tanh(dq / 1e-3))),
    "payload": Kind("payload_error"),
    "gain": Kind("motor_constant", read=lambda torque, usual: (1 + DEAD) * torque),
    "delay": Kind("torque_delay", read=_late),
    "ripple": Kind("torque_ripple", lambda q, dq, t: np.sin(17 * q)),
    "spring": Kind("gravity_balance", lambda q, dq, t: q + 0.3),
    "dead zone": Kind("unknown", read=lambda x, usual: np.sign(x) * np.maximum(np.abs(x) - DEAD * usual, 0)),
    "cut off": Kind(read=lambda x, usual: np.clip(x, *np.array([-1, 1]) * np.percentile(np.abs(x), 90))),
    "late speed": Kind(columns=("speed",)),
    "gravity": Kind("gravity_direction"),
    "warm": Kind("thermal_friction", _warm, size=0.04, columns=("temperature",)),
    "warm, unrecorded": Kind("unknown", _warm, size=0.04),
    "elastic": Kind("joint_compliance"),
}


@dataclass
class World:
    """An arm of a seed with something concealed at a joint (from 0)."""

    label: str
    n: int
    seed: int
    by_points: bool
    joint: int = 0
    arm: Arm = field(init=False)
    true: Arm = field(init=False)
    down: np.ndarray = field(default_factory=lambda: DOWN)

    def __post_init__(self) -> None:
        rng = np.random.default_rng([self.seed, self.n, [*KINDS].index(self.label)])
        self.arm = self.true = arm_of(self.n, rng)
        inner = self.label in ("spring", "elastic")  # where gravity loads the joint
        self.joint = int(rng.integers(1, min(self.n, 3)) if inner else rng.integers(self.n))
        if self.label == "payload":
            self.true = _loaded(self.arm)
        if self.label == "gravity":
            way, lean = rng.uniform(0, 2 * np.pi), np.radians(2)
            self.down = -np.array([np.sin(lean) * np.cos(way), np.sin(lean) * np.sin(way), np.cos(lean)])

    @property
    def place(self) -> str:
        """Where a verdict should see it."""
        return {"payload": "payload", "gravity": "base"}.get(self.label, f"joint {self.joint + 1}")

    def recorded(self) -> pd.DataFrame:
        """motions.csv."""
        kind, pieces, usual, size = KINDS[self.label], [], np.zeros(self.n), 0.0
        for run in range(RUNS):
            rng = np.random.default_rng([self.seed, self.n, run, self.by_points])
            motion = (moves if self.by_points else waves)(self.n, rng)
            time = np.arange(len(motion[0])) / FINE_HZ
            warmth = 20 + 18 * (1 - np.exp(-(time + run * SECONDS) / 30))
            torque = self.true.torques(motion, self.down)
            if self.label == "elastic":
                motion = self._before_the_gear(time, motion, torque)
            torque = torque + self.arm.friction(motion)
            usual = usual if run else np.sqrt(np.mean(torque**2, axis=0))
            if kind.pull:
                away = motion[0][:, self.joint] - MIDDLE[self.joint]
                pulled = kind.pull(away, motion[1][:, self.joint], warmth)
                # one arm on all paths: as strong as on the first
                size = size if run else STRENGTH * NOISE * usual[self.joint] / np.sqrt(np.mean(pulled**2))
                torque[:, self.joint] += pulled * (kind.size * self.arm.viscous[self.joint] if kind.size else size)
            if self.label == "delay":
                torque[:, self.joint] = _late(torque[:, self.joint], 0.0)
            pieces.append(self._sampled(f"run {run + 1}", time, (*motion, torque, warmth), usual, rng))
        return pd.concat(pieces, ignore_index=True)

    def _before_the_gear(
        self, time: np.ndarray, motion: tuple[np.ndarray, ...], torque: np.ndarray
    ) -> tuple[np.ndarray, ...]:
        """The motor's motion where its link lags behind by 12 mrad at the most."""
        own = torque[:, self.joint]
        lag = make_interp_spline(time, 0.012 * own / np.abs(own).max(), k=5)
        found = tuple(each.copy() for each in motion)
        for order, values in enumerate(found):
            values[:, self.joint] += lag(time, order)
        return found

    def _sampled(
        self, run: str, time: np.ndarray, of: tuple[np.ndarray, ...], usual: np.ndarray, rng: np.random.Generator
    ) -> pd.DataFrame:
        """What is recorded of positions, speeds, accelerations, torques and temperature, with noise."""
        q, dq, _, torque, warmth = of
        kind, every = KINDS[self.label], FINE_HZ // RATE_HZ
        weights = np.r_[0.5, np.ones(every - 1), 0.5] / every  # the mean over a sample's time
        padded = np.pad(torque, ((every // 2, every // 2), (0, 0)), mode="edge")
        rows = slice(None, None, every)
        read = sum(w * padded[k : k + len(torque)] for k, w in enumerate(weights))[rows]
        kept = np.exp(-1 / (0.02 * RATE_HZ))
        white, lasting = rng.normal(size=(2, *read.shape))
        lasting = lfilter([np.sqrt(1 - kept**2)], [1, -kept], lasting, axis=0)
        read = read + NOISE * usual * (white + lasting) / np.sqrt(2)
        if kind.read and self.label != "delay":
            read[:, self.joint] = kind.read(read[:, self.joint], usual[self.joint])
        angle = q[rows] + 1e-5 * rng.normal(size=read.shape)
        content = {"run": run, "time_s": time[rows]} | {f"q{j + 1}_rad": angle[:, j] for j in range(self.n)}
        if "speed" in kind.columns:
            share = 1 - np.exp(-1 / (0.02 * FINE_HZ))
            late = lfilter([share], [1, share - 1], dq, axis=0)[rows]
            content |= {f"dq{j + 1}_rad_s": late[:, j] for j in range(self.n)}
        if "temperature" in kind.columns:
            content["temperature_c"] = warmth[rows].round(2)
        return pd.DataFrame(content | {f"tau{j + 1}_nm": read[:, j] for j in range(self.n)})


def _loaded(arm: Arm) -> Arm:
    """With a load off the flange, 6 % as heavy as the arm beyond its first link."""
    mass, at = 0.06 * sum(body[0] for body in arm.bodies[1:]), np.array([0.05, -0.04, 0.08])
    own, centre, inertia = arm.bodies[-1]
    whole, middle = own + mass, (own * centre + mass * at) / (own + mass)
    for m, c in ((own, centre - middle), (mass, at - middle)):
        inertia = inertia + m * (c @ c * np.eye(3) - np.outer(c, c))
    return Arm(arm.rows, (*arm.bodies[:-1], (whole, middle, inertia)), arm.dry, arm.viscous, arm.rotor)


def said(world: World, stated: bool) -> tuple[str, str]:
    """ "right", "silent" or "wrong", and what a diagnosis says of a world."""
    arm = build_moving_arm(RobotDescription.model_validate(world.arm.robot(stated)))
    verdict = diagnose_motion(arm, as_motions(world.recorded(), "motions.csv", world.n)).verdict
    named = {(each.effect, each.location) for each in verdict.effects if not (each.minor or each.nameless)}
    wanted, beyond = KINDS[world.label].name, verdict.unexplained.location
    told = ", ".join([f"{name} {place}" for name, place in sorted(named)] + [f"unknown {beyond}"] * bool(beyond))
    right = {
        "": not named and not beyond,
        "unknown": not named and beyond == world.place,
    }.get(wanted, named == {(wanted, world.place)} and not beyond)
    return "right" if right else "wrong" if told else "silent", told


def main() -> None:
    """See the module's docstring."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--kinds", nargs="+", choices=[*KINDS], default=[*KINDS])
    asked = parser.parse_args()
    for by_points in (False, True):
        for number, label in enumerate(asked.kinds):
            counts = dict.fromkeys(("right", "silent", "wrong"), 0)
            for seed in asked.seeds:
                world = World(label, 3 + (number + seed) % 4, seed, by_points)
                answer, told = said(world, stated=(number // 2 + seed) % 2 == 0)
                counts[answer] += 1
                if answer != "right":
                    print(f"    {label}, {world.n} joints, seed {seed}, {world.place}: {told or 'nothing'}", flush=True)
            print(f"{'point to point' if by_points else 'waves'}, {label}: {counts}", flush=True)


if __name__ == "__main__":
    main()
