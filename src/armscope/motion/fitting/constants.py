"""Numbers that decide when paths agree, and where friction has settled; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class ConsistencyRules(Constants):
    """When different paths agree on a cause."""

    telling: float = 0.5
    """standard error of a path's own size up to which it tells something [1]; judgement: half the size from all"""
    tolerance: float = 0.25
    """by which sizes may differ in any case [1]; judgement: models are a little wrong"""
    widths: float = 3.0
    """standard errors by which sizes may differ; convention: one chance in 400"""
    below: float = 2.0
    """standard errors by which what can't be negative may be below zero; convention: one chance in 40"""
    cancelled: float = 0.5
    """of the lesser of two torques that is left of both, where they cancel; judgement: most of it is gone"""
    judged: int = 6
    """times that names are judged and weighed anew, at most [times]; judgement: time"""


@dataclass(frozen=True)
class SettledRules(Constants):
    """Where friction of a joint has long changed sides."""

    seconds: float = 0.1
    """since a joint turned back, and until it does [s]; judgement: friction that clings does so for 10 to 20 ms, the
    low-pass of rows for 20 to 80 more"""
    way: float = 0.01
    """of a joint's travel that it must be from there, too [1]; judgement: some milliradians of presliding, of a
    radian"""


CONSISTENCY = ConsistencyRules()
SETTLED = SettledRules()
