"""Scatter that has a place but no driver in the table; and whether the order of its rows says where it comes from."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.constants import TELLING
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.joint_scatter import motor_jacobians
from armscope.physics.transmission import BACKLASH
from armscope.recordings import Recordings
from armscope.recordings.motion import last_moves
from armscope.verdict.effects import FoundEffect, Parameter

NOTHING = "nothing in the table"
"""What scatter follows."""
_CONFIRM = "Record the side of approach, speed, load and temperature, and repeat one pose many times."
_CURE = "Find what the scatter follows (play, a loose coupling or encoder) before compensating anything."
OVERRUN = "overrun"
"""Name of the size by which a joint stands ahead of what was read, apart after motion to either side."""
REASONLESS = "The joint stands a little elsewhere each time, for a reason that no single column of the table tells."


def scattered_effects(state: DiagnosisState, variance: float, left: float) -> Iterator[FoundEffect]:
    """Scatter that has a place but follows nothing in the table.

    Args:
        state: the finished selection.
        variance: of the mismatch per axis, mm^2.
        left: share of it that nothing else explains: scatter is no more, though bad shots may make it look larger.

    Yields:
        One effect per motor that scatters.
    """
    at_fault = [each for each in state.scatter if not each.rounded]
    moved = motor_jacobians(state.fit.model, state.recordings) if at_fault else np.empty(0)
    sizes = [each.size * float(np.sqrt(np.mean(moved[each.motor - 1] ** 2))) for each in at_fault]
    together = sum(rms**2 for rms in sizes)
    plays = _plays(state, [each.motor for each in at_fault])
    for scattered, rms in zip(at_fault, sizes, strict=True):
        location, lever = f"joint {scattered.motor}", moved[scattered.motor - 1]
        play = plays.get(scattered.motor)
        yield FoundEffect(
            effect="unknown",
            location=location,
            family="unknown",
            driver=NOTHING,
            named_as="effect",
            title=f"scatter at {location} that follows nothing in the table" + (" but its order" if play else ""),
            minor=False,
            parameters=(
                Parameter("scatter", "rad", scattered.size, scattered.size / np.sqrt(2 * len(lever))),
                *([] if play is None else [play]),
            ),
            rms_at_tool_mm=rms,
            share=rms**2 / max(variance, together / max(left, 1e-9)) if variance > 0 else 0.0,
            evidence_nats=scattered.evidence,
            alternatives=(),
            inclusion=None,
            curve=None,
            physics=REASONLESS if play is None else f"{REASONLESS} {_by_order(play)}",
            confirm=_CONFIRM
            if play is None
            else f"Measure one pose many times, coming to it from both sides of {location}.",
            cure=_cure(play, len(moved)),
        )


def _cure(play: Parameter | None, motors: int) -> str:
    """What names the play, and gives its compensation; or what brings angles and points to one moment."""
    if play is None:
        return _CURE
    if play.name == OVERRUN:
        return (
            "Let the arm come to rest before its angles are read, as before its point is measured, and measure again. "
            "Until then change nothing."
        )
    return (
        f"Write the side from which every joint came into columns approach1 ... approach{motors} (-1 or +1, 0 where it "
        "did not move) and diagnose again: play then gets its name, and can be compensated. Until then change nothing."
    )


def rest_of_a_curve(scatter: FoundEffect, named: Sequence[FoundEffect]) -> bool:
    """Whether scatter is what a free curve at the same joint could not follow."""
    return any(
        effect.nameless
        and effect.location == scatter.location
        and effect.rms_at_tool_mm > TELLING.rest_of_a_curve * scatter.rms_at_tool_mm
        for effect in named
    )


def sides_by_order(recordings: Recordings, motor: int) -> Array:
    """From which side a motor came to each row, if rows were measured in the order of their time or number.

    Args:
        recordings: N rows, in any order.
        motor: counted from 1.

    Returns:
        (N,) sign of the motor's motion from the row before in the same run; 0 for the first of a run.
    """
    return np.sign(np.nan_to_num(last_moves(recordings)[:, motor - 1]))


def _plays(state: DiagnosisState, motors: Sequence[int]) -> dict[int, Parameter]:
    """By how much motors stand apart after motion to either side, where the order of rows shows it clearly.

    Play leaves a joint behind its motor. One that stands ahead of its reading went on after it was read.

    Each is fitted with all else, of which what follows the angle follows the side a little, too; and without the
    others, for all of which the rows are summed up once.
    """
    if state.recordings.approach is not None or not motors:
        return {}
    fit, sides = state.fit, np.zeros(state.recordings.motor_angles.shape)
    for motor in motors:
        sides[:, motor - 1] = sides_by_order(state.recordings, motor)
    table = replace(state.recordings, approach=sides)
    gaps = [placed for placed in BACKLASH.place(fit.model.arm, table) if placed.variant == "approach"]
    if not gaps:
        return {}
    terms = [*fit.layout.terms, *(term for gap in gaps for term in gap.terms)]
    layout = replace(fit.layout, terms=tuple(terms))
    (sums,) = normal_equations_by_block(layout, fit.model, table, fit.weights, np.zeros(len(table), dtype=np.intp))
    ridge, plays = np.diag(np.append(fit.noise**2 * fit.precision, 0.0)), {}
    for number, gap in enumerate(gaps, len(fit.precision)):
        at = np.append(np.arange(len(fit.precision)), number)
        inverse = np.linalg.inv(sums.G[np.ix_(at, at)] + ridge)
        size, stderr = float(inverse[-1] @ sums.b[at]), fit.noise * float(np.sqrt(inverse[-1, -1]))
        if abs(size) > TELLING.play_by_order * stderr:
            name = "play" if size > 0 else OVERRUN
            plays[Location.of(gap.location).index + 1] = Parameter(name, "rad", abs(size), stderr)
    return plays


def _by_order(play: Parameter) -> str:
    times = f"{play.value / play.stderr:.0f} times its standard error"
    if play.name == OVERRUN:
        return (
            f"If rows were measured in this order, the joint stands further on than its angle says, the way it came: "
            f"motion to one side and to the other leave it {play.value * 1e3:.2g} mrad apart, {times}. Play would "
            f"leave it behind; its angles seem to have been read before it had come to rest, or it creeps on."
        )
    return (
        f"If the rows stand in the order in which they were measured, it is play: after motion to one side the joint "
        f"stands apart from where it stands after the other by {play.value * 1e3:.2g} mrad, {times}."
    )
