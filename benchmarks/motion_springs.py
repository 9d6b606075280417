"""A gas spring between two links, or a cable of one of four shapes: is each told as what it is?

Arms by the inverse dynamics of `benchmarks.motion_own_arms`, which nothing of the package makes. A gas spring pushes
between a point of one link and a point of the next, by a force that grows by some percent over its stroke: its torque
is taken from where these points are. Cables are curves of the joint's angle that no spring has.

    python -m benchmarks.motion_springs [--seeds 1 2 3] [--kinds long even ...] [--share 0.3]
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from benchmarks.motion_changing_load import sampled
from benchmarks.motion_own_arms import FINE_HZ, MIDDLE, Arm, arm_of, moves, waves

from armscope.motion.pipeline import diagnose_motion
from armscope.motion.verdict import MotionVerdict
from armscope.recordings.motions import as_motions
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import build_moving_arm

RUNS = 2


@dataclass(frozen=True)
class GasSpring:
    """Where it is mounted, m from the joint's axis, on the link before and on the one behind; the angle between both in
    the middle of the joint's range, rad; by which share its force grows with a stroke as long as the shorter of both.
    """

    before: float
    behind: float
    between: float
    grows: float

    def torque(self, away: np.ndarray) -> np.ndarray:
        """(T,) per N, with the joint (T,) rad from the middle of its range: d(length)/d(angle), times force."""
        turned = np.append(away, 0.0) + self.between
        fixed = np.array([self.before, 0.0])
        at = self.behind * np.column_stack([np.cos(turned), np.sin(turned)])
        along = at - fixed
        *length, usual = np.linalg.norm(along, axis=1)
        across = np.column_stack([-at[:, 1], at[:, 0]])  # how the point moves as the joint turns
        force = 1 + self.grows * (length - usual) / min(self.before, self.behind)
        return np.asarray(force * np.sum(along * across, axis=1)[:-1] / length)


SPRINGS = {
    "long": GasSpring(0.60, 0.15, 1.2, 0.1),
    "even": GasSpring(0.40, 0.30, 1.6, 0.2),
    "near": GasSpring(0.35, 0.33, 0.9, 0.1),
    "over": GasSpring(0.50, 0.25, 0.3, 0.05),
    "coil": GasSpring(0.40, 0.05, 1.2, 0.9),
}
"""By the geometry that they have; one passes its dead centre, and one is a coil, hardly pre-tensioned."""
CABLES: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "taut": lambda x: np.exp(3.0 * x) - 1,
    "harness": lambda x: 0.4 * x + 4 * x**3,
    "end": lambda x: np.maximum(x - 0.2, 0.0) ** 2,
    "folded": lambda x: np.sin(6 * x) * np.exp(-3 * x**2) + 0.5 * x,
}
"""Of the angle from the middle of the range, rad."""


@dataclass
class World:
    """An arm of a seed with a spring or a cable at its second or third joint.

    Attributes:
        kind: of `SPRINGS` or `CABLES`.
        n: joints; seed: of all that is drawn.
        by_points: whether it moves from point to point, with pauses.
        share: RMS of its torque, of the joint's usual one.
    """

    kind: str
    n: int
    seed: int
    by_points: bool = False
    share: float = 0.3
    arm: Arm = field(init=False)

    def __post_init__(self) -> None:
        self.arm = arm_of(self.n, np.random.default_rng([self.seed, self.n, 9]))
        self.joint = 1 + self.seed % 2

    def recorded(self) -> pd.DataFrame:
        """motions.csv."""
        pieces, usual, size = [], np.zeros(self.n), 0.0
        for run in range(1, RUNS + 1):
            rng = np.random.default_rng([self.seed, self.n, run, self.by_points])
            motion = (moves if self.by_points else waves)(self.n, rng)
            torque = self.arm.torques(motion) + self.arm.friction(motion)
            away = motion[0][:, self.joint] - MIDDLE[self.joint]
            pulled = SPRINGS[self.kind].torque(away) if self.kind in SPRINGS else CABLES[self.kind](away)
            if run == 1:
                usual = np.sqrt(np.mean(torque**2, axis=0))
                size = self.share * usual[self.joint] / float(np.sqrt(np.mean(pulled**2)))
            torque[:, self.joint] += size * pulled
            time = np.arange(len(motion[0])) / FINE_HZ
            pieces.append(sampled(f"run {run}", time, motion[0], torque, usual, rng))
        return pd.concat(pieces, ignore_index=True)

    def verdict(self) -> MotionVerdict:
        """What a diagnosis says."""
        arm = build_moving_arm(RobotDescription.model_validate(self.arm.robot(stated=self.seed % 2 == 0)))
        return diagnose_motion(arm, as_motions(self.recorded(), "motions.csv", self.n)).verdict


def said(world: World, verdict: MotionVerdict) -> tuple[bool, str]:
    """Whether it has its name at its joint and nothing else has one; and what is told."""
    wanted = ("gravity_balance" if world.kind in SPRINGS else "cable_torque", f"joint {world.joint + 1}")
    told = [each for each in verdict.effects if not each.minor]
    words = "; ".join(
        f"{each.title} {100 * each.share:.0f} % (or "
        + ", ".join(f"{other.effect} {other.location} {other.evidence_gap_nats:.0f}" for other in each.alternatives)
        + ")"
        for each in told
    )
    words += f" | unknown {verdict.unexplained.location}" * verdict.unexplained.present
    return [(each.effect, each.location) for each in told] == [wanted], words


def main() -> None:
    """See the module's docstring."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3, 4])
    parser.add_argument("--kinds", nargs="+", choices=[*SPRINGS, *CABLES], default=[*SPRINGS, *CABLES])
    parser.add_argument("--share", type=float, default=0.3)
    asked = parser.parse_args()
    for by_points in (False, True):
        for kind in asked.kinds:
            count = 0
            for seed in asked.seeds:
                world = World(kind, 3 + seed % 4, seed, by_points, asked.share)
                verdict = world.verdict()
                right, words = said(world, verdict)
                count += right
                if not right:
                    print(f"    {kind}, {world.n} joints, seed {seed}: {words or 'nothing'}", flush=True)
            print(f"{'point to point' if by_points else 'waves'}, {kind}: {count} of {len(asked.seeds)}", flush=True)


if __name__ == "__main__":
    main()
