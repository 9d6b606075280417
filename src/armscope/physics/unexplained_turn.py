"""A link that bows, or a joint that turns, as a joint before it turns: what no law of the library explains."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import Cure, Direction, Driver, Placed, Term, motor, term
from armscope.physics.form_constants import FORM
from armscope.physics.freeform import UNKNOWN

ELSEWHERE = "turn of"
"""How the words begin that say which other joint it follows."""


def bowing_links(moving: Sequence[int], links: int) -> list[Placed]:
    """Each link but the first turning across its next axis, once per turn of a joint before it.

    Gravity bends links with the joints before them, too. It does so by their moments, which are laws of their own and
    compete.

    Args:
        moving: motors that move, from 1.
        links: of the arm.

    Returns:
        One for each pair of link and motor; all pay for each other.
    """
    pairs = [(link, j) for link in range(2, links) for j in moving if j < link]
    return [
        _once_per_turn(f"link {link}", [Direction(f"link {link}", axis) for axis in ("rx", "ry")], j, len(pairs))
        for link, j in pairs
    ]


def led_joints(moving: Sequence[int]) -> list[Placed]:
    """Each joint turning a little, once per turn of a joint before it.

    Args:
        moving: motors that move, from 1.

    Returns:
        One for each pair of motors; all pay for each other.
    """
    pairs = [(led, j) for led in moving for j in moving if j < led]
    return [_once_per_turn(f"joint {led}", [motor(led)], j, len(pairs)) for led, j in pairs]


def _once_per_turn(location: str, about: Sequence[Direction], j: int, pairs: int) -> Placed:
    terms = tuple(each for direction in about for each in _wave_about(direction, j))
    return Placed(
        UNEXPLAINED_TURN,
        location,
        terms,
        (1.0,) * len(terms),
        f"{ELSEWHERE} joint {j}",
        variant=f"with joint {j}",
        parametrisation="sine",
        multiplicity=pairs * FORM.arms_per_unexplained_turn,
    )


def _wave_about(direction: Direction, j: int) -> tuple[Term, Term]:
    """Cosine and sine of motor angle j, as turns in one direction, rad."""
    size = PLAUSIBLE.eccentricity_rad
    name = direction.axis
    return (
        term(f"{name}_cosine", "rad", (direction, Driver("cosine", (j, 1))), plausible=size),
        term(f"{name}_sine", "rad", (direction, Driver("sine", (j, 1))), plausible=size),
    )


UNEXPLAINED_TURN = replace(
    UNKNOWN,
    physics="It turns a little with the angle of another joint, and neither gravity nor any other law of the library "
    "does that: a hose pack or cable that pulls, heat from one side, a screw that is loose.",
    confirm="Hold all other joints, turn that joint alone from end to end, and watch a dial gauge or level here; once "
    "more with hoses and cables taken off, and with the arm cold.",
    cure=Cure(
        "Find what pulls, heats or is loose here. Until then let the commands take it out: `armscope compensate` "
        "with model.yaml.",
        otherwise="No zero and no table over its own angle corrects it.",
        change="what pulls or heats it",
        instruction="Find what pulls, heats or is loose here as the other joint turns; until then compensate for it "
        "by the model (armscope compensate).",
    ),
)
"""`unknown` at a place that turns with another joint's angle; what a headline says of it is what it says of any."""
