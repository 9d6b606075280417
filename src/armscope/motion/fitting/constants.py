"""Numbers that decide when paths agree, and where friction has settled; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants, constant


@dataclass(frozen=True)
class ConsistencyRules(Constants):
    """When different paths agree on a cause."""

    telling: float = constant(
        0.5,
        "standard error of a path's own size up to which it tells something",
        "judgement: half the size from all",
        unit="1",
    )
    tolerance: float = constant(
        0.25, "by which sizes may differ in any case", "judgement: models are a little wrong", unit="1"
    )
    widths: float = constant(3.0, "standard errors by which sizes may differ", "convention: one chance in 400")
    below: float = constant(
        2.0, "standard errors by which what can't be negative may be below zero", "convention: one chance in 40"
    )
    cancelled: float = constant(
        0.5, "of the lesser of two torques that is left of both, where they cancel", "judgement: most of it is gone"
    )
    judged: int = constant(6, "times that names are judged and weighed anew, at most", "judgement: time", unit="times")


@dataclass(frozen=True)
class SettledRules(Constants):
    """Where friction of a joint has long changed sides."""

    seconds: float = constant(
        0.1,
        "since a joint turned back, and until it does",
        "judgement: friction that clings does so for 10 to 20 ms, the low-pass of rows for 20 to 80 more",
        unit="s",
    )
    way: float = constant(
        0.01,
        "of a joint's travel that it must be from there, too",
        "judgement: some milliradians of presliding, of a radian",
        unit="1",
    )


CONSISTENCY = ConsistencyRules()
SETTLED = SettledRules()
