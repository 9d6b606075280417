"""What may make a link lie elsewhere than its motor, where both are recorded: causes in words, placed at joints."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from armscope.core.types import Array
from armscope.motion.constants import LIBRARY
from armscope.motion.library import clauses, remedies, remedies_of_laws
from armscope.motion.library.causes import Cause, PlacedCause, Seen
from armscope.motion.library.laws import Law
from armscope.motion.library.twist_constants import TWIST
from armscope.verdict.effects import UNKNOWN

DRIVE, SPRINGS, SENSORS = "drive", "springs", "sensors"

ENCODER_OFFSET = Cause(
    "encoder_offset",
    SENSORS,
    "Link and motor are not counted from the same zero.",
    "Read both encoders at one position with the joint unloaded.",
    "Subtract the difference from the link's position.",
)
ELASTICITY = Cause(
    "joint_elasticity",
    SPRINGS,
    "The drive winds up under the torque that it carries: the link lags behind its motor.",
    "Hold the motor, hang known weights on the link and read both encoders: their difference grows with the torque.",
    "Give the joint of the model a spring between motor and link.",
    nonnegative=True,
    labels={"compliance": "turn per torque"},
    clause=clauses.elasticity_clause,
    remedy=remedies.spring_between,
)
JOINT_PLAY = Cause(
    "joint_play",
    DRIVE,
    "Gear, coupling or key have play: the link lies at the end to which its torque pushes it.",
    "Hold the motor, push the link gently to and fro by hand and read both encoders.",
    "Take the play out of the drive, or let the link of the model lie behind its motor, against the torque passed on.",
    nonnegative=True,
    labels={"half": "half of the play"},
    clause=clauses.play_clause,
    remedy=remedies.behind_its_motor,
)
GEAR_RATIO = Cause(
    "gear_ratio",
    DRIVE,
    "The link turns another angle than the motor's stated reduction says.",
    "Turn the joint from end to end and divide the two encoders' angles.",
    "Correct the reduction by which the motor's position is divided.",
    labels={"share": "link / motor − 1"},
    clause=clauses.ratio_clause,
    remedy=remedies.reduction,
)
ENCODER_WAVE = Cause(
    "encoder_wave",
    SENSORS,
    "An encoder's disc is off its centre or tilted, or a gear's wheel runs out: the error comes back every turn.",
    "Turn the joint slowly and unloaded from end to end, either way, and read both encoders.",
    "Take the wave from the link's position, or centre the disc.",
    clause=clauses.wave_clause,
    remedy=remedies_of_laws.waves,
)
ENCODER_LAG = Cause(
    "encoder_lag",
    SENSORS,
    "The two encoders are read at different times: their difference follows the speed.",
    "Turn the joint at two constant speeds without load: the difference grows with the speed.",
    "Shift the link's position by the lag.",
    clause=clauses.lag_clause,
    remedy=remedies.link_shifted,
)
NAMELESS = Cause(
    "unknown_twist",
    UNKNOWN,
    "The link lies beside its motor in a way that no cause of the library has.",
    "Look at its curve, and repeat the motion with only that joint moving.",
    "Use the curve where the link's position is asked for.",
    clause=clauses.nameless_twist,
)
TWISTS = (ENCODER_OFFSET, ELASTICITY, JOINT_PLAY, GEAR_RATIO, ENCODER_WAVE, ENCODER_LAG, NAMELESS)


def place_twists(seen: Seen, joint: int, torque: Array) -> tuple[PlacedCause, ...]:
    """What may stand at one joint: its zero, always there, then what competes.

    Args:
        seen: what the table shows.
        joint: from 0; its link is recorded.
        torque: (K,) through it, N m (N).

    Returns:
        The causes, with columns in rad (m).
    """
    return tuple(_placed(seen, joint, torque))


def _placed(seen: Seen, j: int, torque: Array) -> Iterator[PlacedCause]:
    unit, per = seen.unit(j), f"{seen.unit(j)}/({seen.torque(j)})"
    size = max(float(np.sqrt(np.mean(torque**2))), 1e-9)

    def cause(kind: Cause, driver: str, names: tuple[tuple[str, str], ...], *law: Any, **more: Any) -> PlacedCause:
        name, *numbers = law
        columns = Law(name, (j,), tuple(map(float, numbers)))
        return PlacedCause(kind, f"joint {j + 1}", driver, names, (j,), columns, **more)

    yield cause(ENCODER_OFFSET, "constant", (("offset", unit),), "constant")
    if float(np.std(torque)) > TWIST.changes * size:
        yield cause(ELASTICITY, "load", (("compliance", per),), "wound up")
        if np.ptp(np.sign(torque)) > 0:
            yield cause(JOINT_PLAY, "direction of the load", (("half", unit),), "at either end", TWIST.ends * size)
        widths = np.array(LIBRARY.plays) * size
        names = tuple((f"over torque {k + 1}", unit) for k in range(len(widths)))
        yield cause(NAMELESS, "torque since its last reversal", names, "clinging over torques", *widths, variant="way")
        yield _curve(cause, seen, j, "load", np.percentile(torque, [0.1, 99.9]))
    if not seen.moving[j]:
        return
    middle = float(np.mean(seen.q[j]))
    yield cause(GEAR_RATIO, "joint angle", (("share", ""),), "share of the turn", middle)
    yield cause(ENCODER_LAG, "speed", (("lag", "s"),), "read later")
    if not seen.arm.sliding[j]:
        for n in TWIST.waves:
            more: dict[str, Any] = {"variant": str(n), "scanned": (("per_turn", "", float(n)),)}
            yield cause(ENCODER_WAVE, "joint angle", (("sine", unit), ("cosine", unit)), "wave", n, **more)
    yield _curve(cause, seen, j, "joint angle", seen.q[j])
    yield _curve(cause, seen, j, "time", seen.time)


def _curve(cause: Any, seen: Seen, j: int, driver: str, limits: Array) -> PlacedCause:
    knots = LIBRARY.knots_of_time if driver == "time" else LIBRARY.knots_of_others
    names = tuple((f"knot {k + 1}", seen.unit(j)) for k in range(knots))
    law = (f"curve over {driver}", *limits, knots)
    placed: PlacedCause = cause(NAMELESS, driver, names, *law, variant=driver, is_curve=True)
    return placed


CONTAINED = {"load": (ELASTICITY, JOINT_PLAY), "joint angle": (GEAR_RATIO, ENCODER_WAVE), "time": ()}
"""What a free curve at the same joint contains, by what it follows."""


def clash(one: PlacedCause, other: PlacedCause) -> bool:
    """Whether two causes of a joint can't stand side by side."""
    if one.is_curve and other.is_curve:
        return one.driver == other.driver
    if one.is_curve or other.is_curve:
        curve, special = (one, other) if one.is_curve else (other, one)
        return special.cause in CONTAINED[curve.driver]
    return False
