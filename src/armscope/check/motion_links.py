"""Links whose positions don't follow their motors': another unit, sign, or side of the gear."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from armscope.check.motion_constants import MOTION
from armscope.check.suspicion import Suspicion
from armscope.recordings.motions import Motions


def links_beside_motors(motions: Motions) -> Iterator[Suspicion]:
    """What is wrong with links' positions, joint by joint; the position of another joint is told as that."""
    if motions.link is None:
        return
    for j in np.flatnonzero(np.isfinite(motions.link).all(axis=0)).tolist():
        motor, link = motions.q[:, j], motions.link[:, j]
        if np.ptp(motor) < MOTION.link_travel:
            continue
        factor = float(np.polyfit(motor, link, 1)[0])
        if abs(factor - 1) <= MOTION.link_factor:
            continue
        if (other := _follows(motions, j)) is not None:
            statement = f"q{j + 1}_link is the position of joint {other + 1}, and not of joint {j + 1}"
            cure = f"Are columns shifted or exchanged? Call it q{other + 1}_link."
        else:
            statement, cure = f"q{j + 1}_link turns {factor:.4g} times as far as q{j + 1}", _guessed(factor)
        yield Suspicion("problem", statement, cure)


def _follows(motions: Motions, j: int) -> int | None:
    """The other joint that a link's position follows as its own link does, if it is one."""
    assert motions.link is not None
    for other in range(motions.n_motors):
        motor = motions.q[:, other]
        if other == j or np.ptp(motor) < MOTION.link_travel:
            continue
        factor, zero = np.polyfit(motor, motions.link[:, j], 1)
        missed = float(np.std(motions.link[:, j] - factor * motor - zero))
        if abs(factor - 1) < MOTION.link_factor and missed < MOTION.link_factor * np.std(motor):
            return other
    return None


def _guessed(factor: float) -> str:
    if abs(factor + 1) < MOTION.link_factor:
        return "It counts the other way: turn its sign."
    for unit, of in (("degrees", 180 / np.pi), ("radians", np.pi / 180)):
        if abs(factor / of - 1) < MOTION.link_factor:
            return f"It is in {unit}: call the column by that unit."
    other = "the motor's own turns" if abs(factor) < 1 else "another joint's position"
    return f"Both are positions of the joint, behind the gear; is one of them {other}?"
