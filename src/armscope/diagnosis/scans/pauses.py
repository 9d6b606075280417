"""Pauses of a drift, found by scanning: moments at which nobody measured, although the base went on moving."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.scans.change_points import ModelRows, pieces_of, step_sums
from armscope.diagnosis.scans.constants import SCANS
from armscope.diagnosis.scans.context import ScanContext
from armscope.inference.additions import unscaled_factor
from armscope.inference.evidence import Hypothesis
from armscope.inference.linear_algebra import solve_lower
from armscope.physics.drift import Pause, base_shift, drift_with_pauses, pauses_of
from armscope.physics.effect import Placed
from armscope.recordings import Recordings


def pauses(context: ScanContext, drifting: Hypothesis, drift: int) -> Iterator[Placed]:
    """A drift by the order of rows with one, two, ... pauses, where nobody recorded when rows were measured.

    In a pause the base moves on the way that it moves all the time: one number, where a jump has six. It never moves
    back.

    Args:
        context: the rows.
        drifting: a hypothesis with the drift, without what pauses may stand for.
        drift: the drift's number among the candidates.

    Yields:
        The drift in place, with one pause more each time.
    """
    problem, recordings = context.problem, context.recordings
    at = problem.space.candidates[drift].columns
    way = drifting.means(at) / problem.scale[at]
    known = pauses_of(context.space.placed[drift])
    numbers, passed = recordings.number, _rows_passed(recordings, known)
    pieces = list(pieces_of(recordings))
    ways_to_pause = SCANS.lengths_of_pauses * sum(len(cuts) for _, cuts in pieces)
    factor, whitened_rhs = unscaled_factor(problem, drifting)
    for rows, cuts in pieces:
        run = str(recordings.run[rows[0]])
        earlier, later = context.runs_around("base", run)
        step = base_shift(recordings, int(rows[0]), 1, later).terms
        sums = step_sums(ModelRows(context, drifting.columns), rows, cuts, step)
        V = solve_lower(factor, (sums.cross @ way).T)
        alone = np.einsum("mij,i,j->m", sums.own, way, way)
        # two steps have the rows behind the later one in common
        own = alone[np.maximum.outer(np.arange(len(cuts)), np.arange(len(cuts)))] - V.T @ V
        before_these, after_these = (np.flatnonzero(np.isin(recordings.run, runs)) for runs in (earlier, later))
        on_one_base = np.concatenate([before_these, rows, after_these])
        line = passed[on_one_base] - passed[on_one_base].mean()
        pull = sums.b @ way - V.T @ whitened_rhs
        before = [(run, float(numbers[row])) for row in rows[cuts]]
        fitted = [before.index((p.run, p.row)) for p in known if (p.run, p.row) in before]
        for chosen, length in _steps(own, pull, drifting, fitted, np.log(ways_to_pause)):
            # the drift has taken its share of every step: as large as a line's share of it
            taken = sum(
                a * float(line[len(before_these) + cut :].sum() / (line @ line))
                for a, cut in zip(length, cuts[chosen], strict=True)
            )
            if taken < 1:
                new = [
                    Pause(before[n][1], run, 1e3 * a / (1 - taken), later) for a, n in zip(length, chosen, strict=True)
                ]
                together = _together(known, new)
                if all(p.rows > 0 for p in together):
                    yield drift_with_pauses(together, ways_to_pause ** len(together))


def _steps(
    own: Array, pull: Array, given: Hypothesis, fitted: Sequence[int], price: float
) -> Iterator[tuple[list[int], Array]]:
    """Steps and their sizes, one more each time: that which explains most beside the others, if it promises enough.

    Args:
        own: (m, m) products of the steps once the hypothesis is conditioned on.
        pull: (m,) their products with what is left to explain.
        fitted: steps that the hypothesis has already; their sizes are set right first.
        price: nats of one step more.
    """
    chosen, size = list(fitted), _sizes(own, pull, fitted)
    if len(chosen) and 0.5 * size @ pull[chosen] / given.noise**2 > SCANS.worth_setting_right:
        yield list(chosen), size
    while len(chosen) < SCANS.most_pauses:
        left, inside = pull - own[:, chosen] @ size, own[np.ix_(chosen, chosen)]
        beside = np.diag(own) - np.einsum("mi,im->m", own[:, chosen], np.linalg.pinv(inside) @ own[chosen])
        seen = beside > 1e-6 * np.diag(own)
        gain = np.where(seen & (left > 0), 0.5 * left**2 / np.where(seen, beside, 1.0) / given.noise**2, 0.0)
        best = int(np.argmax(gain))
        if gain[best] < SCANS.worth_a_look + price:
            return
        chosen.append(best)
        size = _sizes(own, pull, chosen)
        if np.any(size[len(fitted) :] <= 0):
            return
        yield list(chosen), size


def _sizes(own: Array, pull: Array, chosen: Sequence[int]) -> Array:
    """Sizes of steps that explain most together."""
    return np.asarray(np.linalg.solve(own[np.ix_(chosen, chosen)], pull[list(chosen)]), dtype=np.float64)


def _together(known: Sequence[Pause], new: Sequence[Pause]) -> list[Pause]:
    """All pauses in order; those before one row are one."""
    rows: dict[tuple[str, float, tuple[str, ...]], float] = {}
    for each in (*known, *new):
        at = each.run, each.row, each.later
        rows[at] = rows.get(at, 0.0) + each.rows
    return [Pause(row, run, length, later) for (run, row, later), length in sorted(rows.items())]


def _rows_passed(recordings: Recordings, known: Sequence[Pause]) -> Array:
    """(N,) thousands of rows, pauses included."""
    number = recordings.number
    passed = number / 1e3
    for p in known:
        after = (number >= p.row) & (recordings.run == p.run) | np.isin(recordings.run, p.later)
        passed = passed + p.rows / 1e3 * after
    return passed
