"""What a table of a motion shows to be wrong or doubtful before anything is named."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from armscope.core.inputs import InputError
from armscope.motion.constants import CHECK
from armscope.motion.samples.constants import FILTER, READING
from armscope.motion.samples.rails import Rails, rails
from armscope.motion.samples.standing import still_span
from armscope.motion.samples.timing import coarse_steps, parted
from armscope.motion.samples.unread import unread
from armscope.motion.samples.unstated_gains import gains_in_words
from armscope.recordings.motions import Motions, torque_columns
from armscope.robot.dynamics import MovingArm
from armscope.verdict.schema import Notice
from armscope.verdict.wording import percent

if TYPE_CHECKING:
    from armscope.motion.library.layout import TorqueLayout


COARSE = "coarse channel"
"""Kind of the notice that rounding of the recorded torque limits what can be told."""
CUT_OFF = "cut off"
"""Kind of the notice that a channel ends at a rail."""
MOVES = "a joint moves by more than servo noise"


def check_motions(arm: MovingArm, motions: Motions) -> list[Notice]:
    """What can be seen in the samples themselves.

    Raises:
        InputError: they don't fit the arm, or can't be what their columns say.
    """
    refuse_other_joints(arm, motions)
    refuse_unknown_gains(arm, motions)
    _refuse_dead(motions)
    return doubts_about(motions, arm)


def refuse_unknown_gains(arm: MovingArm, motions: Motions) -> None:
    """Make sure that currents are of motors whose torque per ampere is stated.

    Raises:
        InputError: one is not.
    """
    if motions.kind == "current" and np.isnan(arm.gains).any():
        j = int(np.flatnonzero(np.isnan(arm.gains))[0])
        rule = "currents need the torque of each motor per ampere"
        cure = (
            "State `drives: [{gain_nm_per_a: ...}, ...]` in robot.yaml, with `gain_uncertainty` where it is not sure. "
            f"{gains_in_words(arm, motions)}"
        ).rstrip()
        raise InputError(motions.source, f"column current{j + 1}_a", "no gain_nm_per_a in robot.yaml", rule, cure)


def doubts_about(motions: Motions, arm: MovingArm | None = None) -> list[Notice]:
    """Joints that stand, or move one way only; channels that were cut off, are coarse, or hold no speed.

    Raises:
        InputError: none moves, or temperatures are no arm's.
    """
    _refuse_temperatures(motions)
    ends = rails(motions, arm)
    of_channels = [*_cut_off(motions, ends), *_unread(motions, ends.at), *_coarse(motions), *_no_speeds(motions)]
    return [*_still_joints(motions), *_one_way(motions), *of_channels]


def runs_in_motion(motions: Motions) -> tuple[Motions, list[Notice]]:
    """The samples without runs in which no joint moves: what holds joints that stand tells nothing of the arm.

    Raises:
        InputError: none is left.
    """
    spans = {run: np.ptp(motions.q[motions.run == run], axis=0) for run in motions.runs}
    standing = [run for run, span in spans.items() if np.all(span <= still_span(motions.sliding))]
    if len(standing) == len(motions.runs):
        raise InputError(motions.source, "columns q1 ...", "no joint that moves", MOVES, "Record a motion.")
    told = [Notice("run stands", f"Run {run}: no joint moves in it. It takes no part.") for run in standing]
    return (motions.rows(~np.isin(motions.run, standing)) if standing else motions), told


def channels(motions: Motions) -> list[str]:
    """Columns of torque or current."""
    if motions.kind == "torque":
        return torque_columns(motions.sliding)
    return [f"current{j + 1}_a" for j in range(motions.n_motors)]


def refuse_other_joints(arm: MovingArm, motions: Motions) -> None:
    """Make sure that what slides in the table slides in the arm.

    Raises:
        InputError: it turns.
    """
    wrong = np.flatnonzero(motions.sliding != arm.sliding)
    if len(wrong):
        j = int(wrong[0])
        found = f"q{j + 1}_{'m' if motions.sliding[j] else 'rad'}"
        rule = f"motor {j + 1} of the arm {'slides' if arm.sliding[j] else 'turns'}"
        raise InputError(motions.source, "line 1", found, rule, "Is this the right robot for the table?")


def _refuse_dead(motions: Motions) -> None:
    span = np.ptp(motions.effort, axis=0)
    names = "current{}_a" if motions.kind == "current" else "tau{}_nm"
    if np.all(span == 0):
        place = f"column {names.format(1)}"
        rule = "torque changes while an arm moves"
        raise InputError(motions.source, place, float(motions.effort[0, 0]), rule, "Is the channel recorded?")


def _still_joints(motions: Motions) -> list[Notice]:
    still = np.flatnonzero(np.ptp(motions.q, axis=0) <= still_span(motions.sliding))
    if len(still) == motions.n_motors:
        raise InputError(motions.source, "columns q1 ...", "no joint that moves", MOVES, "Record a motion.")
    return [
        Notice("joint stands", f"Joint {j + 1} never moves: of its friction and rotor nothing can be known.")
        for j in still
    ]


def _one_way(motions: Motions) -> list[Notice]:
    notices = []
    for j in range(motions.n_motors):
        travel = np.concatenate([np.diff(motions.q[motions.run == run, j]) for run in motions.runs])
        travel = travel[np.abs(travel) > 0]
        if len(travel) and np.ptp(motions.q[:, j]) > still_span(motions.sliding)[j]:
            forward = float(travel[travel > 0].sum() / np.abs(travel).sum())
            if min(forward, 1 - forward) < CHECK.one_way:
                text = f"Joint {j + 1} moves one way only: its dry friction and a torque offset can't be told apart."
                notices.append(Notice("one way only", text))
    return notices


def _cut_off(motions: Motions, found: Rails) -> list[Notice]:
    notices = []
    for j, name in enumerate(channels(motions)):
        if found.at[:, j].any():
            rows = np.flatnonzero(found.at[:, j])
            values = " and ".join(dict.fromkeys(f"{each:.4g}" for each in sorted(found.values[j])))
            noise = ", with noise on it," if found.noisy[j] else ","
            where = f"{values}, the farthest it goes{noise} in {len(rows)} samples, first in line {rows[0] + 2}"
            text = (
                f"{name} stays at {where}: it is cut off there, or the drive is at its limit, and what lies beyond is "
                f"not known. These samples, and what the low-pass mixes with them, take no part in the fit of joint "
                f"{j + 1}. Record with a wider range, more slowly, or with less load."
            )
            notices.append(Notice(CUT_OFF, text))
    return notices


def _unread(motions: Motions, at: NDArray[np.bool_]) -> list[Notice]:
    """Of channels that were not read; one that stays at its limit was, and is told as cut off."""
    idle, notices = unread(motions) & ~at, []
    for j in np.flatnonzero(idle.any(axis=0)):
        rows = np.flatnonzero(idle[:, j])
        text = (
            f"{channels(motions)[j]} says {motions.effort[rows[0], j]:.4g} from line {rows[0] + 2} on, in {len(rows)} "
            f"samples in all, while joint {j + 1} speeds up or turns back: the channel was not read. These samples "
            f"take no part in the fit of joint {j + 1}. See whether it is connected."
        )
        notices.append(Notice("not read", text))
    return notices


def too_short(motions: Motions) -> InputError | None:
    """What is wrong where no piece of motion without gaps is long enough; of mended time."""
    period, pieces = parted(motions)
    longest = max(float(np.ptp(motions.time[rows])) for _, rows in pieces) + period
    if longest > FILTER.shortest_s:
        return None
    found = f"no motion without gaps that is longer than {longest:.3g} s"
    rule = f"more than {FILTER.shortest_s:g} s are needed, of which {FILTER.edge_s:g} s at either end take no part"
    cure = f"Is it in seconds? From sample to sample it goes on by {period:.2g}. Record ten seconds or more."
    return InputError(motions.source, "column time_s", found, rule, cure)


def refuse_few(layout: TorqueLayout, rows: int, source: str) -> None:
    """Make sure that there are rows for friction and masses.

    Args:
        layout: of the columns.
        rows: how many.
        source: of the table, for the message.

    Raises:
        InputError: there are fewer numbers than parameters ask for.
    """
    joints = layout.arm.n_motors
    parameters = len(layout.frames) + len(layout.inertial)
    if rows * joints < CHECK.rows_per_parameter * parameters:
        rule = (
            f"{parameters} values of friction and masses need at least {CHECK.rows_per_parameter * parameters} numbers"
        )
        raise InputError(source, "", f"{rows} independent rows of {joints} joints", rule, "Record longer.")


def _refuse_temperatures(motions: Motions) -> None:
    """Make sure that temperatures are degrees Celsius."""
    if motions.temperature is None or np.isnan(motions.temperature).all():
        return
    least, most = READING.temperature
    beyond = np.argwhere((motions.temperature < least) | (motions.temperature > most))
    if len(beyond):
        row, j = (int(each) for each in beyond[0])
        rule = f"an arm is between {least:g} and {most:g} degrees Celsius warm"
        cure = "Are these kelvin? Take 273.15 from them. Where nothing was read, leave the cell empty."
        column = f"column temperature_c, or temperature{j + 1}_c"
        raise InputError(motions.source, f"line {row + 2}, {column}", float(motions.temperature[row, j]), rule, cure)


def _coarse(motions: Motions) -> list[Notice]:
    told = []
    for name, step, effort in zip(channels(motions), coarse_steps(motions.effort), motions.effort.T, strict=True):
        if step > 0:
            rounding = step / np.sqrt(12)
            share = percent(rounding / max(float(np.sqrt(np.mean(effort**2))), 1e-300))
            told.append(f"{name} in steps of {step:.3g}, whose rounding is {rounding:.2g} RMS, {share} of it")
    if not told:
        return []
    text = f"Recorded coarsely: {'; '.join(told)}. An error of that size is rounding, and shows no cause."
    return [Notice(COARSE, text)]


def _no_speeds(motions: Motions) -> list[Notice]:
    if motions.dq is None:
        return []
    moving = np.ptp(motions.q, axis=0) > still_span(motions.sliding)
    dead = np.flatnonzero(moving & (np.ptp(np.nan_to_num(motions.dq), axis=0) == 0))
    if not len(dead):
        return []
    names = ", ".join(f"dq{j + 1}" for j in dead)
    text = (
        f"The recorded speed {names} never changes, and the joint moves: speeds are taken from the positions instead."
    )
    return [Notice("no speed", text)]
