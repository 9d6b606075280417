"""Which stretches of a table are fitted and which take no part: what is too short is said, or refused."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.inputs import InputError, nearest
from armscope.motion.check import too_short
from armscope.motion.fitting.gains import torque_of
from armscope.motion.samples.constants import FILTER
from armscope.motion.samples.rails import rails
from armscope.motion.samples.timing import Stretch, stretches
from armscope.motion.samples.unread import unread
from armscope.recordings.motions import Motions
from armscope.robot.dynamics import MovingArm
from armscope.verdict.schema import Notice


@dataclass(frozen=True, eq=False)
class Parted:
    """Stretches to fit, and stretches that take no part, effort as torque; and what is said of pieces left out."""

    train: list[Stretch]
    test: list[Stretch]
    notices: list[Notice]


def refuse_unknown(runs: Sequence[str], motions: Motions) -> None:
    """Refuse to hold out a run that is not in the table, or in which nothing moves.

    Raises:
        InputError: it is not.
    """
    for run in runs:
        if run not in motions.runs:
            rule = f"{motions.source} has no such run in motion"
            raise InputError("--held-out", "", run, rule, nearest(run, motions.runs))


def parted_in_two(arm: MovingArm, motions: Motions, held_out: Sequence[str]) -> Parted:
    """Stretches to fit, and stretches that take no part.

    Args:
        arm: the arm as stated.
        motions: samples, of mended time.
        held_out: runs that take no part.

    Returns:
        Both, without pieces that are too short.

    Raises:
        InputError: nothing is left to fit, or of a run that is held out.
    """
    if (short := too_short(motions)) is not None:
        raise short
    found = Parted([], [], [])
    idle = unread(motions) | rails(motions, arm).at
    dropped: dict[str, list[float]] = {run: [] for run in motions.runs}
    for stretch in stretches(motions):
        seconds = len(stretch) / stretch.rate
        if seconds > FILTER.shortest_s:
            own = motions.run == stretch.run
            at = np.searchsorted(motions.time[own], stretch.time).clip(0, np.count_nonzero(own) - 1)
            effort = torque_of(arm, stretch.effort, motions.kind)
            as_torque = replace(stretch, effort=effort, cut=idle[own][at])
            (found.test if stretch.run in held_out else found.train).append(as_torque)
        else:
            dropped[stretch.run].append(seconds)
    _refuse_nothing(found, held_out)
    kept = {stretch.run for stretch in (*found.train, *found.test)}
    found.notices.extend(_left_out(run, pieces, run in kept) for run, pieces in dropped.items() if pieces)
    return found


def _refuse_nothing(found: Parted, held_out: Sequence[str]) -> None:
    if not found.train and found.test:
        rule = "a run at least takes part in the fit"
        raise InputError("--held-out", "", ", ".join(held_out), rule, "Hold out fewer.")
    for run in held_out:
        if run not in {stretch.run for stretch in found.test}:
            rule = f"a run that is held out moves for more than {FILTER.shortest_s:g} s without a gap"
            raise InputError("--held-out", "", run, rule, "Hold out a longer one.")


def _left_out(run: str, pieces: Sequence[float], some: bool) -> Notice:
    """What is said of pieces of a run, s each, that are too short; whether others of it take part."""
    least = f"than {FILTER.shortest_s:g} s, of which {FILTER.edge_s:g} s at either end take no part"
    if some:
        text = f"pieces of {sum(pieces):.3g} s together were left out ({len(pieces)}): none is longer {least}."
    else:
        text = f"it takes no part. Its longest motion without a gap is {max(pieces):.3g} s, and must be longer {least}."
    return Notice("too short", f"{f'run {run}' if run else 'the table'}: {text}")
