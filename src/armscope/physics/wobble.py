"""Axes that wobble: a bearing's axis that leans round, about a point that need not be the origin of the joint's row."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from armscope.physics.clause import swings, waves_column
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import Cure, Direction, Driver, Effect, Placed, Term, term
from armscope.recordings import Recordings
from armscope.recordings.motion import moving
from armscope.robot import Arm

RUNS_OUT = "runs out"
"""The variant of an axis that moves across as well: it leans about a point elsewhere, or its bearing runs out."""


def _place_wobbles(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    for j in np.flatnonzero(moving(recordings.motor_angles @ arm.actuation.T)) + 1:
        for per_turn in (1, 2):
            tilts = _waves(int(j), per_turn, ("rx", "ry"), "rad", PLAUSIBLE.wobble_rad)
            shifts = _waves(int(j), per_turn, ("tx", "ty"), "m", PLAUSIBLE.run_out_m)
            yield _placed(int(j), per_turn, tilts, str(per_turn))
            yield _placed(int(j), per_turn, (*tilts, *shifts), f"{per_turn} {RUNS_OUT}")


def about_their_origins(arm: Arm, recordings: Recordings) -> list[Placed]:
    """Wobbles of axes about the origins of their rows: a tilt and nothing else."""
    return [placed for placed in _place_wobbles(arm, recordings) if not placed.variant.endswith(RUNS_OUT)]


def _waves(j: int, per_turn: int, axes: tuple[str, str], unit: str, plausible: float) -> tuple[Term, ...]:
    """What follows a joint's angle about or along two axes across its own."""
    return tuple(
        term(
            f"{wave}_{axis}",
            unit,
            (Direction(f"joint {j}", axis), Driver(f"chain {wave}", (j, per_turn))),
            plausible=plausible,
        )
        for axis in axes
        for wave in ("cosine", "sine")
    )


def _placed(j: int, per_turn: int, terms: tuple[Term, ...], variant: str) -> Placed:
    return Placed(
        AXIS_WOBBLE,
        f"joint {j}",
        terms,
        (1.0,) * len(terms),
        f"angle of joint {j}",
        scanned=(("per_turn", "1/turn", per_turn),),
        multiplicity=2,
        variant=variant,
        parametrisation="sine",
        partly_unseen=True,  # half of a wave turns with the tool, whose offset is free, where no joint follows
    )


AXIS_WOBBLE = Effect(
    "axis_wobble",
    "geometric",
    _place_wobbles,
    "The joint's axis does not keep its direction while the joint turns (bearing run-out).",
    "Turn the joint alone through a full turn with a dial gauge against a ground surface near its bearing.",
    Cure(
        "Replace or re-seat the bearing.",
        otherwise="No motor turns across its axis: until then let the corrected model's inverse kinematics compute the "
        "commands (nominal axis, tilted and moved across as fitted; `armscope compensate`).",
        change="bearing",
        instruction="Re-seat or replace the bearing of {location}.",
    ),
    clauses=(swings("the axis of {location} tilts"),),
    labels={"run_out": "moves across, at its origin, by ±"},
    atlas=waves_column,
)
