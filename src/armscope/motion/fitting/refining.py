"""Scanned numbers at which causes rest: speeds, delays and compliances are moved along the slope of their laws."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.motion.constants import LIBRARY, NOISE
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.torque_delay import Between, lag_step
from armscope.motion.library import catalogue
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.laws import Law
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.masses import at_its_place

SCANNED = (catalogue.STRIBECK, catalogue.DELAY, catalogue.COMPLIANCE)
"""Causes whose law holds a number that is fitted by its slope."""


def refined(selected: SelectedCauses, between: Between) -> TorqueLayout | None:
    """The layout with scanned speeds and delays where the fit puts them; None where they rest."""
    layout, moved = selected.rows.layout, False
    placed = list(layout.placed)
    for number in selected.best.candidates:
        cause, columns = placed[number], layout.columns[number]
        if cause.cause is catalogue.LINK_CENTRE:
            exact, rests = _exact(selected, number)
            placed[number], moved = exact, moved or not rests
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
            rests = max(abs(better - now), abs(float(values[0]) - now)) < settled
            better = between.next(frozenset(selected.best.candidates), number, now, better)
        elif cause.cause is catalogue.COMPLIANCE:
            better = float(values[0])
            rests = better <= 0 or abs(better - now) < NOISE.settled * float(error[0])
            better = better if better > 0 else now
        else:
            by = float(np.clip(values[1] / values[0], -LIBRARY.between_speeds, LIBRARY.between_speeds))
            better, rests = now * np.exp(by), abs(values[1]) < NOISE.settled * error[1]
        scanned = tuple((name, unit, better) for name, unit, _ in cause.scanned)
        placed[number] = replace(cause, columns=replace(cause.columns, numbers=(*others, better)), scanned=scanned)
        moved = moved or not rests
    return replace(layout, placed=tuple(placed)) if moved else None


def _exact(selected: SelectedCauses, number: int) -> tuple[PlacedCause, bool]:
    """A moved centre with the square of its moments, and whether that was in its columns already, within errors."""
    layout, columns = selected.rows.layout, selected.rows.layout.columns[number]
    cause, values = layout.placed[number], selected.coefficients[columns]
    exact = at_its_place(cause, layout.arm, values)
    assert cause.inertial is not None
    assert exact.inertial is not None
    error = np.sqrt(selected.best.variances(columns)) / selected.problem.scale[columns]
    unsure = np.sqrt(np.sum((cause.inertial * error) ** 2, axis=1))
    return exact, bool(np.all(np.abs((exact.inertial - cause.inertial) @ values) <= NOISE.settled * unsure))
