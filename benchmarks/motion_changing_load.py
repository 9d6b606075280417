"""A load that comes and goes while the recording goes on: is it told, when, and how heavy?

Arms by the inverse dynamics of `benchmarks.motion_own_arms`, which nothing of the package makes. In one of the runs, or
in the only one, a load of 3 to 10 % of what the arm weighs beyond its first link is there from a moment on, until one,
between two, or several times; in two kinds nothing changes: there is none, or it is there all the time.

    python -m benchmarks.motion_changing_load [--seeds 1 2 3] [--kinds from until ...]
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass, field, replace

import numpy as np
import pandas as pd
from benchmarks.motion_own_arms import FINE_HZ, SECONDS, Arm, arm_of, moves, waves
from scipy.signal import lfilter

from armscope.motion.pipeline import diagnose_motion
from armscope.motion.verdict import MotionVerdict
from armscope.recordings.motions import as_motions
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import build_moving_arm

RATE_HZ, NOISE = 250, 0.015
KINDS = {"from": 1, "until": 1, "between": 2, "several": 6, "none": 0, "always": 0}
"""How often the load comes or goes."""


@dataclass
class World:
    """An arm of a seed, its load, and when that is there.

    Attributes:
        kind: of `KINDS`.
        n: joints; seed: of all that is drawn; runs: how many.
        by_points: whether it moves from point to point, with pauses.
        wrong: share by which stated masses are off, each by its own.
    """

    kind: str
    n: int
    seed: int
    runs: int = 1
    by_points: bool = False
    wrong: float = 0.0
    arm: Arm = field(init=False)
    moments: tuple[float, ...] = field(init=False)

    def __post_init__(self) -> None:
        rng = np.random.default_rng([self.seed, self.n, [*KINDS].index(self.kind)])
        self.arm = arm_of(self.n, rng)
        self.mass = float(rng.uniform(0.03, 0.1)) * sum(body[0] for body in self.arm.bodies[1:])
        self.at = np.array([0.05, -0.04, 0.08])
        count = KINDS[self.kind]
        cells = (np.arange(count) + rng.uniform(0.25, 0.75, count)) / max(count, 1)
        self.moments = tuple((1.5 + (SECONDS - 3) * cells).tolist())
        self.off = 1 + self.wrong * rng.uniform(-1, 1, self.n)

    @property
    def changed(self) -> str:
        """The run in which something changes."""
        return f"run {self.runs}"

    def there(self, time: np.ndarray) -> np.ndarray:
        """(T,) when the load is."""
        start = self.kind in ("until", "always")
        return (start + np.searchsorted(self.moments, time, side="right")) % 2 == 1

    def recorded(self) -> pd.DataFrame:
        """motions.csv."""
        pieces, usual = [], np.zeros(self.n)
        for run in range(1, self.runs + 1):
            rng = np.random.default_rng([self.seed, self.n, run, self.by_points])
            motion = (moves if self.by_points else waves)(self.n, rng)
            time = np.arange(len(motion[0])) / FINE_HZ
            torque = self.arm.torques(motion)
            if self.kind == "always" or (run == self.runs and self.kind != "none"):
                loaded = carrying(self.arm, self.mass, self.at).torques(motion)
                torque = np.where(self.there(time)[:, None], loaded, torque)
            torque = torque + self.arm.friction(motion)
            usual = usual if run > 1 else np.sqrt(np.mean(torque**2, axis=0))
            pieces.append(sampled(f"run {run}", time, motion[0], torque, usual, rng))
        return pd.concat(pieces, ignore_index=True)

    def stated(self) -> dict:
        """robot.yaml."""
        bodies = [(m * k, c, i * k) for (m, c, i), k in zip(self.arm.bodies, self.off, strict=True)]
        return replace(self.arm, bodies=tuple(bodies)).robot(stated=self.seed % 2 == 0)

    def verdict(self) -> MotionVerdict:
        """What a diagnosis says."""
        arm = build_moving_arm(RobotDescription.model_validate(self.stated()))
        return diagnose_motion(arm, as_motions(self.recorded(), "motions.csv", self.n)).verdict


def carrying(arm: Arm, mass: float, at: np.ndarray) -> Arm:
    """With a point load, kg, at a place in the last D-H frame, m."""
    own, centre, inertia = arm.bodies[-1]
    whole, middle = own + mass, (own * centre + mass * at) / (own + mass)
    for m, c in ((own, centre - middle), (mass, at - middle)):
        inertia = inertia + m * (c @ c * np.eye(3) - np.outer(c, c))
    return replace(arm, bodies=(*arm.bodies[:-1], (whole, middle, inertia)))


def sampled(
    run: str, time: np.ndarray, q: np.ndarray, torque: np.ndarray, usual: np.ndarray, rng: np.random.Generator
) -> pd.DataFrame:
    """What is recorded of positions and torques (T, n) on the fine grid, half of the noise lasting 20 ms."""
    every = FINE_HZ // RATE_HZ
    weights = np.r_[0.5, np.ones(every - 1), 0.5] / every  # the mean over a sample's time
    padded = np.pad(torque, ((every // 2, every // 2), (0, 0)), mode="edge")
    read = sum(w * padded[k : k + len(torque)] for k, w in enumerate(weights))[::every]
    kept = np.exp(-1 / (0.02 * RATE_HZ))
    white, lasting = rng.normal(size=(2, *read.shape))
    lasting = lfilter([np.sqrt(1 - kept**2)], [1, -kept], lasting, axis=0)
    read = read + NOISE * usual * (white + lasting) / np.sqrt(2)
    angle = q[::every] + 1e-5 * rng.normal(size=read.shape)
    content = {"run": run, "time_s": time[::every]} | {f"q{j + 1}_rad": angle[:, j] for j in range(q.shape[1])}
    return pd.DataFrame(content | {f"tau{j + 1}_nm": read[:, j] for j in range(q.shape[1])})


def said(world: World, verdict: MotionVerdict) -> tuple[bool, str]:
    """Whether the change is told as it is, and nothing false beside it; and what is told."""
    true_beside = ("link_mass",) if world.wrong else ()
    told = [each for each in verdict.effects if not each.minor and each.effect not in true_beside]
    changes = [each for each in told if each.effect == "load_change"]
    words = "; ".join(f"{each.title} {', '.join(f'{p.name} {p.value:.3g}' for p in each.parameters)}" for each in told)
    words += f" | {verdict.unexplained.location}" * verdict.unexplained.present
    if not world.moments:
        right = not changes and [each.effect for each in told] == ["payload_error"] * (world.kind == "always")
        return right, words
    if len(told) != 1 or len(changes) != 1 or not changes[0].title.endswith(world.changed):
        return False, words
    numbers = {each.name: each for each in changes[0].parameters}
    moments = [each.value for each in changes[0].parameters if each.name.partition("_")[0] in ("from", "until")]
    mass = numbers["mass"]
    held = abs(abs(mass.value) - world.mass) < max(1.96 * mass.stderr, 0.02 * world.mass)
    slack = np.maximum(numbers["unsure"].value, 0.05)
    when = len(moments) == len(world.moments) and bool(np.all(np.abs(np.subtract(moments, world.moments)) < slack))
    return held and when, f"{words}; true {world.mass:.3g} kg at {np.round(world.moments, 2).tolist()}"


def main() -> None:
    """See the module's docstring."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3, 4])
    parser.add_argument("--kinds", nargs="+", choices=[*KINDS], default=[*KINDS])
    parser.add_argument("--wrong", type=float, default=0.0, help="share by which stated masses are off")
    asked = parser.parse_args()
    for by_points in (False, True):
        for kind in asked.kinds:
            count = 0
            for seed in asked.seeds:
                world = World(kind, 3 + seed % 4, seed, 1 + 2 * (seed // 4 % 2), by_points, asked.wrong)
                right, words = said(world, world.verdict())
                count += right
                if not right:
                    print(
                        f"    {kind}, {world.n} joints, {world.runs} runs, seed {seed}: {words or 'nothing'}",
                        flush=True,
                    )
            print(f"{'point to point' if by_points else 'waves'}, {kind}: {count} of {len(asked.seeds)}", flush=True)


if __name__ == "__main__":
    main()
