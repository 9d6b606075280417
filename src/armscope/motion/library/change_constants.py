"""Numbers that decide when something is said to change within a run; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class ChangeRules(Constants):
    """How a load that comes and goes is looked for."""

    cells: int = 48
    """of a run, between any two of which a load is tried first; judgement: a second or less of most runs"""
    spells: int = 24
    """of a load in a run, that are looked for cell by cell, at most; judgement: half of the cells"""
    least_rows: int = 4
    """of such a cell [rows]; judgement: fewer tell no load"""
    rounds: int = 12
    """of moments and load, at most [rounds]; judgement: two or three as a rule"""
    least_held_s: float = 0.8
    """that a load stays, or stays away [s]; judgement: no gripper takes and leaves faster"""
    usual_load: float = 0.3
    """of what the arm's links weigh, that a load is expected to be where none is stated; convention: data sheets of
    arms on a bench; 10 kg of 33 kg (UR10e), 14 of 30 (iiwa), 3 of 18 (Panda)"""
    heaviest_load: float = 1.0
    """of what the arm's links weigh, beyond which nothing is a load; judgement: no arm carries itself"""
    least_load_kg: float = 0.01
    """about which a load's inertia is formed [kg]; judgement: grams"""
    free: float = 0.3
    """of a link's mass, mass x length, by which masses are free while it is looked for; judgement: as far as masses
    without a name may be"""
    near: int = 4
    """rows either side of a moment that tell it; judgement: the low-pass reaches as far"""
    steps: int = 20
    """between rows at which a moment is tried; judgement: finer than it is known"""
    as_good_nats: float = 2.0
    """within which moments are alike [nats]; derived: 95 %"""
    pause: float = 3.0
    """rows' usual step, beyond which nothing tells when in it; judgement: a gap"""
    known: float = 0.05
    """of a single run's fitted part, with a load or without, below which its other end is held out; judgement: it would
    be unknown there"""
    told: int = 3
    """that a sentence holds [spells]; judgement: nobody reads more"""
    coarse_s: float = 0.1
    """by which a moment may be off, from which that is said [s]; judgement: the time of a pause"""


CHANGE = ChangeRules()
