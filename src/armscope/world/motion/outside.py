"""Physics that no library of causes holds: what an honest diagnosis can only call unknown, at the right joint."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.world.kinds import joints
from armscope.world.motion.kinds import Kind
from armscope.world.motion.limits import Numbers
from armscope.world.motion.session import GRID_HZ, Session
from armscope.world.motion.stage import Stage, sign


def _hysteresis(stage: Stage, joint: int, numbers: Numbers) -> Array:
    """Dahl's law, the core of LuGre's (Canudas de Wit et al. 1995): friction comes back over a way, not a speed.

    dz/dt = v (1 - sign(v) z / way): z / way goes from -1 to 1 over a few times `way` after each reversal.
    """
    state = 0.0
    shares = np.empty(len(stage.session))
    steps = stage.session.speed[:, joint] / GRID_HZ / numbers["way"]
    for row, step in enumerate(steps):
        # exact over a step of constant speed
        side = np.sign(step)
        state = side + (state - side) * np.exp(-abs(step)) if step else state
        shares[row] = state
    return numbers["torque"] * shares


def _eccentric(stage: Stage, joint: int, numbers: Numbers) -> Array:
    """A gear off its centre meshes tight on one side of the turn: dry friction goes up and down once per turn."""
    turned = stage.session.angle[:, joint] - numbers["phase"]
    return numbers["torque"] * np.cos(turned) * sign(stage.session, joint)


def _play(session: Session, torque: Array, joint: int, numbers: Numbers) -> Array:
    """Torque goes through a play: what is recorded follows only once the torque has changed by its width."""
    found = np.array(torque)
    half = numbers["width"] / 2
    for run in session.runs():
        follows = torque[run.start, joint]
        for row in range(run.start, run.stop):
            follows = min(max(follows, torque[row, joint] - half), torque[row, joint] + half)
            found[row, joint] = follows
    return found


def _saturating(session: Session, torque: Array, joint: int, numbers: Numbers) -> Array:
    """A sensor that reads less and less of more: limit tanh(torque / limit); the loss grows with 1 / limit^2."""
    found = np.array(torque)
    limit = 1 / np.sqrt(numbers["per_square"])
    found[:, joint] = limit * np.tanh(torque[:, joint] / limit)
    return found


OUTSIDE: tuple[Kind, ...] = (
    Kind("unknown", joints, lambda rng, _: {"torque": 1.0, "way": float(rng.uniform(0.03, 0.1))},
         {"torque": "N m", "way": "rad"}, ("torque",), {}, pulls=_hysteresis, shape="hysteresis"),
    Kind("unknown", joints, lambda rng, _: {"width": 1.0}, {"width": "N m"}, ("width",), {}, records=_play,
         driver="load", shape="torque_play"),
    Kind("unknown", joints, lambda rng, _: {"torque": 1.0, "phase": float(rng.uniform(-np.pi, np.pi))},
         {"torque": "N m", "phase": "rad"}, ("torque",), {}, pulls=_eccentric, shape="eccentric_friction"),
    Kind("unknown", joints, lambda rng, _: {"per_square": 1.0}, {"per_square": "1/(N m)^2"}, ("per_square",), {},
         records=_saturating, driver="load", shape="saturating_sensor"),
)  # fmt: skip
