"""What the measured target does on the tool under its own weight: it falls about in its nest, or its holder bends.

No joint moves, but readings follow how the tool stands to gravity. A shift that is the same along all axes of the tool
is a constant one, which the base takes up: so a holder's sag is told against the tool's z.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from armscope.physics.clause import clear_ones
from armscope.physics.constants import FORM, PLAUSIBLE
from armscope.physics.effect import Cure, Direction, Driver, Effect, Placed, Term, term
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm

NESTS = {"x": "along x", "y": "along y", "z": "along z", "xy": "across z", "yz": "across x", "xz": "across y"}
"""Where a target has play: along an axis, as a slide has it, or in a plane, as a pin in a hole."""


def tool_turns_over(arm: Arm, recordings: Recordings) -> bool:
    """Whether a weight pulls along other axes of the tool in some rows than in others."""
    if not np.linalg.norm(arm.gravity):
        return False
    scene = Scene(arm, recordings)
    pulls = np.stack([scene.driver(Driver("pull on the target", (axis,))) for axis in range(3)])
    return bool(np.std(pulls, axis=1).max() > FORM.varying_load)


def _play(axes: str) -> Term:
    """A target that lies on the lower side of its nest."""
    plane = ["xyz".index(axis) for axis in axes]
    falls = (
        (Direction("tool", f"t{axis}"), Driver("side of the nest", tuple(sorted(plane, key=lambda n: n != at))))
        for axis, at in zip(axes, plane, strict=True)
    )
    return term(f"play_{axes}", "mm", *falls, si=1e-3, plausible=PLAUSIBLE.loose_target_m)


def _place_nests(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    if tool_turns_over(arm, recordings):
        for axes in NESTS:
            yield Placed(LOOSE_TARGET, "tool", (_play(axes),), (1.0,), ATTITUDE, variant=axes)


def _place_holder(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    if tool_turns_over(arm, recordings):
        sag = tuple(
            term(
                f"sag_{axis}",
                "mm",
                (Direction("tool", f"t{axis}"), Driver("pull on the target", (n,))),
                si=1e-3,
                plausible=PLAUSIBLE.loose_target_m,
            )
            for n, axis in enumerate("xy")
        )
        yield Placed(HOLDER_SAG, "tool", sag, (1.0, 1.0), ATTITUDE, partly_unseen=True)


ATTITUDE = "how the tool stands to gravity"
"""What both follow, in words."""

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
    clauses=tuple(
        f"the target is loose on the tool: it falls by {{play_{axes}}} {where}, to its lower side"
        for axes, where in NESTS.items()
    ),
    labels={f"play_{axes}": f"to the lower side {where}" for axes, where in NESTS.items()},
    atlas="gravity load",
    nonnegative=True,
)

HOLDER_SAG = Effect(
    "holder_sag",
    "instrument",
    _place_holder,
    "What holds the target bends under its own weight: more along the tool's x and y than along its z, by so much.",
    "Push the target by hand with the target's weight along x, y and z, and watch its reading.",
    Cure(
        "Stiffen what holds the target, or use a lighter target, and measure again.",
        otherwise="Where it is the tool itself that bends, let the corrected model's inverse kinematics compute the "
        "commands (tool moved by + sag x the share of gravity along that axis; `armscope compensate`).",
        change="target",
        instruction="Stiffen what holds the target on the tool, and measure again.",
    ),
    clauses=(
        clear_ones(
            "what holds the target bends under its own weight, {}", sag_x="along the tool's x", sag_y="along its y"
        ),
        "what holds the target on the tool bends under its own weight",
    ),
    labels={f"sag_{axis}": f"along {axis} more than along z" for axis in "xy"},
    atlas="gravity load",
)

EFFECTS = [LOOSE_TARGET, HOLDER_SAG]
