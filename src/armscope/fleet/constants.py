"""Numbers that decide what a fleet's page tells, and what a simulated fleet is; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class FleetRules(Constants):
    """Which arm is unlike its type, and what repeats in a type."""

    outlier: float = 4.0
    """from the median of its type, beyond which an arm is an outlier [robust standard deviations]; derived: one in
    16,000 by chance"""
    fewest_arms: int = 5
    """of a type, from which an outlier can be told [arms]; judgement: the scatter of fewer is hardly known"""
    common: float = 0.3
    """expected share of a type's arms from which a cause is said to repeat; judgement: one in three, nearly"""
    least_mm: float = 1e-6
    """residual below which all are alike [mm]; derived: far below any instrument"""
    least_spread: float = 0.05
    """robust standard deviation of a type's logarithms, at least; judgement: by 5 % arms differ that are alike"""


@dataclass(frozen=True)
class SimulatedFleet(Constants):
    """What the arms of a simulated fleet have; all of it is made up."""

    usual: float = 0.7
    """share of the arms that have their type's weakness; judgement: most, not all"""
    rows: int = 120
    """recorded of each [rows]; judgement: a common calibration; time"""
    few: tuple[float, float] = (2.0, 5.0)
    """times the noise, between which the error that any arm may have is drawn; judgement: well seen"""
    weakness: tuple[float, float] = (3.0, 8.0)
    """the same of its type's weakness; judgement: the larger of the two, usually"""
    unlike: float = 10.0
    """times the others', the last arm's errors; judgement: an outlier that anybody would see"""


FLEET, SIMULATED = FleetRules(), SimulatedFleet()
