"""Least squares with the exact model and exact columns: damped Gauss-Newton, weights against bad shots, covariance."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import scipy.linalg
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from armscope.calibration.model import SetUp, State
from armscope.calibration.registration import starts
from armscope.core.types import Array

Reason = Literal["the step became negligible", "no step lowers the misfit", "the largest number of steps was made"]

UNSETTLED: Reason = "the largest number of steps was made"
LARGEST_STEPS = 60
NEGLIGIBLE = 1e-8
"""Steps that move the tool by less than this, in metres RMS, end the fit: a hundredth of a micrometre."""

BISQUARE_TUNING = 5.49
"""Tukey's biweight on the 3D distance in units of its 1-sigma per axis: 95 % efficient where errors are normal."""


@dataclass(frozen=True, eq=False)
class Fitted:
    """Where a fit ended: values, weights of the rows (N,), steps made, and why it stopped."""

    state: State
    weights: Array
    steps: int
    reason: Reason


def least_squares(
    set_up: SetUp,
    state: State,
    free: NDArray[np.bool_],
    stiffness: Array | None = None,
    weights: Array | None = None,
    most_steps: int = LARGEST_STEPS,
) -> Fitted:
    """Minimise sum of weights * squared residuals + sum of stiffness * squared change, from ``state``.

    Args:
        set_up: rows and arm.
        state: the start.
        free: (P,) which parameters move.
        stiffness: (P,) m^2 per squared unit, holds parameters near zero (a prior); None holds none.
        weights: (N,) per row; None counts all alike.
        most_steps: after so many steps the fit stops where it is.

    Returns:
        The state, weights, steps, and why it stopped.
    """
    weights = np.ones(len(set_up)) if weights is None else weights
    stiffness = np.zeros(len(free)) if stiffness is None else stiffness
    change = _changes(state)
    residual, jacobian = set_up.linearised(state, free)
    per_component = np.repeat(weights, len(residual) // len(set_up))
    damping = 0.0
    for steps in range(1, most_steps + 1):
        cost = _cost(residual, per_component, stiffness, change)
        weighted = jacobian * per_component[:, None]
        normal = weighted.T @ jacobian + np.diag(stiffness[free])
        gradient = weighted.T @ residual - stiffness[free] * change[free]
        while True:
            step = np.zeros(len(free))
            step[free] = _solve(normal, gradient, damping)
            candidate = state.moved(step)
            if np.sqrt(np.mean((jacobian @ step[free]) ** 2)) < NEGLIGIBLE:
                return Fitted(candidate, weights, steps, "the step became negligible")
            residual, ahead = set_up.linearised(candidate, free)
            if _cost(residual, per_component, stiffness, change + step) <= cost:
                break
            damping = max(damping * 10, 1e-4)
            if damping > 1e8:
                return Fitted(state, weights, steps, "no step lowers the misfit")
        state, jacobian, change = candidate, ahead, change + step
        damping = damping / 100 if damping > 1e-6 else 0.0
    return Fitted(state, weights, most_steps, UNSETTLED)


def _changes(state: State) -> Array:
    """What priors hold near zero; frames are counted from where they start, and are never held."""
    n_frames, n_turns = 6 * len(state.rotations) + 3 * len(state.tools), 3 * len(state.tools)
    return np.concatenate([np.zeros(n_frames), state.constants, state.compliances, np.zeros(n_turns)])


def _cost(residual: Array, per_component: Array, stiffness: Array, change: Array) -> float:
    return float(residual @ (per_component * residual) + stiffness @ change**2)


def _solve(normal: Array, gradient: Array, damping: float) -> Array:
    """Damped normal equations, scaled to a unit diagonal first: conditioning must not depend on units."""
    scale = 1 / np.sqrt(np.maximum(np.diag(normal), 1e-300))
    scaled = normal * scale * scale[:, None] + np.diag(np.full(len(scale), damping + 1e-13))
    return scale * scipy.linalg.solve(scaled, scale * gradient, assume_a="pos")


def robust_least_squares(
    set_up: SetUp, state: State, free: NDArray[np.bool_], stiffness: Array | None = None
) -> Fitted:
    """As `least_squares`, with Tukey's biweight on the 3D distances: bad shots lose their say, and keep their rows.

    Huber's weights come first, since the biweight is only safe near its solution. The scale is the median distance.

    Args:
        set_up: rows and arm.
        state: the start.
        free: (P,) which parameters move.
        stiffness: (P,) m^2 per squared unit; None holds none.

    Returns:
        As `least_squares`, with the final weights (N,).
    """
    fitted = least_squares(set_up, state, free, stiffness)
    steps = fitted.steps
    for weigh in [_huber] * 5 + [_bisquare] * 25:
        distance = np.linalg.norm(set_up.residuals(fitted.state), axis=1)
        weights = weigh(distance / spread_of(distance))
        settled = np.abs(weights - fitted.weights).max() < 1e-4
        fitted = least_squares(set_up, fitted.state, free, stiffness, weights)
        steps += fitted.steps
        if settled and weigh is _bisquare:
            break
    return Fitted(fitted.state, fitted.weights, steps, fitted.reason)


def rms_distance(residuals: Array) -> float:
    """Root mean square of the 3D distance of residuals (N, 3)."""
    return float(np.sqrt(np.mean(np.sum(residuals**2, axis=1))))


def spread_of(distance: Array) -> float:
    """1-sigma per axis that the median 3D distance says, for normal errors; never zero."""
    return max(float(np.median(distance)) / 1.5382, 1e-9)


def _huber(distance: Array) -> Array:
    return np.minimum(1.0, 2.0 / np.maximum(distance, 1e-12))


def _bisquare(distance: Array) -> Array:
    return np.clip(1 - (distance / BISQUARE_TUNING) ** 2, 0.0, None) ** 2


def placed(set_up: SetUp, most_steps: int = LARGEST_STEPS) -> State:
    """Base frames and tools of the nominal arm, from closed-form starts refined; the start of every calibration.

    Args:
        set_up: rows and arm.
        most_steps: of refinement; a few are enough to see whether an arm explains its points at all.
    """
    blank = State(
        rotations=np.tile(np.eye(3), (len(set_up.base_names), 1, 1)),
        translations=np.zeros((len(set_up.base_names), 3)),
        tools=np.tile(set_up.arm.tool, (len(set_up.tool_names), 1)),
        constants=np.zeros(len(set_up.constants)),
        compliances=np.zeros(set_up.arm.n_motors),
        tool_rotations=np.tile(np.eye(3), (len(set_up.tool_names), 1, 1)),
    )
    return with_tool_rotations(set_up, _placed(replace(set_up, orientations=None), blank, most_steps))


def with_tool_rotations(set_up: SetUp, state: State) -> State:
    """The state with each tool's mean orientation on the flange, where orientations are used."""
    if set_up.orientations is None:
        return state
    _, frames = set_up.frames(state)
    known = np.isfinite(set_up.orientations).all(axis=(1, 2))
    seen = np.swapaxes(state.rotations[set_up.base], 1, 2) @ set_up.orientations
    on_flange = np.swapaxes(frames.tool_rotation, 1, 2) @ seen
    rotations = state.tool_rotations.copy()
    for tool in np.unique(set_up.tool[known]):
        rotations[tool] = Rotation.from_matrix(on_flange[known & (set_up.tool == tool)]).mean().as_matrix()
    return replace(state, tool_rotations=rotations)


def _placed(set_up: SetUp, blank: State, most_steps: int) -> State:
    _, frames = set_up.frames(blank)
    turned = frames.tool_rotation
    flange = frames.tool - np.einsum("nij,nj->ni", turned, blank.tools[set_up.tool])
    free = set_up.free("nominal")
    candidates = []
    for trust_nominal in (True, False):
        rotations, translations, tools = blank.rotations.copy(), blank.translations.copy(), []
        for base in range(len(set_up.base_names)):
            rows = set_up.base == base
            if not rows.any():  # part of a table: what has no row stays where it is
                continue
            found = starts(flange[rows], turned[rows], set_up.tool[rows], set_up.measured[rows], blank.tools)
            placement = found[0 if trust_nominal else -1]
            rotations[base], translations[base] = placement.rotation, placement.translation
            tools.append(placement.tools)
        start = replace(
            blank, rotations=rotations, translations=translations, tools=_mean_known(np.array(tools), blank.tools)
        )
        candidates.append(least_squares(set_up, start, free, most_steps=most_steps).state)
    return min(candidates, key=lambda state: float(np.sum(set_up.residuals(state) ** 2)))


def _mean_known(tools: Array, otherwise: Array) -> Array:
    known = np.isfinite(tools)
    sums = np.where(known, tools, 0.0).sum(axis=0)
    return np.where(known.any(axis=0), sums / np.maximum(known.sum(axis=0), 1), otherwise)
