"""A stand that rings is told by its line: planted by inverse dynamics of an arm on a base that is free to turn."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pinocchio as pin
import pytest

from armscope.core.types import Array
from armscope.motion.fitting.cutoff import chosen_cutoff
from armscope.motion.fitting.friction_turns import plain_rows
from armscope.motion.fitting.ringing import ringing
from armscope.motion.library.causes import Stand
from armscope.motion.pipeline import diagnose_motion
from armscope.motion.samples.timing import stretches
from armscope.recordings.motions import Motions, as_motions
from tests.motion.moving import COULOMB, ROTOR, VISCOUS, robot

RATE, HZ, DAMPING, COMPLIANCE = 250.0, 6.0, 0.06, 4e-5


def from_point_to_point(rng: np.random.Generator, moves: int) -> tuple[Array, Array, Array]:
    """Moves of half a second without a pause, of least jerk (Flash & Hogan 1985): what starts and stops shakes."""
    points, x = rng.uniform(-1, 1, (moves + 1, 3)), np.arange(125)[:, None] / 125
    way, speed = 10 * x**3 - 15 * x**4 + 6 * x**5, (30 * x**2 - 60 * x**3 + 30 * x**4) * 2
    turning, steps = (60 * x - 180 * x**2 + 120 * x**3) * 4, np.diff(points, axis=0)
    q = np.concatenate([at + way * step for at, step in zip(points, steps, strict=False)])
    return q, np.concatenate([speed * s for s in steps]), np.concatenate([turning * s for s in steps])


def on_free_base(q: Array, dq: Array, ddq: Array, compliance: float) -> Array:
    """(N, 3) torques of joints on a base that turns about x and y as a damped spring lets it."""
    arm, base = robot(), pin.Model()
    base.addJoint(0, pin.JointModelSpherical(), pin.SE3.Identity(), "base")
    base.addFrame(pin.Frame("base", 1, 0, pin.SE3.Identity(), pin.FrameType.OP_FRAME))
    model = pin.appendModel(base, arm.model, base.getFrameId("base"), pin.SE3.Identity())
    model.gravity.linear = arm.model.gravity.linear
    data, omega, level = model.createData(), 2 * np.pi * HZ, np.array([0.0, 0.0, 0.0, 1.0])
    still = np.zeros(3)
    moment = np.array(
        [
            pin.rnea(model, data, np.r_[level, row], np.r_[still, v], np.r_[still, a])[:2].copy()
            for row, v, a in zip(q, dq, ddq, strict=True)
        ]
    )
    push, fine = -compliance * (moment - moment.mean(axis=0)), 20
    turned, speed, torque = push[0].copy(), np.zeros(2), np.empty_like(q)
    for row in range(len(q)):
        after = push[min(row + 1, len(q) - 1)]
        acceleration = omega**2 * (push[row] - turned) - 2 * DAMPING * omega * speed
        pose = np.r_[pin.Quaternion(pin.exp3(np.r_[turned, 0.0])).coeffs(), q[row]]
        moved = np.r_[speed, 0.0, dq[row]], np.r_[acceleration, 0.0, ddq[row]]
        torque[row] = pin.rnea(model, data, pose, *moved)[3:]
        for k in range(fine):
            now = push[row] + (after - push[row]) * k / fine
            speed = speed + (omega**2 * (now - turned) - 2 * DAMPING * omega * speed) / RATE / fine
            turned = turned + speed / RATE / fine
    return torque


def shaken(compliance: float) -> Motions:
    rng, pieces = np.random.default_rng(8), []
    for run in range(2):
        q, dq, ddq = from_point_to_point(rng, 30)
        torque = on_free_base(q, dq, ddq, compliance) + COULOMB * np.sign(dq) + VISCOUS * dq + ROTOR * ddq
        torque = torque + 0.02 * torque.std(axis=0) * rng.normal(size=torque.shape)
        columns = {"run": f"path {run + 1}", "time_s": np.arange(len(q)) / RATE}
        columns |= {f"q{j + 1}_rad": q[:, j] + 1e-5 * rng.normal(size=len(q)) for j in range(3)}
        pieces.append(pd.DataFrame(columns | {f"tau{j + 1}_nm": torque[:, j] for j in range(3)}))
    return as_motions(pd.concat(pieces, ignore_index=True), "motions.csv", 3)


def seen(motions: Motions) -> Stand | None:
    arm, every = robot(), list(stretches(motions))
    how = chosen_cutoff(arm, every, None)[0]
    return ringing(plain_rows(arm, every, how), how)


def test_frequency_and_damping_of_a_planted_stand_are_seen() -> None:
    stand = seen(shaken(COMPLIANCE))
    assert stand is not None
    assert stand.hz == pytest.approx(HZ, rel=0.02)
    assert stand.damping == pytest.approx(DAMPING, rel=0.4)


def test_the_same_motion_on_a_floor_rings_nowhere() -> None:
    assert seen(shaken(0.0)) is None


def test_a_planted_stand_is_named_with_its_compliance_and_no_drive_beside_it() -> None:
    verdict = diagnose_motion(robot(), shaken(COMPLIANCE)).verdict
    (found,) = [each for each in verdict.effects if not each.minor]
    assert (found.effect, found.location) == ("rocking_base", "base")
    numbers = {each.name: each.value for each in found.parameters}
    assert numbers["about_y"] == pytest.approx(COMPLIANCE, rel=0.1)
    assert "rings at 6" in verdict.headline
