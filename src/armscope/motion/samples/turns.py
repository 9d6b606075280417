"""Angles recorded within one turn: counted on where they jump by a whole one, so that speeds are those of the arm."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.motion.samples.constants import READING, TIMING
from armscope.recordings.motions import Motions
from armscope.verdict.schema import Notice

TURN = 2 * np.pi


def counted_on(motions: Motions) -> tuple[Motions, list[Notice]]:
    """The table with whole turns added where an angle jumps by one between neighbouring samples, run by run.

    Masses know no whole turns, but speeds, and what follows a joint's angle over its range, do. No run tells in which
    turn it began: the first is laid about the middle of what was recorded, the others about the first.

    Returns:
        The samples, and one notice that names joints, places and numbers of jumps; none where nothing jumps.
    """
    q, told = motions.q.copy(), []
    for j in np.flatnonzero(~motions.sliding):
        jumps = {run: _jumps(motions, run, motions.q[:, j]) for run in motions.runs}
        if any(map(len, jumps.values())):
            rows = np.sort(np.concatenate(list(jumps.values())))
            q[:, j] = _laid(motions, motions.q[:, j])
            times = "once, in" if len(rows) == 1 else f"{len(rows)} times, first in"
            told.append(f"q{j + 1} jumps by a whole turn {times} line {rows[0] + 2}")
    if not told:
        return motions, []
    text = (
        f"Recorded within one turn: {'; '.join(told)}. The angle is counted on over the jumps, within each run; over "
        "a gap in time the shorter way is taken."
    )
    changed = replace(motions, q=q, link=_with_motors(motions, q))
    return changed, [Notice("within one turn", text)]


def laid_about(motions: Motions, known: Array | None) -> tuple[Motions, list[Notice]]:
    """The table with its turning joints in the turns in which a model knows them, run by run.

    Angles of one turn are told alike in the next; springs and cables are not. A run that lies where the model was
    fitted stays.

    Args:
        motions: the samples, without jumps.
        known: (m, 2) rad, least and largest angles of the model's own motion; None where they are not known.

    Returns:
        The samples, and one notice that names what was moved; none where nothing was.
    """
    if known is None:
        return motions, []
    q, told = motions.q.copy(), []
    for j in np.flatnonzero(~motions.sliding):
        for run in motions.runs:
            there = motions.run == run
            least, most = float(q[there, j].min()), float(q[there, j].max())
            turns = float(np.round((known[j].mean() - (least + most) / 2) / TURN))
            now, then = (_beyond((least + by, most + by), known[j]) for by in (0.0, TURN * turns))
            if then < now:
                q[there, j] += TURN * turns
                told.append(f"q{j + 1}{f' of run {run}' if run else ''} by {turns:+.0f}")
    if not told:
        return motions, []
    text = f"Laid in the turn in which the model knows them, in whole turns: {', '.join(told)}."
    return replace(motions, q=q, link=_with_motors(motions, q)), [Notice("within one turn", text)]


def _beyond(span: tuple[float, float], known: Array) -> float:
    """Rad by which a range lies outside another one, at both ends together."""
    return max(float(known[0]) - span[0], 0.0) + max(span[1] - float(known[1]), 0.0)


def leaps(motions: Motions) -> list[tuple[int, int, float]]:
    """Steps of turning joints that are neither motion nor whole turns: joint, row after it, and rad, the first of each.

    An angle that jumped by a whole turn and was low-passed or interpolated afterwards shows them; so does a reader
    that lost count. No turn can be added that mends them.
    """
    found = []
    for j in np.flatnonzero(~motions.sliding):
        for run in motions.runs:
            rows, steps, neighbours = _steps(motions, run, motions.q[:, j])
            usual = float(np.percentile(np.abs(steps), READING.usual_steps)) if len(steps) else 0.0
            far = np.abs(steps) > max(READING.part_turn, READING.leap * usual)
            wrong = np.flatnonzero(far & neighbours)
            if len(wrong):
                found.append((int(j), int(rows[wrong[0] + 1]), float(steps[wrong[0]])))
                break
    return found


def _steps(motions: Motions, run: str, angle: Array) -> tuple[Indices, Array, NDArray[np.bool_]]:
    """Rows of a run, (K - 1,) steps between them, and which of these no gap in time parts."""
    rows = np.flatnonzero(motions.run == run)
    times = np.diff(motions.time[rows])
    later = times[times > 0]
    usual = float(np.median(later)) if len(later) else 0.0
    return rows, np.diff(angle[rows]), times <= max(TIMING.gap * usual, TIMING.gap_s)


def _jumps(motions: Motions, run: str, angle: Array) -> Indices:
    """Rows after which an angle has jumped by a whole turn; none where steps lie between a jump and a motion.

    A table in degrees that is called radians moves by whole turns from sample to sample, too, but by parts of them
    as well.
    """
    rows, steps, neighbours = _steps(motions, run, angle)
    size = np.abs(steps[neighbours])
    between = (size > READING.part_turn) & (np.abs(size - TURN) > READING.part_turn)
    if between.any():
        return rows[:0]
    return np.asarray(rows[1:][neighbours & (np.abs(steps) > READING.part_turn)])


def _laid(motions: Motions, angle: Array) -> Array:
    """(N,) an angle without jumps, its runs about one another."""
    found, about = angle.copy(), (angle.min() + angle.max()) / 2
    for number, run in enumerate(motions.runs):
        there = motions.run == run
        whole = np.unwrap(angle[there])
        middle = (whole.min() + whole.max()) / 2
        turns = TURN * np.round((about - middle) / TURN)
        found[there] = whole + turns
        about = middle + turns if number == 0 else about
    return found


def _with_motors(motions: Motions, q: Array) -> Array | None:
    """(N, m) positions of the links, in the turns of their motors."""
    if motions.link is None:
        return None
    beside = motions.link - q
    turned = np.where(motions.sliding, 0.0, TURN * np.round(beside / TURN))
    return np.asarray(motions.link - turned)
