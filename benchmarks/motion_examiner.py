"""An examiner of its own: arms with ordinary friction in every joint, and one thing that is wrong, or none.

What an arm asks of its motors comes from pinocchio's recursive Newton-Euler, called directly on bodies that are built
here; nothing of the package makes the truth. Every arm moves on two paths of eight waves a joint to be fitted, and on a
third of another kind, from point to point, that takes no part. Torque has 1 % of white noise, positions are counts of
an encoder of 19 bits. Counted are: the right name at the right place, names beside it that are no minor ones, and
how many 95 % intervals hold the size; of every joint's friction and rotor, too.

    python -m benchmarks.motion_examiner [--seeds 1 2 3 4] [--kinds payload gain ...]
"""

from __future__ import annotations

import argparse
from collections import Counter
from dataclasses import dataclass

import numpy as np
import pandas as pd
import pinocchio as pin
from benchmarks.motion_own_arms import MIDDLE, Arm, arm_of, moves, waves

from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.recordings.motions import as_motions
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import build_moving_arm

NOISE, ENCODER, LOAD_KG, G, EVERY, CABLE = 0.01, 2 * np.pi / 2**19, 2.0, 9.81, 10, 0.08
KINDS = {
    "nothing": "",
    "payload": "payload_error",
    "link mass": "link_mass",
    "gain": "motor_constant",
    "viscous": "viscous_friction",
    "gravity": "gravity_direction",
    "cable": "cable_torque",
}
"""What is wrong, and the name that it should have."""


@dataclass(frozen=True)
class Truth:
    """Place and name of what is wrong, and its numbers by parameter."""

    name: str
    place: str
    numbers: dict[str, float]


def pin_model(arm: Arm, down: np.ndarray, load: float, heavier: tuple[int, float]) -> pin.Model:
    """Bodies about axes z of standard D-H rows: link j turns about the z axis of frame j - 1.

    Args:
        arm: rows and bodies.
        down: unit vector of gravity.
        load: kg at the last frame's origin.
        heavier: a link (from 0), and by which factor it is heavier than stated.
    """
    model, before = pin.Model(), pin.SE3.Identity()
    model.gravity.linear = G * down
    for j, ((a, alpha, d), (mass, centre, inertia)) in enumerate(zip(arm.rows, arm.bodies, strict=True)):
        turn = np.radians(alpha)
        c, s = np.cos(turn), np.sin(turn)
        after = pin.SE3(np.array([[1, 0, 0], [0, c, -s], [0, s, c]]), np.array([a, 0, d]))
        joint = model.addJoint(j, pin.JointModelRZ(), before, f"joint {j + 1}")
        factor = heavier[1] if heavier[0] == j else 1.0
        model.appendBodyToJoint(joint, pin.Inertia(factor * mass, centre, factor * inertia), after)
        before = after
    if load:
        point = pin.Inertia(load, np.zeros(3), np.zeros((3, 3)))
        model.appendBodyToJoint(len(arm.rows), point, before)
    return model


class World:
    """An arm of a seed with one thing wrong."""

    def __init__(self, kind: str, n: int, seed: int) -> None:
        self.kind, self.n, self.seed = kind, n, seed
        rng = np.random.default_rng([seed, n, [*KINDS].index(kind), 77])
        self.arm = arm_of(n, rng)
        self.joint = int(rng.integers(n))
        self.down, self.load, self.heavier = np.array([0.0, 0.0, -1.0]), 0.0, (-1, 1.0)
        self.viscous = self.arm.viscous.copy()
        self.truth = Truth(KINDS[kind], f"joint {self.joint + 1}", {})
        if kind == "payload":
            self.load = 1.2 * LOAD_KG
            self.truth = Truth(KINDS[kind], "payload", {"mass": 0.2 * LOAD_KG})
        elif kind == "link mass":  # the first turns about a plumb axis; the last with a load is the payload's
            link = int(rng.integers(1, n - 1))
            self.heavier = (link, 1.2)
            self.truth = Truth(KINDS[kind], f"link {link + 1}", {"mass": 0.2 * self.arm.bodies[link][0]})
        elif kind == "gain":
            self.truth = Truth(KINDS[kind], self.truth.place, {"gain": 0.05})
        elif kind == "viscous":
            self.viscous[self.joint] *= 3
            more = 2 * float(self.arm.viscous[self.joint])
            self.truth = Truth(KINDS[kind], self.truth.place, {"viscous": more})
        elif kind == "gravity":
            way, lean = rng.uniform(0, 2 * np.pi), np.radians(2)
            self.down = -np.array([np.sin(lean) * np.cos(way), np.sin(lean) * np.sin(way), np.cos(lean)])
            self.truth = Truth(KINDS[kind], "base", {})

    @property
    def stated(self) -> bool:
        """Whether robot.yaml states friction and rotors: else more friction is ordinary."""
        return self.kind == "viscous" or self.seed % 2 == 0

    def table(self) -> pd.DataFrame:
        """motions.csv: two paths to fit, and one of another kind."""
        model = pin_model(self.arm, self.down, self.load, self.heavier)
        data, pieces = model.createData(), []
        usual: np.ndarray | None = None
        most = 0.0  # of the cable's pull, on the first path: a cable is as stiff on the others
        for number, run in enumerate(("fit 1", "fit 2", "test")):
            rng = np.random.default_rng([self.seed, self.n, number, 78])
            q, dq, ddq = (each[::EVERY] for each in (moves if run == "test" else waves)(self.n, rng))
            torque = np.array([pin.rnea(model, data, *row).copy() for row in zip(q, dq, ddq, strict=True)])
            rubbing = Arm(self.arm.rows, self.arm.bodies, self.arm.dry, self.viscous, self.arm.rotor)
            torque += rubbing.friction((q, dq, ddq))
            usual = np.sqrt(np.mean(torque**2, axis=0)) if usual is None else usual
            j = self.joint
            if self.kind == "cable":
                bent = np.exp(1.5 * (q[:, j] - MIDDLE[j])) - 1
                most = most or max(float(np.abs(bent).max()), 1.0)
                torque[:, j] += CABLE * usual[j] * bent / most
            if self.kind == "gain":
                torque[:, j] *= 1.05
            torque += NOISE * usual * rng.normal(size=torque.shape)
            q = np.round(q / ENCODER) * ENCODER
            content = {"run": run, "time_s": np.arange(len(q)) * EVERY / 2000}
            content |= {f"q{k + 1}_rad": q[:, k] for k in range(self.n)}
            content |= {f"tau{k + 1}_nm": torque[:, k] for k in range(self.n)}
            pieces.append(pd.DataFrame(content | ({"payload_kg": LOAD_KG} if self.load else {})))
        return pd.concat(pieces, ignore_index=True)

    def diagnosed(self) -> MotionDiagnosis:
        """What a diagnosis says that sees the stated arm and the table."""
        arm = build_moving_arm(RobotDescription.model_validate(self.arm.robot(self.stated)))
        return diagnose_motion(arm, as_motions(self.table(), "motions.csv", self.n), MotionSettings(held_out=("test",)))

    def ordinary(self, joint: int) -> dict[str, float]:
        """Friction and rotor of a joint (from 0), where neither a gain nor a name of their own is in them."""
        if joint == self.joint and self.kind in ("gain", "viscous"):
            return {}
        arm = self.arm
        return {"coulomb": arm.dry[joint], "viscous": arm.viscous[joint], "inertia": arm.rotor[joint]}


def examined(world: World, count: Counter[str]) -> str:
    """Count what a diagnosis says of a world; one line where it is not all right."""
    verdict, truth = world.diagnosed().verdict, world.truth
    named = {(each.effect, each.location) for each in verdict.effects if not (each.minor or each.nameless)}
    wanted = {(truth.name, truth.place)} if truth.name else set()
    others = {(o.effect, o.location) for each in verdict.effects for o in each.alternatives}
    count["worlds"] += 1
    count["right"] += named == wanted and not verdict.unexplained.present
    count["named"] += wanted <= named
    count["alternative"] += not wanted <= named and wanted <= others
    count["false names"] += len(named - wanted)
    count["unknown"] += verdict.unexplained.present
    missed = []
    for each in verdict.effects:
        if (each.effect, each.location) == (truth.name, truth.place):
            for parameter in each.parameters:
                if parameter.name in truth.numbers:
                    low, high = parameter.interval
                    inside = low <= truth.numbers[parameter.name] <= high
                    count["intervals"] += 1
                    count["held"] += inside
                    if not inside:
                        missed.append(f"{truth.numbers[parameter.name]:.3g} is not in {low:.3g} to {high:.3g}")
    for j, background in enumerate(verdict.background):
        for parameter in background.parameters:
            if (true := world.ordinary(j).get(parameter.name)) is not None and parameter.stderr > 0:
                count["friction"] += 1
                count["friction held"] += bool(parameter.interval[0] <= true <= parameter.interval[1])
    beyond = f"unknown {verdict.unexplained.location}" if verdict.unexplained.present else ""
    told = ", ".join([*(f"{name} {place}" for name, place in sorted(named)), *([beyond] * bool(beyond))])
    error = f"held out {100 * verdict.held_out.model:.2f} %"
    ok = named == wanted and not beyond and not missed
    where = f"{world.kind}, {world.n} joints, seed {world.seed}, {truth.place}"
    return "" if ok else f"    {where}: {told or 'nothing'}; {error}; {', '.join(missed)}"


def main() -> None:
    """See the module's docstring."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3, 4])
    parser.add_argument("--kinds", nargs="+", choices=[*KINDS], default=[*KINDS])
    asked = parser.parse_args()
    whole: Counter[str] = Counter()
    for number, kind in enumerate(asked.kinds):
        count: Counter[str] = Counter()
        for seed in asked.seeds:
            line = examined(World(kind, 3 + (number + seed) % 4, seed), count)
            if line:
                print(line, flush=True)
        print(f"{kind}: {dict(count)}", flush=True)
        whole += count
    print(f"all: {dict(whole)}")


if __name__ == "__main__":
    main()
