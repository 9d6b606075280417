"""How late a joint's torque is, by its slope, where friction of no joint has just changed sides.

A delay's column is the chord: what the smooth part of the torque becomes that is late by so much, exactly there. What
the slope at the delay explains of what is left where friction has settled is by how much it must move (Gauss-Newton,
with every other column free within its prior).
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from armscope.core.types import Array, Indices
from armscope.motion.constants import PRIOR
from armscope.motion.fitting.near_reversals import settled_rows
from armscope.motion.fitting.rows import MotionRows
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library.catalogue import DELAY
from armscope.motion.samples.constants import FILTER


def lag_step(selected: SelectedCauses, number: int) -> tuple[float, float]:
    """By how much later than fitted a joint's torque is, or that of all joints.

    Args:
        selected: the selection.
        number: of the delay among the placed causes; it is chosen.

    Returns:
        Seconds, at most as many as rows lie apart, and their standard error with all other columns as free as they are.
    """
    rows = selected.rows
    told = [lag_of(selected, joint, number) for joint in rows.layout.placed[number].joints]
    information = sum(known for _, known in told)
    if information <= 0:
        return 0.0, PRIOR.turning_s
    step = sum(step * known for step, known in told) / information
    apart = float(np.median(np.diff(rows.time)))
    return float(np.clip(step, -apart, apart)), float(information**-0.5)


def values_of(selected: SelectedCauses, number: int) -> Array:
    """(c,) a chosen cause's numbers, SI; a delay as it is where friction has settled, whatever reversals fit."""
    values = selected.coefficients[selected.rows.layout.columns[number]]
    is_late = selected.rows.layout.placed[number].cause is DELAY
    return values + lag_step(selected, number)[0] if is_late else values


def lag_of(selected: SelectedCauses, joint: int, number: int) -> tuple[float, float]:
    """By how much later than fitted one joint's torque is.

    Args:
        selected: the selection.
        joint: from 0.
        number: of the delay that is chosen there, among the placed causes.

    Returns:
        Seconds, and how well that is known: one over its variance.
    """
    rows, best, scale = selected.rows, selected.best, selected.problem.scale
    among = np.flatnonzero((selected.weights.row[:, joint] > 0) & settled_rows(rows)[:, joint])
    unit = (PRIOR.unit / selected.weights.sigma[joint] / best.noise) ** 2 / selected.weights.correlated[joint]
    root = np.sqrt(unit * selected.weights.row[among, joint])[:, None]
    others = ~np.isin(best.columns, rows.layout.columns[number])
    X = root * columns_of(rows, joint, best.columns[others])[among] / scale[best.columns[others]]
    slope, left = root[:, 0] * _slope(selected, joint)[among], root[:, 0] * selected.residuals[among, joint]
    return _apart(X, 1 / best.variance[others], slope, left)


class Between:
    """Delays between which one at rest lies, by where its steps so far led: steps that overshoot don't go on for ever.

    Gauss-Newton's step is taken as long as it stays between the nearest delay that asked for more and the nearest that
    asked for less; else where a straight line between these two asks for none.
    """

    def __init__(self) -> None:
        self.names: frozenset[int] = frozenset()
        self.asked: dict[int, list[tuple[float, float]]] = {}

    def next(self, names: frozenset[int], number: int, now: float, better: float) -> float:
        """The next delay.

        Args:
            names: numbers of all chosen causes; others ask for other steps.
            number: of the delay among them.
            now: s, its delay.
            better: s, where its step leads.

        Returns:
            Seconds.
        """
        if names != self.names:
            self.names, self.asked = names, {}
        asked = self.asked.setdefault(number, [])
        asked.append((now, better - now))
        more = max((each for each in asked if each[1] > 0), default=None)
        less = min((each for each in asked if each[1] < 0), default=None)
        if more is None or less is None or more[0] >= less[0] or more[0] < better < less[0]:
            return better
        return more[0] + (less[0] - more[0]) * more[1] / (more[1] - less[1])


def _apart(X: Array, prior: Array, slope: Array, left: Array) -> tuple[float, float]:
    """(coefficient of the slope in what is left, its information) beside columns X (N, C) of a prior precision (C,)."""
    G = X.T @ X + np.diag(prior)
    unit = 1 / np.sqrt(np.diag(G))
    shared = unit * np.linalg.lstsq(G * np.outer(unit, unit), unit * (X.T @ slope), rcond=None)[0]
    own = slope - X @ shared
    information = float(own @ own + shared @ (prior * shared))
    if information <= FILTER.rounding * float(slope @ slope):
        return 0.0, 0.0
    return float(own @ left) / information, information


def _slope(selected: SelectedCauses, joint: int) -> Array:
    """(K,) what a joint's modelled torque becomes per second of more delay."""
    rows = selected.rows
    torque = selected.modelled[:, joint]
    found = np.zeros(len(rows))
    for number in np.unique(rows.stretch):
        there = np.flatnonzero(rows.stretch == number)
        if len(there) > 3 and np.all(np.diff(rows.time[there]) > 0):
            found[there] = -CubicSpline(rows.time[there], torque[there])(rows.time[there], 1)
    return found


def columns_of(rows: MotionRows, joint: int, columns: Indices) -> Array:
    """Some columns of a joint, combinations of masses among them; zero where it, or a run, has none of them.

    Args:
        rows: of samples.
        joint: from 0.
        columns: (C,) their numbers.

    Returns:
        (K, C).
    """
    made, _ = rows.layout.made_of_masses
    own, at = rows.columns[joint] * rows.gain_of_columns(joint), rows.at[joint]
    found = np.zeros((len(rows), len(columns)))
    there = np.flatnonzero(np.isin(columns, at))
    found[:, there] = own[:, np.searchsorted(at, columns[there])]
    combined = np.flatnonzero(np.isin(columns, made))
    if len(combined):
        of_masses = own[:, np.searchsorted(at, rows.layout.inertial)].astype(np.float64)
        order = [int(np.flatnonzero(made == column)[0]) for column in columns[combined]]
        for run in np.unique(rows.run):
            there = np.flatnonzero(rows.run == run)
            found[np.ix_(there, combined)] += of_masses[there] @ rows.layout.shares_in(str(run))[:, order]
    return found
