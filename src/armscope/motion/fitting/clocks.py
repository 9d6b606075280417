"""One delay of all torques, or one of each joint: which of them it is, and where each is looked for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from armscope.inference.evidence import Hypothesis
from armscope.inference.search import Search
from armscope.motion.constants import NOISE
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.torque_delay import lag_of
from armscope.motion.library import catalogue
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.laws import Law


def parted_where_they_differ(search: Search, best: Hypothesis, placed: Sequence[PlacedCause]) -> Hypothesis:
    """Each joint's own delay in place of that of all joints, where the evidence prefers it.

    The other way round is a step of the search itself: one enters while many leave (`space.build_space`).

    Args:
        search: on the hypothesis' problem.
        best: a hypothesis.
        placed: what competes.

    Returns:
        The more probable of both.
    """
    common = [number for number in best.candidates if _is_common(placed[number])]
    if not common:
        return best
    own = {n for n, cause in enumerate(placed) if cause.cause is catalogue.DELAY and not cause.common}
    others = frozenset(range(len(placed))) - own
    found = search.without(best, common)
    while better := search.additions(found, 1, others, least=0.0):
        if better[0].log_posterior <= found.log_posterior:
            break
        found = better[0]
    return max(best, found, key=lambda each: each.log_posterior)


def rivals_at_hand(selected: SelectedCauses) -> Iterator[tuple[int, PlacedCause, bool]]:
    """Delays that compete with those that are chosen, at the numbers that suit them.

    Chosen ones rest where the fit has them. At the numbers that are tried first, each joint's own would lose to that of
    all joints, and that to them, for being a little off.

    Args:
        selected: a selection.

    Yields:
        Numbers among the placed causes, what they become, and whether that is elsewhere, beyond what is known.
    """
    placed = selected.rows.layout.placed
    chosen = [n for n in selected.best.candidates if placed[n].cause is catalogue.DELAY]
    lags = {joint: _lag(selected, n, joint) for n in chosen for joint in placed[n].joints}
    told = {joint: lag for joint, lag in lags.items() if lag[1] > 0}
    if not told:
        return
    known = sum(known for _, known in told.values())
    mean = sum(lag * own for lag, own in told.values()) / known
    wanted = {cause.joints: (mean, known) for cause in placed if _is_common(cause)}
    if any(_is_common(placed[n]) for n in chosen):
        wanted |= {(joint,): lag for joint, lag in told.items()}
    for joints, (lag, known) in wanted.items():
        for alike in _of_one_law(placed, joints):
            if not set(chosen).isdisjoint(alike):
                continue
            nearest = min(alike, key=lambda n: abs(np.log(max(lag, 1e-6) / _delay(placed[n]))))
            law = placed[nearest].columns
            assert isinstance(law, Law)
            moved = replace(placed[nearest], columns=replace(law, numbers=(*law.numbers[:-1], lag)))
            yield nearest, moved, abs(lag - _delay(placed[nearest])) > NOISE.settled * known**-0.5


def _lag(selected: SelectedCauses, number: int, joint: int) -> tuple[float, float]:
    """How late a joint's torque is by itself, s, where a delay has it, and one over the variance of that."""
    columns = selected.rows.layout.columns[number]
    step, known = lag_of(selected, joint, number)
    return float(selected.coefficients[columns[0]]) + step, known


def _of_one_law(placed: Sequence[PlacedCause], joints: tuple[int, ...]) -> list[list[int]]:
    """Numbers of the delays of some joints, by what else than the delay their law takes."""
    alike: dict[tuple[object, ...], list[int]] = {}
    for number, cause in enumerate(placed):
        if cause.cause is catalogue.DELAY and cause.joints == joints and isinstance(cause.columns, Law):
            alike.setdefault((cause.columns.kind, *cause.columns.numbers[:-1]), []).append(number)
    return list(alike.values())


def _is_common(cause: PlacedCause) -> bool:
    return cause.cause is catalogue.DELAY and cause.common


def _delay(cause: PlacedCause) -> float:
    """Of a delay that is not chosen: early torque is told by a chord to a late one at first."""
    assert isinstance(cause.columns, Law)
    return max(cause.columns.numbers[-1], 1e-6)
