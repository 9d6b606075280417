"""Scanned numbers at which causes rest: speeds, delays and compliances are moved along the slope of their laws."""

from __future__ import annotations

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

SCANNED = (catalogue.STRIBECK, catalogue.DELAY, catalogue.COMPLIANCE)
"""Causes whose law holds a number that is fitted by its slope."""


def refined(selected: SelectedCauses, between: Between) -> TorqueLayout | None:
    """The layout with scanned speeds and delays where the fit puts them; None where they rest."""
    layout, moved = selected.rows.layout, False
    placed = list(layout.placed)
    for number in selected.best.candidates:
        cause, columns = placed[number], layout.columns[number]
        if cause.cause is catalogue.LINK_CENTRE or is_anywhere(cause):
            exact, rests = _exact(selected, number)
            placed[number], moved = exact, moved or not rests
            continue
        if cause.cause is catalogue.VISCOUS_CURVE:
            for other, closer_power in _closer_powers(selected, number).items():
                placed[other], moved = closer_power, True
            continue
        if cause.variant == BETWEEN_LINKS:
            continue
        if cause.cause is LOAD_CHANGE:
            placed[number], rests = _as_carried(selected, number)
            moved = moved or not rests
            continue
        if cause.cause is catalogue.GRAVITY:
            placed[number], rests = _leaning(selected, number)
            moved = moved or not rests
            continue
        if cause.cause not in SCANNED or not isinstance(cause.columns, Law):
            continue
        values = selected.coefficients[columns]
        error = np.sqrt(selected.best.variances(columns)) / selected.problem.scale[columns]
        *others, now = cause.columns.numbers
        if cause.cause is catalogue.DELAY:
            more, unsure = lag_step(selected, number)
            better = float(values[0]) + more
            settled = NOISE.settled * max(float(error[0]), unsure)
            rests = abs(better - now) < settled
            better = between.next(frozenset(selected.best.candidates), number, now, better)
        elif cause.cause is catalogue.COMPLIANCE:
            better = float(values[0])
            rests = better <= 0 or abs(better - now) < NOISE.settled * float(error[0])
            better = better if better > 0 else now
        else:
            fastest = float(np.abs(selected.rows.dq[:, cause.joints[0]]).max())
            better = falling_over(now, float(values[1] / values[0]), fastest)
            rests = abs(values[1]) < NOISE.settled * error[1] or better == now
        scanned = tuple((name, unit, better) for name, unit, _ in cause.scanned)
        placed[number] = replace(cause, columns=replace(cause.columns, numbers=(*others, better)), scanned=scanned)
        moved = moved or not rests
    for number, rival, elsewhere in rivals_at_hand(selected):
        placed[number], moved = rival, moved or elsewhere
    for number, counted in recounted(selected).items():
        placed[number], moved = counted, True
    for number in range(len(placed)):
        if (
            is_anywhere(placed[number]) and number not in selected.best.candidates
        ):  # not chosen, it competes with what is chosen in its place
            placed[number] = as_a_body(placed[number], layout.arm, *carried_in(selected, placed[number]))
        if placed[number].variant == BETWEEN_LINKS:
            placed[number], rests = remounted(selected, number)
            moved = moved or not rests
    return replace(layout, placed=tuple(placed)) if moved else None


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
    there = [each.signals for each in rows.samples if not load.runs or each.signals.run in load.runs]
    stated = [np.zeros(1) if each.payload is None else np.nan_to_num(each.payload) for each in there]
    return added, float(np.mean(np.concatenate(stated))) if stated else 0.0


def _exact(selected: SelectedCauses, number: int) -> tuple[PlacedCause, bool]:
    """A moved centre or a load as bodies have it, and whether that was in its columns already, within errors."""
    layout, columns = selected.rows.layout, selected.rows.layout.columns[number]
    cause, values = layout.placed[number], selected.coefficients[columns]
    if cause.cause is catalogue.LINK_CENTRE:
        exact = at_its_place(cause, layout.arm, values)
    else:
        exact = as_a_body(cause, layout.arm, *carried_in(selected, cause))
    assert cause.inertial is not None
    assert exact.inertial is not None
    error = np.sqrt(selected.best.variances(columns)) / selected.problem.scale[columns]
    unsure = np.sqrt(np.sum((cause.inertial * error) ** 2, axis=1))
    return exact, bool(np.all(np.abs((exact.inertial - cause.inertial) @ values) <= NOISE.settled * unsure))


def _leaning(selected: SelectedCauses, number: int) -> tuple[PlacedCause, bool]:
    """A leaning gravity whose pull keeps its size, and whether that was in its columns already, within errors."""
    layout, columns = selected.rows.layout, selected.rows.layout.columns[number]
    cause, values = layout.placed[number], selected.coefficients[columns]
    exact = as_it_leans(cause, layout.arm, values)
    if not (isinstance(cause.columns, Law) and isinstance(exact.columns, Law)):
        return cause, True
    before, after = (np.array(each.numbers).reshape(-1, 3) for each in (cause.columns, exact.columns))
    error = np.sqrt(selected.best.variances(columns)) / selected.problem.scale[columns]
    change = float(np.linalg.norm(values @ (after - before)))
    return exact, change <= NOISE.settled * float(np.linalg.norm(error @ np.abs(before)))


def _as_carried(selected: SelectedCauses, number: int) -> tuple[PlacedCause, bool]:
    """A load that comes and goes as bodies have it, and whether its inertia was formed for it, within errors."""
    layout, columns = selected.rows.layout, selected.rows.layout.columns[number]
    cause, values = layout.placed[number], selected.coefficients[columns]
    exact = as_it_is_carried(cause, layout.arm, values)
    if exact is cause or not (isinstance(cause.columns, Law) and isinstance(exact.columns, Law)):
        return cause, True
    error = np.sqrt(selected.best.variances(columns)) / selected.problem.scale[columns]
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
