"""How late a joint's torque is, by its slope: a number that a fit along the chord to a delay leaves open.

A delay's column is the chord: what the torque becomes that is late by so much, exactly there. Where dry friction is
most of a joint's torque, how high its steps are at that delay says that the chord must be taken as a whole, and nothing
of the delay itself: when friction changes sides has a number of its own (`layout.OWN_NAMES`). What the slope at the
delay explains of what is left between the reversals is by how much it must move (Gauss-Newton, with every other column
free within its prior).

So is a joint's own chord: how high it is, is as much a matter of how that joint's friction changes sides. A chord that
all joints have in common is no joint's friction, and stays as it is: between reversals it is the slope once more, and
where both were free, a chord that is too short would ask for a slope that is too steep, without end.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.ndimage import binary_closing

from armscope.core.types import Array, Indices
from armscope.motion.constants import PRIOR
from armscope.motion.fitting.rows import MotionRows
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library.layout import OWN
from armscope.motion.samples.constants import FILTER


def lag_step(selected: SelectedCauses, number: int) -> tuple[float, float]:
    """By how much later than fitted a joint's torque is, or that of all joints.

    Two things tell it of each joint: what is left between the moments at which friction changes sides, and these
    moments, which lie as far from the delay as the prior of their own number has it.

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


def lag_of(selected: SelectedCauses, joint: int, number: int) -> tuple[float, float]:
    """By how much later than fitted one joint's torque is.

    Of a joint without dry friction only what is left tells it, and of one that hardly moves nothing does.

    Args:
        selected: the selection.
        joint: from 0.
        number: of the delay that is chosen there, among the placed causes.

    Returns:
        Seconds, and how well that is known: one over its variance.
    """
    rows, best, scale = selected.rows, selected.best, selected.problem.scale
    among = np.flatnonzero((selected.weights.row[:, joint] > 0) & _between_reversals(rows, joint))
    unit = (PRIOR.unit / selected.weights.sigma[joint] / best.noise) ** 2 / selected.weights.correlated[joint]
    root = np.sqrt(unit * selected.weights.row[among, joint])[:, None]
    common = rows.layout.placed[number].common
    others = ~np.isin(best.columns, rows.layout.columns[number] if common else [])
    X = root * columns_of(selected, joint, best.columns[others])[among] / scale[best.columns[others]]
    slope, left = root[:, 0] * _slope(selected, joint)[among], root[:, 0] * selected.residuals[among, joint]
    step, information = _apart(X, 1 / best.variance[others], slope, left)
    turning, unsure = _turning(selected, joint)
    both = information + unsure**-2
    return (information * step + turning / unsure**2) / both, both


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


def _turning(selected: SelectedCauses, joint: int) -> tuple[float, float]:
    """By how much later than the delay dry friction changes sides, s, and how far its prior lets it."""
    layout, best = selected.rows.layout, selected.best
    later = layout.reversals[joint, 1]
    dry = abs(selected.coefficients[OWN * joint + 1] + np.nan_to_num(layout.arm.stated_background[joint, 1]))
    place = np.flatnonzero(best.columns == later)
    if dry <= 0:
        return 0.0, np.inf
    if not len(place):
        return 0.0, PRIOR.turning_s
    free = float(np.sqrt(best.variance[place[0]])) / selected.problem.scale[later]
    return float(selected.coefficients[later] / dry), free / dry


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


def _between_reversals(rows: MotionRows, joint: int) -> NDArray[np.bool_]:
    """(K,) where dry friction pulls one way: how exactly it changes sides is no matter of the delay.

    The low-pass rings about such a moment, and passes zero there in single rows: those between two that turn turn, too.
    """
    (place,) = np.flatnonzero(rows.at[joint] == rows.layout.reversals[joint, 1])
    size = np.abs(rows.columns[joint][:, place])
    turning = size > FILTER.turning * size.max()
    return np.asarray(~(turning | binary_closing(turning)))  # a closing forgets the first and the last row


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


def columns_of(selected: SelectedCauses, joint: int, columns: Indices) -> Array:
    """Some columns of a joint, zero where it has none of them; combinations of masses among them.

    Args:
        selected: a selection.
        joint: from 0.
        columns: (C,) their numbers.

    Returns:
        (K, C).
    """
    rows = selected.rows
    made, shares = rows.layout.made_of_masses
    own, at = rows.columns[joint] * rows.gain_of_columns(joint), rows.at[joint]
    found = np.zeros((len(rows), len(columns)))
    there = np.flatnonzero(np.isin(columns, at))
    found[:, there] = own[:, np.searchsorted(at, columns[there])]
    combined = np.flatnonzero(np.isin(columns, made))
    if len(combined):
        of_masses = own[:, np.searchsorted(at, rows.layout.inertial)].astype(np.float64)
        order = [int(np.flatnonzero(made == column)[0]) for column in columns[combined]]
        found[:, combined] += of_masses @ shares[:, order]
    return found
