"""What the measured target does on the tool under its own weight: it falls about in its nest, or its holder bends.

No joint moves, but readings follow how the tool stands to gravity. A shift that is the same along all axes of the tool
is a constant one, which the base takes up: so a holder's sag is told against the tool's z. Shifts are taken as the
nominal tool stands: by the arm's own errors they turn by next to nothing, and else a zero of the last joint, which
nothing but a shift on the tool shows, would stand for a direction that is not quite right.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Literal

import numpy as np

from armscope.core.types import Array
from armscope.physics.clause import Told, clear_ones
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import Cure, Direction, Driver, Effect, Placed, Product, Term, term
from armscope.physics.form_constants import FORM
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm

Way = Literal["along", "across"]
"""How a target has play: along a direction of the tool, as a slide, or in the plane across it, as a pin in a hole."""
ATTITUDE = "how the tool stands to gravity"
"""What both follow, in words."""
ANYHOW = "turned"
"""The variant of a holder that is softest along no axis of the tool."""


def tool_turns_over(arm: Arm, recordings: Recordings) -> bool:
    """Whether a weight pulls along other axes of the tool in some rows than in others."""
    if not np.linalg.norm(arm.gravity):
        return False
    scene = Scene(arm, recordings)
    pulls = np.stack([scene.driver(Driver("pull on the target", (axis,))) for axis in range(3)])
    return bool(np.std(pulls, axis=1).max() > FORM.varying_load)


def nest(way: Way, direction: Array, slope: float = FORM.nest_slopes[0], multiplicity: int = 1) -> Placed:
    """A target that lies on the lower side of its nest.

    Args:
        way: how it has play.
        direction: (3,) in the tool's axes, of unit length.
        slope: share of its weight that must pull that way, or it stays in the middle.
        multiplicity: how many directions and slopes compete.

    Returns:
        The effect in place.
    """
    at = tuple(round(float(each), 4) + 0.0 for each in direction)
    products = _in_base(f"side {way}", *at, slope)
    play = Term(f"play_{way}", "mm", 1e-3, products, PLAUSIBLE.loose_target_m)
    scanned = (*((axis, "", n) for axis, n in zip("xyz", at, strict=True)), ("slope", "", slope))
    variant = " ".join((way, *(f"{n:.3f}" for n in at), f"from {slope:g}"))
    return Placed(LOOSE_TARGET, "tool", (play,), (1.0,), ATTITUDE, scanned, multiplicity, variant)


@functools.cache
def nests_anyhow() -> dict[Way, tuple[Placed, ...]]:
    """Nests in directions that are spread evenly over half a sphere (Fibonacci's lattice)."""
    count = round(2 * np.pi / np.radians(FORM.nest_step_deg) ** 2)
    n = np.arange(count)
    z, turn = (n + 0.5) / count, n * np.pi * (3 - np.sqrt(5))
    level = np.sqrt(1 - z**2)
    directions = np.stack([level * np.cos(turn), level * np.sin(turn), z], axis=1)
    ways: tuple[Way, ...] = ("along", "across")
    tried = count * len(FORM.nest_slopes)
    return {way: tuple(nest(way, each, multiplicity=tried) for each in directions) for way in ways}


def nests_about(placed: Placed, tilt_deg: float) -> tuple[Placed, ...]:
    """A nest, those whose direction is tilted against its own to eight sides, and those with other slopes.

    Args:
        placed: the nest.
        tilt_deg: by how much.

    Returns:
        All of them, itself first.
    """
    *at, slope = (value for _, _, value in placed.scanned)
    way: Way = "along" if placed.terms[0].name == "play_along" else "across"
    middle, turns, tilt = np.array(at), np.arange(8) * np.pi / 4, np.radians(tilt_deg)
    sides = np.column_stack([np.cos(turns), np.sin(turns)]) @ np.linalg.svd(middle[None])[2][1:]
    tilted = [(each, slope) for each in middle * np.cos(tilt) + sides * np.sin(tilt)]
    steeper = [(middle, each) for each in FORM.nest_slopes if each != slope]
    return (placed, *(nest(way, direction, of, placed.multiplicity) for direction, of in (*tilted, *steeper)))


def _place_nests(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    """Along the tool's axes and across them; others are scanned by the diagnosis."""
    if tool_turns_over(arm, recordings):
        for axis in np.eye(3):
            yield nest("along", axis)
            yield nest("across", axis)


def _sag(name: str, one: int, other: int) -> Term:
    """Along an axis by the share of weight along another one, and the other way round: what is elastic is symmetric."""
    return term(f"sag_{name}", "mm", *_in_base("sag", one, other), si=1e-3, plausible=PLAUSIBLE.loose_target_m)


def _in_base(kind: str, *arguments: float) -> tuple[Product, ...]:
    """A shift along all axes of the base."""
    axes = enumerate(("tx", "ty", "tz"))
    return tuple(Product(Direction("base", axis), Driver(kind, (n, *arguments))) for n, axis in axes)


def _place_holder(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    if tool_turns_over(arm, recordings):
        along = (_sag("x", 1, 1), _sag("y", 2, 2))
        turned = (_sag("xy", 1, 2), _sag("xz", 1, 3), _sag("yz", 2, 3))
        yield Placed(HOLDER_SAG, "tool", along, (1.0,) * 2, ATTITUDE, partly_unseen=True)
        yield Placed(HOLDER_SAG, "tool", (*along, *turned), (1.0,) * 5, ATTITUDE, variant=ANYHOW, partly_unseen=True)


def _falls(told: Told) -> str:
    way = "along" if "play_along" in told.numbers else "across"
    x, y, z = (told.numbers[axis].value for axis in "xyz")
    named = [axis for axis, part in zip("xyz", (x, y, z), strict=True) if abs(part) > FORM.along_an_axis]
    where = f"the tool's {named[0]}" if named else f"({x:.2f}, {y:.2f}, {z:.2f}) in the tool's axes".replace("-", "−")
    return (
        f"the target is loose on the tool: it falls by {told.numbers[f'play_{way}']} {way} {where}, to its lower side"
    )


def _bends(told: Told) -> str:
    """How much more it gives way one way than another, whichever way these are."""
    x, y, xy, xz, yz = (told.numbers[f"sag_{name}"] for name in ("x", "y", "xy", "xz", "yz"))
    give = np.linalg.eigvalsh([[x.value, xy.value, xz.value], [xy.value, y.value, yz.value], [xz.value, yz.value, 0.0]])
    most = type(x)(float(give[-1] - give[0]), x.unit)
    return f"what holds the target bends under its own weight, by {most} more one way than another"


LOOSE_TARGET = Effect(
    "loose_target",
    "instrument",
    _place_nests,
    "The target has play on the tool and lies on the lower side of its nest, so it falls over when the tool turns.",
    "Turn the tool over, hold the target and feel; or measure one pose with the target pushed to either side.",
    Cure(
        "Fix the target firmly on the tool and measure again: the arm is not at fault.",
        otherwise="Until then the corrected model's inverse kinematics brings the target where it was meant to go "
        "(`armscope compensate`); commands in the arm's own base leave it out.",
        change="target",
        instruction="Fix the target (nest, magnet, adapter) firmly on the tool, and measure again.",
    ),
    clauses=(_falls, "the target is loose on the tool"),
    labels={"play_along": "to the lower side", "play_across": "to the lower side"}
    | {axis: f"{axis} of that direction, in the tool's axes" for axis in "xyz"}
    | {"slope": "from a slope of"},
    atlas="gravity load",
    nonnegative=True,
)

HOLDER_SAG = Effect(
    "holder_sag",
    "instrument",
    _place_holder,
    "What holds the target bends under its own weight: more one way than another, by so much.",
    "Push the target by hand along the tool's x, y and z, and watch its reading.",
    Cure(
        "Stiffen what holds the target, or use a lighter target, and measure again.",
        otherwise="Where it is the tool itself that bends, let the corrected model's inverse kinematics compute the "
        "commands (tool moved by + sag x the share of gravity along that axis; `armscope compensate`).",
        change="target",
        instruction="Stiffen what holds the target on the tool, and measure again.",
    ),
    clauses=(
        _bends,
        clear_ones(
            "what holds the target bends under its own weight, {}", sag_x="along the tool's x", sag_y="along its y"
        ),
        "what holds the target on the tool bends under its own weight",
    ),
    labels={f"sag_{axis}": f"along {axis} more than along z" for axis in "xy"}
    | {f"sag_{a}{b}": f"along {a} by weight along {b}, and the other way round" for a, b in ("xy", "xz", "yz")},
    atlas="gravity load",
)

EFFECTS = [LOOSE_TARGET, HOLDER_SAG]
