"""A joint's zero that jumps during a session: a coupling or belt that slips, a joint homed anew, a collision."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from armscope.physics.clause import Told
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.cure import command
from armscope.physics.drift import from_then_on, moment, when
from armscope.physics.effect import Driver, Effect, Placed, motor, term
from armscope.physics.form_constants import FORM
from armscope.physics.placing import moving_joints
from armscope.physics.set_ups import in_order_of_time
from armscope.recordings import Recordings
from armscope.robot import Arm


def _place_between_runs(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    """A zero that is another one from some run on; within a run its moment is scanned by the diagnosis."""
    runs = in_order_of_time(recordings)
    for j in moving_joints(recordings):
        for number, (before, after) in enumerate(pairwise(runs), 1):
            told = f"between runs {before} and {after}"
            yield _jump(j, Driver("during run", tuple(runs[number:])), told, variant=told)


def zero_shift(recordings: Recordings, row: int, multiplicity: int, j: int) -> Placed:
    """The zero of motor j jumps before a row (0-based), and stays so in the rest of its run and in all later runs.

    Args:
        recordings: the table.
        row: the first after the jump.
        multiplicity: how many moments and motors compete.
        j: the motor, from 1.

    Returns:
        The effect in place.
    """
    runs = in_order_of_time(recordings)
    start = moment(recordings, row, tuple(runs[runs.index(str(recordings.run[row])) + 1 :]))
    return from_then_on(_jump(j, start.driver, "", multiplicity=multiplicity * FORM.sessions_per_slip), start)


def _jump(j: int, driver: Driver, told: str, variant: str = "", multiplicity: int = 1) -> Placed:
    jump = term("jump", "rad", (motor(j), driver), plausible=PLAUSIBLE.zero_rad)
    return Placed(ZERO_SHIFT, f"joint {j}", (jump,), (1.0,), told, variant=variant, multiplicity=multiplicity)


def _jumped(told: Told) -> str:
    return f"the zero of {told.location} jumped by {told.numbers['jump']:+}{when(told)}"


ZERO_SHIFT = Effect(
    "zero_shift",
    "drift",
    _place_between_runs,
    "The joint's zero jumped: a coupling or belt slipped, the joint was homed anew, or the arm hit something.",
    "Look into the log for what happened then; bring the joint to its calibration mark and compare.",
    command(
        "Fasten what slipped and set the joint's zero anew;",
        otherwise="or compensate for it in the command: commanded = wanted - jump x after (after: 0 before the jump, "
        "1 from then on).",
        change="mastering",
        instruction="Find what slipped at {location}, fasten it, and set its zero anew from the jump on{jump}.",
    ),
    clauses=(_jumped, "the zero of {location} jumped"),
    labels={"jump": "zero jumped by"},
    atlas="time",
    needs=("time_s, or rows in order",),
    contained_in=("time",),
    departs=True,
    jumps=True,
    several=True,
)

EFFECTS = [ZERO_SHIFT]
