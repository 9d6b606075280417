"""Scanned numbers at which causes rest: speeds, delays and compliances are moved along the slope of their laws."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.motion.constants import LIBRARY, NOISE
from armscope.motion.fitting.clocks import rivals_at_hand
from armscope.motion.fitting.linkages import remounted
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.torque_delay import Between, lag_step
from armscope.motion.fitting.wave_counts import recounted
from armscope.motion.library import catalogue
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.changes import as_it_is_carried
from armscope.motion.library.changes_catalogue import LOAD_CHANGE
from armscope.motion.library.for_a_while import OF_A_LOAD
from armscope.motion.library.laws import Law
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.linkage import BETWEEN_LINKS
from armscope.motion.library.masses import as_a_body, as_it_leans, at_its_place
from armscope.motion.library.powers import closer, opposite

Refined = tuple[PlacedCause, bool]
"""A cause as the fit says that its columns should be, and whether they are so already, within errors."""
Moved = Iterator[tuple[int, PlacedCause, bool]]
"""The same with its number among those placed."""


def refined(selected: SelectedCauses, between: Between) -> TorqueLayout | None:
    """The layout with scanned numbers, centres and loads where the fit puts them; None where they rest."""
    placed, rest = list(selected.rows.layout.placed), True
    for number, cause, rests in itertools.chain(_of_chosen(selected, between), _of_others(selected)):
        placed[number], rest = cause, rest and rests
    return None if rest else replace(selected.rows.layout, placed=tuple(placed))


def _of_chosen(selected: SelectedCauses, between: Between) -> Moved:
    for number in selected.best.candidates:
        cause = selected.rows.layout.placed[number]
        if cause.cause is catalogue.VISCOUS_CURVE:
            yield from ((other, power, False) for other, power in _closer_powers(selected, number).items())
        elif cause.cause is catalogue.LINK_CENTRE or is_anywhere(cause):
            yield (number, *_exact(selected, number))
        elif cause.cause is LOAD_CHANGE:
            yield (number, *_as_carried(selected, number))
        elif cause.cause is catalogue.GRAVITY:
            yield (number, *_leaning(selected, number))
        elif cause.cause is catalogue.DELAY:
            yield (number, *_later(selected, number, between))
        elif cause.cause is catalogue.STRIBECK:
            yield (number, *_falling(selected, number))
        elif cause.cause is catalogue.COMPLIANCE:
            yield (number, *_softer(selected, number))


def _of_others(selected: SelectedCauses) -> Moved:
    """What competes with the chosen ones follows them."""
    yield from ((number, rival, not elsewhere) for number, rival, elsewhere in rivals_at_hand(selected))
    yield from ((number, counted, False) for number, counted in recounted(selected).items())
    for number, cause in enumerate(selected.rows.layout.placed):
        if is_anywhere(cause) and number not in selected.best.candidates:
            yield number, as_a_body(cause, selected.rows.layout.arm, *carried_in(selected, cause)), True
        elif cause.variant == BETWEEN_LINKS:
            yield (number, *remounted(selected, number))


def _later(selected: SelectedCauses, number: int, between: Between) -> Refined:
    """A delay whose chord ends where its slope leads."""
    value, error = _fitted(selected, number)
    more, unsure = lag_step(selected, number)
    now, better = _formed_at(selected, number), float(value[0]) + more
    rests = abs(better - now) < NOISE.settled * max(float(error[0]), unsure)
    return _at(selected, number, between.next(selected.best.candidates, number, now, better)), rests


def _softer(selected: SelectedCauses, number: int) -> Refined:
    """A drive's chord at the compliance that it has."""
    value, error = _fitted(selected, number)
    now, better = _formed_at(selected, number), float(value[0])
    rests = better <= 0 or abs(better - now) < NOISE.settled * float(error[0])
    return _at(selected, number, better if better > 0 else now), rests


def _falling(selected: SelectedCauses, number: int) -> Refined:
    """Friction near rest that falls over the speed to which its slope leads."""
    value, error = _fitted(selected, number)
    now, (joint,) = _formed_at(selected, number), selected.rows.layout.placed[number].joints
    fastest = float(np.abs(selected.rows.dq[:, joint]).max())
    better = falling_over(now, float(value[1] / value[0]), fastest)
    return _at(selected, number, better), bool(abs(value[1]) < NOISE.settled * error[1] or better == now)


def _fitted(selected: SelectedCauses, number: int) -> tuple[Array, Array]:
    """(c,) a cause's numbers and their standard errors, SI."""
    columns = selected.rows.layout.columns[number]
    return selected.coefficients[columns], np.sqrt(selected.best.variances(columns)) / selected.problem.scale[columns]


def _formed_at(selected: SelectedCauses, number: int) -> float:
    """The number at which its law was formed."""
    law = selected.rows.layout.placed[number].columns
    assert isinstance(law, Law)
    return law.numbers[-1]


def _at(selected: SelectedCauses, number: int, value: float) -> PlacedCause:
    """The cause with its law formed at another number."""
    cause = selected.rows.layout.placed[number]
    law = cause.columns
    assert isinstance(law, Law)
    scanned = tuple((name, unit, value) for name, unit, _ in cause.scanned)
    return replace(cause, columns=replace(law, numbers=(*law.numbers[:-1], value)), scanned=scanned)


def _closer_powers(selected: SelectedCauses, number: int) -> dict[int, PlacedCause]:
    """Powers of a joint's speed in place of those that were not chosen, by their numbers."""
    layout, best = selected.rows.layout, selected.best.candidates
    (joint,) = layout.placed[number].joints
    others = {
        n: each
        for n, each in enumerate(layout.placed)
        if each.cause is catalogue.VISCOUS_CURVE and each.joints == (joint,) and n not in best
    }
    drives = selected.coefficients[layout.columns[number][0]] < 0
    return (opposite if drives else closer)(layout.placed[number], others, bool(layout.arm.sliding[joint]))


def is_anywhere(cause: PlacedCause) -> bool:
    """Whether it is a load that may sit anywhere on the last link."""
    return cause.cause is catalogue.PAYLOAD and cause.width > 1


def sits_nowhere(selected: SelectedCauses, number: int) -> bool:
    """Whether a load that may sit anywhere has its centre farther from the last joint than the arm is long.

    Moments of the last link, moved by errors of the other masses, are no load.
    """
    layout, columns = selected.rows.layout, selected.rows.layout.columns[number]
    mass, *others = selected.coefficients[columns]
    moments = [
        v for v, (name, _) in zip(others, layout.placed[number].parameters[1:], strict=True) if name in OF_A_LOAD
    ]
    _, stated = carried_in(selected, layout.placed[number])
    return bool(np.linalg.norm(moments) > layout.reach * (abs(mass) + stated))


def carried_in(selected: SelectedCauses, load: PlacedCause) -> tuple[Array, float]:
    """(4,) mass and moments that the chosen causes add to the last link where a load is, and kg stated there."""
    rows, added = selected.rows, np.zeros(4)
    for number in selected.best.candidates:
        cause, columns = rows.layout.placed[number], rows.layout.columns[number]
        if cause.inertial is not None and (not cause.runs or set(cause.runs) == set(load.runs)):
            added += (cause.inertial @ selected.coefficients[columns])[-10:-6]
    return added, rows.stated_payload(load.runs)


def _exact(selected: SelectedCauses, number: int) -> Refined:
    """A moved centre or a load as bodies have it."""
    layout = selected.rows.layout
    cause, (values, error) = layout.placed[number], _fitted(selected, number)
    if cause.cause is catalogue.LINK_CENTRE:
        exact = at_its_place(cause, layout.arm, values)
    else:
        exact = as_a_body(cause, layout.arm, *carried_in(selected, cause))
    assert cause.inertial is not None
    assert exact.inertial is not None
    unsure = np.sqrt(np.sum((cause.inertial * error) ** 2, axis=1))
    return exact, bool(np.all(np.abs((exact.inertial - cause.inertial) @ values) <= NOISE.settled * unsure))


def _leaning(selected: SelectedCauses, number: int) -> Refined:
    """A leaning gravity whose pull keeps its size."""
    layout = selected.rows.layout
    cause, (values, error) = layout.placed[number], _fitted(selected, number)
    exact = as_it_leans(cause, layout.arm, values)
    if not (isinstance(cause.columns, Law) and isinstance(exact.columns, Law)):
        return cause, True
    before, after = (np.array(each.numbers).reshape(-1, 3) for each in (cause.columns, exact.columns))
    change = float(np.linalg.norm(values @ (after - before)))
    return exact, change <= NOISE.settled * float(np.linalg.norm(error @ np.abs(before)))


def _as_carried(selected: SelectedCauses, number: int) -> Refined:
    """A load that comes and goes as bodies have it."""
    layout = selected.rows.layout
    cause, (values, error) = layout.placed[number], _fitted(selected, number)
    exact = as_it_is_carried(cause, layout.arm, values)
    if exact is cause or not (isinstance(cause.columns, Law) and isinstance(exact.columns, Law)):
        return cause, True
    before, after = (np.array(each.numbers[1 : 1 + len(OF_A_LOAD)]) for each in (cause.columns, exact.columns))
    counted = [OF_A_LOAD.index(name) for name, _ in cause.parameters]
    rests = bool(np.all(np.abs(after - before)[counted] <= NOISE.settled * error))
    return (cause if rests else exact), rests


def falling_over(now: float, step: float, fastest: float) -> float:
    """The speed over which friction falls, a step of its logarithm on, within half of the fastest that was seen.

    What falls over more is dry friction over again, less of it, and a joint never shows where it ends.

    Args:
        now: rad/s (m/s).
        step: of the logarithm; as far as the scan's speeds lie apart at most.
        fastest: rad/s (m/s) of the joint.

    Returns:
        rad/s (m/s).
    """
    by = float(np.clip(step, -LIBRARY.between_speeds, LIBRARY.between_speeds))
    return min(now * float(np.exp(by)), max(fastest / 2, now))
