"""Numbers that decide what stands out beside a plain arm's errors; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class Leading(Constants):
    """When a column of the side of approach has the wrong sign, or is another joint's."""

    standard_errors: float = 10.0
    """below zero at which play is told as one of the wrong sign; measured: of 11 simulated tables with such columns two
    had signs turned round, which were 25 and 94 below; no joint of the others was by more than 2"""
    both_sides: float = 1.5
    """between two rows' sides from which a joint is approached from both; derived: sides are -1 and +1"""
    agrees: float = 0.95
    """of rows in which a side is that of a joint's motion from the row before, from which it is that joint's;
    judgement: nearly all, some rows being measured again or out of order"""
    fewest_rows: int = 20
    """that tell both [rows]; derived: of 20 tossed coins 19 are alike for one pair of columns in 50,000"""


@dataclass(frozen=True)
class PlainFit(Constants):
    """How what joints turn by is fitted beside a plain arm's errors."""

    rank: float = 1e-9
    """share of the largest, below which a direction is rounding; judgement: far above it"""
    apart: float = 1e6
    """condition beyond which joints are not told apart; judgement: a part in a thousand of each is left"""


@dataclass(frozen=True)
class Settling(Constants):
    """When rows are told in which the arm had not come to rest."""

    rows: int = 600
    """that are looked at [rows]; judgement: what most rows show needs few; time"""
    moves_rad: float = 0.02
    """between rows (RMS), from which a joint moves [rad]; judgement: a degree"""
    standard_errors: float = 8.0
    """of a share that is told; judgement: what a plain arm does not have is in them, too"""
    nats: float = 20.0
    """by which what is left follows the motion rather than its side [nats]; judgement: play of a joint that was not
    recorded has the side"""
    times_noise: float = 3.0
    """beyond which what the law leaves is told to be more than noise; judgement: a plain arm's rest is in it"""
    most: float = 0.5
    """of what a plain arm leaves (mean square), below which it is no hint; judgement: most of it"""


LEADING = Leading()
PLAIN = PlainFit()
SETTLING = Settling()
