"""Play whose side of approach nobody wrote down, by the order of rows, before anything else takes its place.

A joint with play stands on one of two branches. Where nothing in the table says on which, and most rows at an angle are
on the same, a curve of that angle follows them, and weights against bad shots silence the others: a wrong curve with
"noise" beside it, and a fifth of the rows that "fit nothing". On a path that goes
one way for long, a joint that turns back looks like a base that jumped. So where many rows fit nothing, where a joint
scatters or has a curve of its own angle, or something jumped, it is asked whether the way to each row tells the branch,
with all rows counting. If so, the rounds start once more, as if the sides had been written down, and the better answer
stays.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from armscope.core.sampling import spread_evenly
from armscope.core.types import Array, Indices, Progress
from armscope.diagnosis.constants import LOOP
from armscope.diagnosis.selection import select
from armscope.diagnosis.state import Selected
from armscope.diagnosis.summary.constants import TELLING
from armscope.fitting.gaps import gaps, is_play_by_approach, rows_of_unknown_side, sums_beside
from armscope.fitting.joint_scatter import log_likelihood, motor_jacobians
from armscope.fitting.linearisation import LinearisedTable
from armscope.inference.constants import PRIORS
from armscope.measurement.constants import WEIGHTS
from armscope.measurement.noise import Noise
from armscope.physics.effect import Placed
from armscope.physics.freeform import follows_own_angle
from armscope.physics.model import FittedModel
from armscope.recordings.motion import sides_of_last_moves


def select_with_sides(
    start: FittedModel,
    table: LinearisedTable,
    noise: Noise,
    frames: Sequence[Placed],
    block_of_row: Indices,
    progress: Progress,
) -> Selected:
    """The selection of `select`, or the one with sides of approach by the order of rows if that explains them better.

    Args:
        start: the arm with its frames.
        table: the rows, and the channels that are used.
        noise: what is known of it.
        frames: always free.
        block_of_row: (N,) number of each row's block.
        progress: hears what is being done.

    Returns:
        The selection; its table has sides of approach where they were taken from the order of rows.
    """
    found = select(start, table, noise, frames, block_of_row, progress)
    sides = _promising_sides(found) if _may_be_play(found) else None
    if sides is None:
        return found
    progress("trying play by the order of rows", 0.5)
    with_sides = LinearisedTable(replace(table.recordings, approach=sides, sides_by_order=True), table.channels)
    tried = select(start, with_sides, noise, frames, block_of_row, progress)
    return tried if _has_play(tried) and _explains_better(tried, found, noise.least_mm) else found


def _may_be_play(found: Selected) -> bool:
    """Whether something was found that play of an unknown side looks like."""
    if found.table.recordings.approach is not None:
        return False
    fit_nothing = found.fit.weights.robust_weight < WEIGHTS.inlier_weight
    return bool(
        np.mean(fit_nothing) > TELLING.few_left_out
        or any(not each.rounded for each in found.scatter)
        or any(follows_own_angle(part.placed) or part.placed.effect.jumps for part in found.fit.model.parts)
    )


def _promising_sides(found: Selected) -> Array | None:
    """(N, m) sides by the order of rows, if they show play clearly beside all that was found; None if not.

    Rows that fit nothing are asked as they were weighed, and once more counting fully: they may be a branch. Jumps are
    taken out, as they follow the order of rows, too. Play that moves the tool by less than the noise can't have made
    rows look like bad shots; a long table shows it clearly, and another selection would take as long as the first.
    """
    recordings, fit = found.table.recordings, found.fit
    everyone = np.ones(len(recordings), dtype=bool)
    trusting = fit.weights.trusting(everyone).unwhitened
    readings = ((fit.weights, fit.noise), (trusting, float("nan")))
    sums = [sums_beside(fit, found.table, weights) for weights, _ in readings]
    jumps = [part for part in fit.model.parts if part.placed.effect.jumps]
    best, promising = TELLING.play_by_order, None
    for kept in (False, True):
        sides = sides_of_last_moves(recordings, kept)
        # in an order of its own, it keeps what is computed on it for the other reading
        table = LinearisedTable(replace(recordings, approach=sides), found.table.channels, np.arange(len(sides)))
        for (weights, noise), beside in zip(readings, sums, strict=True):
            told = gaps(fit, table, weights, noise, jumps, beside).values()
            clearly = max((gap.clearly for gap in told if gap.rms_mm >= fit.noise), default=0.0)
            if clearly > best:
                best, promising = clearly, sides
    return promising


def _has_play(tried: Selected) -> bool:
    """Whether play by the order of rows was chosen, and is clearly there."""
    fit = tried.fit
    plays = [part for part in fit.model.parts if is_play_by_approach(part.placed)]
    return any(
        abs(part.values[0]) > TELLING.play_by_order * float(np.sqrt(fit.covariance_of(part.placed)[0, 0]))
        for part in plays
    )


def _explains_better(tried: Selected, found: Selected, least_mm: float) -> bool:
    """Whether rows are more probable, by more than what more was fitted and the odds for a name pay for.

    All of them count but those to which the order of rows does not tell the way.
    """
    plays = [part.placed for part in tried.fit.model.parts if is_play_by_approach(part.placed)]
    told = np.flatnonzero(~rows_of_unknown_side(tried.table.recordings, plays))
    rows = told[spread_evenly(len(told), LOOP.scatter_rows)]
    share = len(rows) / len(told)
    nats = []
    for each in (tried, found):
        moved = motor_jacobians(each.fit.model, each.table.rows(rows))
        nats.append(log_likelihood(each.fit.residuals[rows], moved, each.scatter, least_mm) / share)
    return bool(nats[0] - nats[1] > tried.fit.effective_dof - found.fit.effective_dof + PRIORS.sure_nats)
