"""Numbers that decide of a base that rocks; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class RockingRules(Constants):
    """What stands are looked for."""

    lowest_hz: float = 2.0
    """at which a stand swings [Hz]; judgement: what swings more slowly is seen with bare eyes"""
    highest_hz: float = 30.0
    """at which a stand swings [Hz]; judgement: what is bolted to a floor swings faster"""
    step: float = 0.08
    """of a frequency, to the next that is tried; derived: the half width of a line of the damping tried first"""
    damping: float = 0.05
    """of the critical one, that is tried first; judgement: a bolted steel frame loses a few hundredths"""
    least_damping: float = 0.005
    """of the critical one; judgement: welded steel without an arm on it"""
    most_damping: float = 0.4
    """of the critical one; judgement: beyond, nothing rings, and a soft stand is a lag of the model's torque"""
    settled: float = 0.01
    """relative, of frequency and damping; judgement: a tenth of a line's width"""
    steps: int = 40
    """of the search for both, at most [steps]; judgement: it rests by then"""
    least_share: float = 0.02
    """of what friction and masses leave that a stand explains; judgement: nobody would stiffen it for less"""
    rings: float = 0.5
    """of what a stand explains that one without a resonance must leave; judgement: else any soft thing, or masses that
    are off, would be a stand"""


ROCKING = RockingRules()
