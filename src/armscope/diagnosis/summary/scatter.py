"""Scatter that has a place but no driver in the table; and whether the order of its rows says where it comes from."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.constants import TELLING
from armscope.diagnosis.summary.scatter_laws import law_of_scatter
from armscope.fitting.gaps import Gap, gaps, sums_beside
from armscope.fitting.joint_scatter import motor_jacobians
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings, motion
from armscope.robot.kinematics import chain, joint_axes
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
    unsure = side_by_side_joints(state.fit.model, state.recordings, [each.motor for each in at_fault])
    for scattered, rms in zip(at_fault, sizes, strict=True):
        location, stderr = f"joint {scattered.motor}", scattered.size / np.sqrt(2 * moved.shape[1])
        play = plays.get(scattered.motor)
        found = _told(location, Parameter("scatter", "rad", scattered.size, stderr), play)
        share = rms**2 / max(variance, together / max(left, 1e-9)) if variance > 0 else 0.0
        cure = _cure(play, len(moved))
        if play is None and (law := law_of_scatter(state, scattered)) is not None:
            found = replace(
                found,
                title=law.title,
                parameters=(*found.parameters, *law.told),
                physics=law.physics,
                confirm=law.confirm,
            )
            cure = law.cure
        if (others := unsure[scattered.motor]) and play is None:
            places = " or ".join(f"scatter at joint {motor}" for motor in (scattered.motor, *others))
            found = replace(found, named_as="region", title=places)
        yield replace(found, rms_at_tool_mm=rms, share=share, evidence_nats=scattered.evidence, cure=cure)


def side_by_side_joints(model: FittedModel, recordings: Recordings, motors: Sequence[int]) -> dict[int, list[int]]:
    """Of each of some motors the others whose joints turn about axes along its own: rows hardly tell which scatters.

    They move the tool in one plane. What one of them does that grows with its load, say, and what base and tool take
    up of it, leave something at the other's lever.

    Args:
        model: of the arm.
        recordings: rows.
        motors: counted from 1.

    Returns:
        Motors, by motor.
    """
    if len(motors) < 2:
        return {motor: [] for motor in motors}
    every = joint_axes(chain(model.arm, recordings.motor_angles))
    axes = {motor: every[:, :, np.argmax(np.abs(model.arm.actuation[:, motor - 1]))] for motor in motors}
    nearest = np.cos(TELLING.parallel_rad)

    def along(one: int, other: int) -> bool:
        return one != other and bool(np.abs(np.sum(axes[one] * axes[other], axis=1)).min() > nearest)

    return {one: [other for other in motors if along(one, other)] for one in motors}


def told_as_scatter(found: FoundEffect, motors: int) -> FoundEffect:
    """Play by the order of rows alone: the joint scatters, until somebody writes down the side from which it came.

    Args:
        found: play whose side of approach the order of rows tells.
        motors: of the arm.

    Returns:
        The scatter, as large as that play makes it.
    """
    (gap,) = [each for each in found.parameters if each.name == "gap"]
    play = play_of(Gap(gap.value, gap.stderr))
    told = _told(found.location, Parameter("scatter", "rad", play.value / 2, play.stderr / 2), play)
    return replace(
        told,
        rms_at_tool_mm=found.rms_at_tool_mm,
        share=found.share,
        evidence_nats=found.evidence_nats,
        cure=_cure(play, motors),
    )


def _told(location: str, scatter: Parameter, play: Parameter | None) -> FoundEffect:
    """Scatter of a joint, and the play that it is by the order of rows; neither weighed nor with a cure yet."""
    return FoundEffect(
        effect="unknown",
        location=location,
        family="unknown",
        driver=NOTHING,
        named_as="effect",
        title=f"scatter at {location} that follows nothing in the table" + (" but its order" if play else ""),
        minor=False,
        parameters=(scatter, *([] if play is None else [play])),
        rms_at_tool_mm=0.0,
        share=0.0,
        evidence_nats=0.0,
        alternatives=(),
        inclusion=None,
        curve=None,
        physics=REASONLESS if play is None else f"{REASONLESS} {_by_order(play)}",
        confirm=_CONFIRM
        if play is None
        else f"Measure one pose many times, coming to it from both sides of {location}.",
        cure="",
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
        f"Write the side from which every joint came into columns approach1 ... approach{motors} (-1 or +1, the way "
        "it last moved; 0 where that is not known) and diagnose again: play then gets its name, and can be compensated."
        " Until then change nothing."
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
    return np.nan_to_num(motion.sides_of_last_moves(recordings)[:, motor - 1])


def _plays(state: DiagnosisState, motors: Sequence[int]) -> dict[int, Parameter]:
    """By how much motors stand apart after motion to either side, where the order of rows shows it clearly."""
    if state.recordings.approach is not None or not motors:
        return {}
    sides = np.zeros(state.recordings.motor_angles.shape)
    for motor in motors:
        sides[:, motor - 1] = sides_by_order(state.recordings, motor)
    fit, told = state.fit, replace(state.recordings, approach=sides)
    found = gaps(fit, told, fit.weights, fit.noise, sums=sums_beside(fit, state.table, fit.weights))
    return {motor: play_of(gap) for motor, gap in found.items() if gap.clearly > TELLING.play_by_order}


def play_of(gap: Gap) -> Parameter:
    """Play leaves a joint behind its motor. One that stands ahead of its reading went on after it was read."""
    return Parameter("play" if gap.size > 0 else OVERRUN, "rad", abs(gap.size), gap.stderr)


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
