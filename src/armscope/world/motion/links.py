"""Links with encoders of their own: where each lies beside its motor, and what else it could be.

The motor's encoder gives the angle of the motion; the link's gives that, less what gear, belt and shaft leave behind.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.signal import lfilter

from armscope.core.types import Array, Indices
from armscope.robot.description import RobotDescription
from armscope.world.kinds import joints
from armscope.world.motion.kinds import Kind, loaded_joints
from armscope.world.motion.recording import ENCODER_STEPS
from armscope.world.motion.session import GRID_HZ, Session
from armscope.world.motion.stage import Numbers, PlainArm, Stage
from armscope.world.rivals import Rival

NOISE_RAD = 2e-5  # Of link less motor, as encoders of some arc seconds have it
ZERO_RAD = 1e-3  # Spread of the difference of two encoders' zeros
ACROSS_S = 0.005  # In which a link goes from one end of its play to the other, to about a third
WAVES = (1, 2)  # Per turn: a disc off its centre, an oval or tilted one


def read_links(session: Session, rows: Indices, beside: Array, rng: np.random.Generator) -> tuple[Array, Array]:
    """What the links' encoders say.

    Args:
        session: the motion on the fine grid.
        rows: (N,) which of its samples are recorded.
        beside: (T, n) rad by which links lie beside their motors.
        rng: of zeros and noise.

    Returns:
        (N, n) rad, in the encoder's steps, and (n,) rad, their zeros beside the motors'.
    """
    zeros, step = ZERO_RAD * rng.normal(size=beside.shape[1]), 2 * np.pi / ENCODER_STEPS
    read = session.angle[rows] + beside[rows] + zeros + NOISE_RAD * rng.normal(size=(len(rows), beside.shape[1]))
    return np.asarray((np.round(read / step) * step).round(8)), np.asarray(zeros)


def _at_either_end(stage: Stage, joint: int, numbers: Numbers) -> Array:
    """The link lies where its torque pushes it, and takes some milliseconds to get there."""
    pushed, kept = -np.sign(stage.load[:, joint]), np.exp(-1 / (ACROSS_S * GRID_HZ))
    found = np.empty_like(pushed)
    for run in stage.session.runs():
        found[run] = lfilter([1 - kept], [1.0, -kept], pushed[run], zi=kept * pushed[run][:1])[0]
    return numbers["half"] * found


def _earlier(stage: Stage, joint: int, numbers: Numbers) -> Array:
    """Where the link was when its encoder was read."""
    angle = stage.session.angle[:, joint]
    found = np.empty_like(angle)
    for run in stage.session.runs():
        time = np.arange(run.stop - run.start) / GRID_HZ
        found[run] = np.interp(time - numbers["lag"], time, angle[run]) - angle[run]
    return found


def _wave(stage: Stage, joint: int, numbers: Numbers) -> Array:
    turned = numbers["per_turn"] * stage.session.angle[:, joint]
    return numbers["sine"] * np.sin(turned) + numbers["cosine"] * np.cos(turned)


def _some_wave(rng: np.random.Generator, _: RobotDescription) -> dict[str, float]:
    phase = rng.uniform(-np.pi, np.pi)
    return {"sine": float(np.sin(phase)), "cosine": float(np.cos(phase)), "per_turn": float(rng.choice(WAVES))}


LINKED: tuple[Kind, ...] = (
    Kind("joint_elasticity", loaded_joints, lambda rng, _: {"compliance": 1.0}, {"compliance": "rad/(N m)"},
         ("compliance",), {}, pulls=Stage.behind_its_drive, lies=lambda stage, j, x: stage.wound_up(j, x)[0][:, j],
         driver="load", possible=PlainArm.holds_its_link),
    Kind("joint_play", loaded_joints, lambda rng, _: {"half": 1.0}, {"half": "rad"}, ("half",), {"half": 0.01},
         lies=_at_either_end, driver="direction of the load"),
    Kind("gear_ratio", joints, lambda rng, _: {"share": float(rng.choice([-1.0, 1.0]))}, {"share": ""}, ("share",),
         {"share": 0.02}, lies=lambda stage, j, x: x["share"] * stage.session.angle[:, j], driver="joint angle"),
    Kind("encoder_wave", joints, _some_wave, {"sine": "rad", "cosine": "rad", "per_turn": ""}, ("sine", "cosine"),
         {"sine": 0.01, "cosine": 0.01}, lies=_wave, driver="joint angle"),
    Kind("encoder_lag", joints, lambda rng, _: {"lag": 1.0}, {"lag": "s"}, ("lag",), {"lag": 0.02}, lies=_earlier),
)  # fmt: skip


def link_rivals(stage: Stage, j: int) -> Iterator[Rival]:
    """Every cause of a link beside its motor at one joint, as patterns (N, k). ``j``: the joint, from 0."""
    place, load, angle = f"joint {j + 1}", stage.load[:, [j]], stage.session.angle[:, [j]]
    yield Rival("joint_elasticity", place, -load)
    yield Rival("joint_play", place, -np.sign(load))
    yield Rival("gear_ratio", place, angle)
    yield Rival("encoder_lag", place, -stage.session.speed[:, [j]])
    for count in WAVES:
        yield Rival("encoder_wave", place, np.hstack([np.sin(count * angle), np.cos(count * angle)]))
