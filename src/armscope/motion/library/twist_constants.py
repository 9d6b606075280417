"""Numbers that decide what is told of links beside their motors; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class TwistRules(Constants):
    """Where links lie whose positions are recorded beside their motors'."""

    ends: float = 0.02
    """of a joint's torque, within which a play goes from one end to the other [RMS of the torque]; judgement: below
    what masses and friction leave of a torque"""
    least_share: float = 1e-4
    """of its spread that the noise of a position is at least; derived: as of torques, six digits of a table"""
    waves: tuple[int, ...] = (1, 2)
    """per turn; derived: a disc off its centre gives one, an oval or tilted one two"""
    changes: float = 0.05
    """of its own size that a joint's torque must change by for a drive that winds up to be told from a zero; judgement:
    masses are known no better"""
    least_rows: int = 200
    """of a joint [rows]; judgement: fewer tell nothing of noise that lasts"""
    rounds: int = 4
    """of noise and selection, at most [rounds]; judgement: names rest after two"""
    steps: int = 2
    """in which a link's place and its torque are found from one another [steps]; derived: each takes up one more power
    of (frequency of the motion / that of the link on its drive)^2"""


TWIST = TwistRules()
