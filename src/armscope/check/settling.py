"""Angles and points that were not taken at one moment: the arm had not come to rest from its last motion.

What is still to come of a motion is in proportion to it, so it shows in the order of the rows. Play and friction leave
a joint behind as well, but by its side alone, however far it moved.
"""

from __future__ import annotations

import numpy as np

from armscope.calibration.state import State
from armscope.check.plain_constants import SETTLING
from armscope.check.plain_errors import PlainErrors
from armscope.check.suspicion import SETTLED, Suspicion
from armscope.core.numerals import rounded
from armscope.core.sampling import spread_evenly
from armscope.core.words import enumerated
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
    most = found.left < SETTLING.most * found.before
    return [_told(shares, most)]


def _nats(more: float, less: float, free: int) -> float:
    return 0.5 * free * float(np.log(more / max(less, np.finfo(float).tiny)))


def _told(shares: dict[int, float], most: bool) -> Suspicion:
    early = sum(shares.values()) > 0
    first = "angles were read before the arm had come to rest, and its points later"
    if not early:
        first = "points were measured before the arm had come to rest at its angles"
    told = enumerated([f"joint {motor} by {rounded(100 * abs(share))} % of it" for motor, share in shares.items()])
    return Suspicion(
        "problem" if most else "hint",
        f"{first}: what is left follows the motion from the row before ({told})",
        "Let the arm come to rest before either is read, and measure again; or "
        + (
            "add that share of the motion to each angle." if early else "take that share of the motion from each angle."
        ),
        SETTLED,
    )
