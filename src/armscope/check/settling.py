"""Angles and points that were not taken at one moment: the arm had not come to rest from its last motion.

What is still to come of a motion is in proportion to it, so it shows in the order of the rows. Play and friction leave
a joint behind as well, but by its side alone, however far it moved.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.calibration.geometry import State
from armscope.check.plain_constants import SETTLING
from armscope.check.plain_errors import FittedTurns, PlainErrors
from armscope.check.suspicion import SETTLED, Suspicion
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array, Indices
from armscope.core.words import enumerated, rounded
from armscope.measurement.noise import known_noise
from armscope.recordings import Recordings
from armscope.recordings.motion import last_moves
from armscope.robot import Arm


def not_at_rest(arm: Arm, recordings: Recordings, state: State) -> list[Suspicion]:
    """Joints of which a part of the last motion was still to come when their angles, or the point, were read.

    Args:
        arm: the nominal arm.
        recordings: all rows.
        state: base and tool as fitted to them.

    Returns:
        One suspicion, or none; a problem where it is most of what a plain arm leaves.
    """
    at = spread_evenly(len(recordings), SETTLING.rows)
    moved = last_moves(recordings)[at]
    known = np.isfinite(moved).all(axis=1)
    at, moved = at[known], moved[known]
    motors = np.flatnonzero(np.std(moved, axis=0) > SETTLING.moves_rad) if len(at) else np.empty(0, dtype=np.intp)
    if not len(motors):
        return []
    plain, moved = PlainErrors(arm, recordings.rows(at), state), moved[:, motors]
    found, by_side = plain.with_turns(motors, moved), plain.with_turns(motors, np.sign(moved))
    if found is None or (by_side is not None and _nats(by_side.left, found.left, found.free) < SETTLING.nats):
        return []
    clear = np.abs(found.values) > SETTLING.standard_errors * found.stderrs
    if not clear.any():
        return []
    shares = dict(zip((motors[clear] + 1).tolist(), found.values[clear].tolist(), strict=True))
    share = 1 - found.left / found.before
    if _follows_otherwise(plain, recordings.motor_angles[at], moved, motors, clear, found) or (
        np.sqrt(found.left) > SETTLING.times_noise * _noise(arm, recordings) > 0
    ):
        return [_told_with_its_share(shares, share)]
    return [_told(shares, share > 1 - SETTLING.most)]


def _noise(arm: Arm, recordings: Recordings) -> float:
    """What is known of the noise per axis, as stated or by repeats, m; 0 for nothing."""
    known = known_noise(arm, recordings)
    return 1e-3 * max(known.stated_mm, known.least_mm, known.repeated_mm)


def _follows_otherwise(
    plain: PlainErrors, angles: Array, moved: Array, motors: Indices, clear: NDArray[np.bool_], found: FittedTurns
) -> bool:
    """Whether what is left follows the last motion, or where the joint came from, in other ways besides.

    A share of it that is still to come leaves nothing else. Hysteresis does: it follows the last change of the load,
    which goes with the motion, and is full after a short one.
    """
    of, came_from = motors[clear], angles[:, motors[clear]] - moved[:, clear]
    by = [np.sign(moved[:, clear]), moved[:, clear] * np.abs(moved[:, clear]), np.cos(came_from), np.sin(came_from)]
    rich = plain.with_turns(np.concatenate([motors, *[of] * len(by)]), np.hstack([moved, *by]))
    paid = 0.5 * len(of) * len(by) * np.log(3 * len(moved))
    return rich is not None and _nats(found.left, rich.left, rich.free) - paid > SETTLING.nats


def _nats(more: float, less: float, free: int) -> float:
    return 0.5 * free * float(np.log(more / max(less, np.finfo(float).tiny)))


def _each(shares: dict[int, float]) -> str:
    return enumerated([f"joint {motor} by {rounded(100 * abs(share))} % of it" for motor, share in shares.items()])


def _told_with_its_share(shares: dict[int, float], share: float) -> Suspicion:
    """A law that does much and leaves far more than noise: another one may be behind it."""
    return Suspicion(
        "hint",
        f"what is left follows the motion from the row before ({_each(shares)}): {100 * share:.0f} % of what a plain "
        "arm leaves (mean square), and the rest follows it otherwise or is more than noise",
        "Hysteresis, play, or an arm that had not come to rest? Measure a few poses twice, at once and after some "
        "seconds, and from either side: what goes with the pause was not at rest.",
        SETTLED,
    )


def _told(shares: dict[int, float], most: bool) -> Suspicion:
    early = sum(shares.values()) > 0
    first = "angles were read before the arm had come to rest, and its points later"
    if not early:
        first = "points were measured before the arm had come to rest at its angles"
    return Suspicion(
        "problem" if most else "hint",
        f"{first}: what is left follows the motion from the row before ({_each(shares)})",
        "Let the arm come to rest before either is read, and measure again; or "
        + (
            "add that share of the motion to each angle." if early else "take that share of the motion from each angle."
        ),
        SETTLED,
    )
