"""Numbers that decide what a channel's rail is; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class RailRules(Constants):
    """Where a torque ends because its drive or its channel does."""

    rings: float = 2e-3
    """of a channel's range, by which a filter behind a rail goes beyond it; judgement: a step's overshoot"""
    widths: tuple[float, ...] = (0.002, 0.005, 0.01, 0.02)
    """of a channel's range, half of which a rail with noise on it may be wide; judgement: more is no rail"""
    beyond: float = 1e-3
    """of the samples, that noise on a rail carries beyond it by more; derived: three standard deviations"""
    least_share: float = 0.01
    """of the samples that lie on a rail; judgement: fewer are turning points"""
    denser: float = 3.0
    """times as dense as just inside that samples on a rail must be; derived: a torque that turns back like a sine is
    2.4 times"""
    asked: float = 3.0
    """times what friction and masses leave elsewhere, by which they must ask for more than a rail lets through;
    convention: three standard deviations; a wrist of dry friction alone has dense ends, and asks for none"""
    described: float = 0.9
    """of a channel's spread elsewhere that these must explain; judgement: what they don't describe they can't ask
    for"""
    followed: float = 0.1
    """of what samples on a rail do that friction and masses may still describe; judgement: noise on a rail follows
    nothing"""
    step_s: float = 0.05
    """over which positions are differenced [s]; judgement: slower than noise"""
    samples: int = 3000
    """that are looked at [samples]; judgement: time"""


RAIL = RailRules()
