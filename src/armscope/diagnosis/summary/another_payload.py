"""What compliances would be under another payload than is stated, where rows would rather have another.

A payload 25 % heavier than stated is, to what gives way, nearly a payload as stated under links 10 % lighter and drives
13 % softer: masses are off by as much on any arm, so that the payload earns no name, and compliances come out by the
wrong load, with intervals that know of no other.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from armscope.diagnosis.constants import NAMING
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.constants import TELLING
from armscope.inference.evidence import Hypothesis
from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.physics.payload import PAYLOAD_ERROR, what_bears
from armscope.verdict.effects import Alternative, FoundEffect, Parameter


def beside_another_payload(
    state: DiagnosisState, search: Search, found: Mapping[int, FoundEffect]
) -> dict[int, FoundEffect]:
    """Effects; of those that give way, intervals that hold what they would be under the payload that rows ask for.

    Args:
        state: the finished selection.
        search: its search.
        found: by candidate.

    Returns:
        The effects; as they are where torques tell loads, where the payload has a name, and where rows would not
        rather have another.
    """
    told, best = dict(found), state.best
    if state.recordings.torque is not None or is_told(search, best):
        return told
    other = with_another_payload(search, best)
    if other is None or other.log_evidence - best.log_evidence < TELLING.another_payload_nats:
        return told
    odds = 1 / (1 + np.exp(best.log_evidence - other.log_evidence))
    for chosen, part in zip(best.chosen, state.fit.model.parts, strict=True):
        effect = told.get(chosen.candidate)
        bears = not part.placed.effect.requires and what_bears(state.recordings, [part])
        if effect is not None and bears:
            columns = search.candidate(chosen.candidate).columns
            told[chosen.candidate] = _under_either(effect, columns, best, other, float(odds), search)
    return told


def with_another_payload(search: Search, best: Hypothesis) -> Hypothesis | None:
    """The likeliest hypothesis in which the payload is not as stated, too; None where none may be.

    Args:
        search: of the problem.
        best: to which it is added.

    Returns:
        The hypothesis; its last effect is the payload's.
    """
    numbers = [n for n, c in enumerate(search.space.candidates) if c.kind == PAYLOAD_ERROR.name]
    beside = (
        search.evaluated((*best.chosen, SelectedEffect(number, size)), best)
        for number in numbers
        for size in range(len(search.problem.sizes))
    )
    return max(beside, key=lambda each: each.log_posterior, default=None)


def payload_as_alternative(search: Search, best: Hypothesis, other: Hypothesis) -> Alternative | None:
    """A payload other than stated, as an alternative, where to name it costs no more than alternatives do.

    Args:
        search: of the problem.
        best: without it.
        other: with it, last.

    Returns:
        The alternative; None where it is too far behind.
    """
    gap = best.log_posterior - other.log_posterior
    if gap > NAMING.listed_nats:
        return None
    own = search.candidate(other.chosen[-1].candidate)
    return Alternative(own.kind, own.location, own.family, float(gap), own.driver, float(max(gap, 0.0)))


def is_told(search: Search, best: Hypothesis) -> bool:
    """Whether the payload has a name already."""
    return any(search.candidate(number).kind == PAYLOAD_ERROR.name for number in best.candidates)


def _under_either(
    effect: FoundEffect, columns: np.ndarray, best: Hypothesis, other: Hypothesis, odds: float, search: Search
) -> FoundEffect:
    """An effect whose numbers hold under either payload: errors of both, and what lies between them, by their odds."""
    as_told, instead = best.means(columns), other.means(columns)
    changes = np.divide(instead, as_told, out=np.ones(len(columns)), where=as_told != 0) - 1
    widths = np.sqrt(np.divide(other.variances(columns), as_told**2, out=np.zeros(len(columns)), where=as_told != 0))

    def widened(number: Parameter, change: float, width: float) -> Parameter:
        elsewhere = number.value**2 * (width**2 + change**2)
        return replace(number, stderr=float(np.sqrt((1 - odds) * number.stderr**2 + odds * elsewhere)))

    if len(effect.parameters) != len(columns):
        return effect
    main = int(np.argmax(np.abs(as_told)))
    change, number = float(changes[main]), effect.parameters[main]
    widened_numbers = tuple(map(widened, effect.parameters, changes.tolist(), widths.tolist()))
    effect = replace(effect, parameters=widened_numbers)
    if as_good_as_told(number, change) or any(each.effect == PAYLOAD_ERROR.name for each in effect.alternatives):
        return effect  # the latter of a load that never changes: it is told with what it would be under others
    rival = payload_as_alternative(search, best, other)
    others = sorted((*effect.alternatives, *([rival] if rival else [])), key=lambda each: each.evidence_gap_nats)
    confirm = (
        "Weigh the payload first: these rows would as soon have another than is stated, and this would then be about "
        f"{abs(100 * change):.0f} % {'larger' if change > 0 else 'smaller'}. {effect.confirm}"
    )
    return replace(effect, alternatives=tuple(others), confirm=confirm)


def as_good_as_told(number: Parameter, change: float) -> bool:
    """Whether a number under another payload stays within its interval: to weigh that would tell nothing new of it."""
    low, high = number.interval
    return low <= (1 + change) * number.value <= high
