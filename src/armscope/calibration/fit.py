"""Least squares with the exact model and exact columns: damped Gauss-Newton, weights against bad shots, covariance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armscope.calibration.constants import FITTING
from armscope.calibration.geometry import Posed, State
from armscope.calibration.model import SetUp
from armscope.core.types import Array
from armscope.fitting.gauss_newton import NonlinearProblem, Quadratic, Reason, gauss_newton
from armscope.fitting.placement import FlangePoses, all_alike, place_frames
from armscope.measurement import robust

Rule = Callable[[Array], Array]  # (N,) weights by what is left of the points (N, 3), m


@dataclass(frozen=True, eq=False)
class Fitted:
    """Where a fit ended: values, weights of the rows (N,), steps made, and why it stopped."""

    state: State
    weights: Array
    steps: int
    reason: Reason


class _Calibration(NonlinearProblem[State, Posed]):
    """Some of a set-up's parameters, each held near zero by its own stiffness."""

    least_damping = FITTING.least_damping

    def __init__(self, set_up: SetUp, free: NDArray[np.bool_], stiffness: Array, rule: Rule) -> None:
        self.set_up, self.free, self.stiffness, self.rule = set_up, free, stiffness, rule
        self.weights = np.ones(len(set_up))

    def residual(self, state: State) -> Posed:
        return self.set_up.posed(state)

    def quadratic(self, state: State, residual: Posed) -> Quadratic:
        self.weights = self.rule(residual.left[:, :3])
        X = self.set_up.jacobian(state, residual, self.free)
        weighted = X * np.repeat(self.weights, residual.left.shape[1])[:, None]
        held = self.stiffness[self.free]
        right = weighted.T @ residual.left.ravel() - held * _changes(state)[self.free]
        return Quadratic(weighted.T @ X + np.diag(held), right, np.zeros(len(held)))

    def misfit(self, state: State, residual: Posed) -> float:
        return float(self.weights @ np.sum(residual.left**2, axis=1) + self.stiffness @ _changes(state) ** 2)

    def moved(self, state: State, step: Array) -> State:
        whole = np.zeros(len(self.free))
        whole[self.free] = step
        return state.moved(whole)

    def settled(self, before: Posed, after: Posed) -> bool:
        return float(np.sqrt(np.mean((after.left - before.left) ** 2))) < FITTING.negligible_m


def least_squares(
    set_up: SetUp, state: State, free: NDArray[np.bool_], stiffness: Array | None = None, rule: Rule = all_alike
) -> Fitted:
    """Minimise sum of weights * squared residuals + sum of stiffness * squared change, from ``state``.

    Args:
        set_up: rows and arm.
        state: the start.
        free: (P,) which parameters move.
        stiffness: (P,) m^2 per squared unit, holds parameters near zero (a prior); None holds none.
        rule: weights of the rows by what is left of them; all count alike where not given.

    Returns:
        The state, weights, steps, and why it stopped.
    """
    problem = _Calibration(set_up, free, np.zeros(len(free)) if stiffness is None else stiffness, rule)
    found = gauss_newton(problem, state, FITTING.steps)
    return Fitted(found.state, problem.weights, found.steps, found.reason)


def _changes(state: State) -> Array:
    """What priors hold near zero; frames are counted from where they start, and are never held."""
    n_frames, n_turns = 6 * len(state.rotations) + 3 * len(state.tools), 3 * len(state.tools)
    return np.concatenate([np.zeros(n_frames), state.constants, state.compliances, np.zeros(n_turns)])


def robust_least_squares(
    set_up: SetUp, state: State, free: NDArray[np.bool_], stiffness: Array | None = None
) -> Fitted:
    """As `least_squares`, with the weights of the diagnosis: bad shots lose their say, and keep their rows.

    Huber's weights come first, since those that fall with the fourth power are only safe near their solution.

    Args:
        set_up: rows and arm.
        state: the start.
        free: (P,) which parameters move.
        stiffness: (P,) m^2 per squared unit; None holds none.

    Returns:
        As `least_squares`, with the final weights (N,).
    """
    steps = 0
    for rule in (all_alike, _huber, _quartic):
        fitted = least_squares(set_up, state, free, stiffness, rule)
        state, steps = fitted.state, steps + fitted.steps
    return replace(fitted, steps=steps)


def _huber(left: Array) -> Array:
    return robust.huber_weights(left, np.ones(len(left)), 0.0)


def _quartic(left: Array) -> Array:
    return robust.quartic_weights(left, np.ones(len(left)), 0.0)


def placed(set_up: SetUp, most_steps: int = FITTING.steps) -> State:
    """Base frames and tools of the nominal arm, from closed-form starts refined; the start of every calibration.
    ``most_steps``: of refinement; a few are enough to see whether an arm explains its points at all."""
    frames, n_bases, n_tools = set_up.nominal_frames, len(set_up.base_names), len(set_up.tool_names)
    flange = frames.tool - frames.tool_rotation @ set_up.arm.tool
    poses = FlangePoses(flange, frames.tool_rotation, set_up.measured, set_up.base, set_up.tool)
    tools = np.tile(set_up.arm.tool, (n_tools, 1))
    # the second start fails where the poses hardly turn, the first where the tool is far from nominal
    starts = [start for start in (poses.start(tools, n_bases), poses.start_of_far_tools(tools, n_bases)) if start]
    tried = [place_frames(poses, start, most_steps, all_alike, tools) for start in starts]
    found = min(tried, key=lambda each: float(np.sum(each.residual**2))).state
    state = State(
        found.rotations,
        found.translations,
        found.tools,
        constants=np.zeros(len(set_up.constants)),
        compliances=np.zeros(set_up.arm.n_motors),
        tool_rotations=np.tile(np.eye(3), (n_tools, 1, 1)),
    )
    return with_tool_rotations(set_up, state)


def with_tool_rotations(set_up: SetUp, state: State) -> State:
    """The state with each tool's mean orientation on the flange, where orientations are used."""
    if set_up.orientations is None:
        return state
    from scipy.spatial.transform import Rotation  # slow to import, and few tables hold orientations

    _, frames = set_up.frames(state)
    known = np.isfinite(set_up.orientations).all(axis=(1, 2))
    seen = np.swapaxes(state.rotations[set_up.base], 1, 2) @ set_up.orientations
    on_flange = np.swapaxes(frames.tool_rotation, 1, 2) @ seen
    rotations = state.tool_rotations.copy()
    for tool in np.unique(set_up.tool[known]):
        rotations[tool] = Rotation.from_matrix(on_flange[known & (set_up.tool == tool)]).mean().as_matrix()
    return replace(state, tool_rotations=rotations)
