"""Numbers that decide which poses are possible and which are chosen; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.constants import Constants


@dataclass(frozen=True)
class BodyRules(Constants):
    """What an arm's body is taken for, and when a pose hits something or hides the tool."""

    radius: float = 0.04
    """of a link as a share of the arm's reach, where there are no collision shapes; judgement: 100 mm for a reach of
    2.5 m"""
    nearest: float = 0.5
    """share of the widest gap between two pieces in any pose within which they count as touching at the latest;
    measured: none of 2000 poses within the stated limits of the six-axis arm is then refused, at 0.75 12 %"""
    clear_of_tool: float = 2.0
    """from the tool point, at which the line of sight starts [radii]; judgement: nearer by is the reflector's holder"""
    probes: int = 200
    """poses over the whole ranges that say how far pieces come apart, and which never move [poses]; judgement: the
    widest of so many gaps is close to the widest of all"""
    unstated_rad: float = np.pi
    """to which a motor without stated limits turns, either way [rad]; judgement: a turn in all shows everything"""
    still_m: float = 1e-9
    """motion of a piece's end over the probes below which it never moves [m]; derived: far above rounding"""
    point_m: float = 1e-6
    """length of a piece of the centre line below which it is a point [m]; derived: far below any length"""
    no_length_m2: float = 1e-18
    """square of a piece's length below which it is a point [m2]; derived: far below any length"""
    parallel: float = 1e-12
    """square of the sine between two pieces below which they are parallel; derived: some thousand times rounding"""


@dataclass(frozen=True)
class CandidateRules(Constants):
    """How possible poses are drawn, and laid out as a grid."""

    drawn: int = 40
    """for each candidate wanted, at most [poses]; judgement: where fewer than one in forty is possible, the
    surroundings are wrong"""
    worth_freeing: float = 0.05
    """share of possible poses from which an option that would leave them is named; derived: twice the one in forty that
    is asked for"""
    grid: int = 500_000
    """of the finest grid, at most [poses]; judgement: time and memory"""
    levels: int = 3
    """steps of a joint in the coarsest grid [steps]; derived: two cannot tell a turn from a shift of the link beyond"""
    loaded: float = 0.5
    """share of the poses that carry the payload; judgement: as many with as without"""


@dataclass(frozen=True)
class ChoosingRules(Constants):
    """How poses are chosen of the candidates, and compared with others."""

    candidates: int = 5000
    """possible poses to choose from, where none are asked for [poses]; judgement: time"""
    starts: int = 3
    """of the search, the best of which is taken; judgement: time"""
    independent: float = 1e-3
    """share of a parameter's displacement that must be beyond what others imitate, for it to be told apart; judgement:
    of a millimetre a micrometre, and no instrument sees less"""
    size_m: float = 1e-3
    """RMS at the tool over the candidates that a unit of each parameter makes [m]; convention: so that parameters
    compare"""
    unmoved_m: float = 1e-12
    """RMS of the tool by a unit of a parameter below which it moves nothing [m]; derived: rounding"""
    exchanges: int = 20
    """rounds of shortening the way for each pose [rounds]; judgement: more than it takes"""
    shorter_rad: float = 1e-9
    """by which the way must become shorter, or the rounds end [rad]; derived: far above rounding"""
    noise_mm: float = 0.05
    """noise of points where neither an option nor robot.yaml states one, 1-sigma per axis [mm]; judgement: tracker and
    repeatability of a good industrial arm together"""
    held_out: int = 300
    """possible poses of another sequence at which a fitted arm is asked [poses]; judgement: an RMS is then known to a
    few per cent"""
    steps: int = 4
    """of Gauss-Newton in its fit [steps]; derived: errors of a millimetre leave less than a nanometre after three"""


UP = np.array([0.0, 0.0, 1.0])
"""Of the base frame of an arm that stands."""

BODY, DRAWING, CHOOSING = BodyRules(), CandidateRules(), ChoosingRules()
