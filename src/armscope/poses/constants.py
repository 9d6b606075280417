"""Numbers that decide which poses are possible and which are chosen; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.constants import Constants, constant


@dataclass(frozen=True)
class BodyRules(Constants):
    """What an arm's body is taken for, and when a pose hits something or hides the tool."""

    radius: float = constant(
        0.04,
        "of a link as a share of the arm's reach, where there are no collision shapes",
        "judgement: 100 mm for a reach of 2.5 m",
    )
    nearest: float = constant(
        0.5,
        "share of the widest gap between two pieces in any pose within which they count as touching at the latest",
        "measured: none of 2000 poses within the stated limits of the six-axis arm is then refused, at 0.75 12 %",
    )
    clear_of_tool: float = constant(
        2.0,
        "from the tool point, at which the line of sight starts",
        "judgement: nearer by is the reflector's holder",
        unit="radii",
    )
    probes: int = constant(
        200,
        "poses over the whole ranges that say how far pieces come apart, and which never move",
        "judgement: the widest of so many gaps is close to the widest of all",
        unit="poses",
    )
    unstated_rad: float = constant(
        np.pi,
        "to which a motor without stated limits turns, either way",
        "judgement: a turn in all shows everything",
        unit="rad",
    )
    still_m: float = constant(
        1e-9,
        "motion of a piece's end over the probes below which it never moves",
        "derived: far above rounding",
        unit="m",
    )
    point_m: float = constant(
        1e-6,
        "length of a piece of the centre line below which it is a point",
        "derived: far below any length",
        unit="m",
    )
    no_length_m2: float = constant(
        1e-18, "square of a piece's length below which it is a point", "derived: far below any length", unit="m2"
    )
    parallel: float = constant(
        1e-12,
        "square of the sine between two pieces below which they are parallel",
        "derived: some thousand times rounding",
    )


@dataclass(frozen=True)
class CandidateRules(Constants):
    """How possible poses are drawn, and laid out as a grid."""

    drawn: int = constant(
        40,
        "for each candidate wanted, at most",
        "judgement: where fewer than one in forty is possible, the surroundings are wrong",
        unit="poses",
    )
    worth_freeing: float = constant(
        0.05,
        "share of possible poses from which an option that would leave them is named",
        "derived: twice the one in forty that is asked for",
    )
    grid: int = constant(500_000, "of the finest grid, at most", "judgement: time and memory", unit="poses")
    levels: int = constant(
        3,
        "steps of a joint in the coarsest grid",
        "derived: two cannot tell a turn from a shift of the link beyond",
        unit="steps",
    )
    loaded: float = constant(0.5, "share of the poses that carry the payload", "judgement: as many with as without")


@dataclass(frozen=True)
class ChoosingRules(Constants):
    """How poses are chosen of the candidates, and compared with others."""

    candidates: int = constant(
        5000, "possible poses to choose from, where none are asked for", "judgement: time", unit="poses"
    )
    starts: int = constant(3, "of the search, the best of which is taken", "judgement: time")
    independent: float = constant(
        1e-3,
        "share of a parameter's displacement that must be beyond what others imitate, for it to be told apart",
        "judgement: of a millimetre a micrometre, and no instrument sees less",
    )
    size_m: float = constant(
        1e-3,
        "RMS at the tool over the candidates that a unit of each parameter makes",
        "convention: so that parameters compare",
        unit="m",
    )
    unmoved_m: float = constant(
        1e-12, "RMS of the tool by a unit of a parameter below which it moves nothing", "derived: rounding", unit="m"
    )
    exchanges: int = constant(
        20, "rounds of shortening the way for each pose", "judgement: more than it takes", unit="rounds"
    )
    shorter_rad: float = constant(
        1e-9, "by which the way must become shorter, or the rounds end", "derived: far above rounding", unit="rad"
    )
    noise_mm: float = constant(
        0.05,
        "noise of points where neither an option nor robot.yaml states one, 1-sigma per axis",
        "judgement: tracker and repeatability of a good industrial arm together",
        unit="mm",
    )
    held_out: int = constant(
        300,
        "possible poses of another sequence at which a fitted arm is asked",
        "judgement: an RMS is then known to a few per cent",
        unit="poses",
    )
    steps: int = constant(
        4,
        "of Gauss-Newton in its fit",
        "derived: errors of a millimetre leave less than a nanometre after three",
        unit="steps",
    )


UP = np.array([0.0, 0.0, 1.0])
"""Of the base frame of an arm that stands."""

BODY, DRAWING, CHOOSING = BodyRules(), CandidateRules(), ChoosingRules()
