"""Numbers that decide when currents tell gains; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class UnstatedGainRules(Constants):
    """When currents tell torque constants that nobody states."""

    step_s: float = 0.05
    """over which positions are differenced to see gains [s]; judgement: size shows, noise does not"""
    rows: int = 20
    """fewest such samples of a run [samples]; judgement: fewer tell nothing"""
    samples: int = 2000
    """in which gains are seen [samples]; judgement: more change no digit"""
    told: float = 0.8
    """share of a current, beyond friction and rotor, that masses must explain for a gain to be asked for; measured: on
    a UR10e, against its source's gains: motors 2 and 3, with 0.96, are 3 and 11 % off, motor 4, with 0.63, is 29 %
    off"""


GAINS = UnstatedGainRules()
