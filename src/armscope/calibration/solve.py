"""One solution of a set-up: what is free, how redundant parameters are held, and how orientations weigh."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from armscope.calibration.constants import FITTING, IDENTIFYING, SIZES
from armscope.calibration.fit import Fitted, least_squares, placed, robust_least_squares
from armscope.calibration.geometry import State
from armscope.calibration.model import Level, SetUp
from armscope.core.types import Array, Indices
from armscope.design.independence import independent_columns
from armscope.fitting.gauge import FrameColumns, gauge
from armscope.measurement.robust import scale_of


def identifiable(jacobian: Array, tiers: Indices, scales: Array) -> NDArray[np.bool_]:
    """The columns that can be told apart, a lower tier first (`armscope.design.independence`).

    Args:
        jacobian: (M, P).
        tiers: (P,) order of preference: what base frame and first joint have in common is settled for the base.
        scales: (P,) size of a unit in each column's own unit (1 m; 1 rad / reach), so that columns compare.

    Returns:
        (P,) boolean.
    """
    triangular = np.linalg.qr(jacobian, mode="r") if len(jacobian) > jacobian.shape[1] else jacobian
    return independent_columns(triangular * scales / np.sqrt(len(jacobian) / 3), tiers, IDENTIFYING.smallest_trace)


Redundancy = Literal["fixed", "priors"]


@dataclass(frozen=True)
class Priors:
    """1-sigma sizes by which redundant parameters are held near nominal, and the noise they are weighed against.

    Defaults: those of the reference figures.
    """

    length: float = SIZES.length_m
    angle: float = SIZES.angle_rad
    compliance: float = SIZES.compliance_rad_nm
    noise: float = SIZES.noise_m


@dataclass(frozen=True, eq=False)
class Solved:
    """A set-up (with the lever that was found), its fit, what was free and how stiffly it was held."""

    rows: SetUp
    fitted: Fitted
    free: NDArray[np.bool_]
    stiffness: Array


def solve(
    rows: SetUp, level: Level, redundancy: Redundancy, priors: Priors, robust: bool = False, start: State | None = None
) -> Solved:
    """Fit a level to a set-up.

    Args:
        rows: measurements and frames.
        level: what is free beyond base and tool.
        redundancy: parameters that imitate each other are "fixed" at nominal until the rest can be told apart, or all
            free and held by "priors".
        priors: their sizes.
        robust: take the say from bad shots.
        start: of the fit; None places base and tools first.

    Returns:
        The fit, which parameters were free, and what held the others.
    """
    solver = robust_least_squares if robust else least_squares
    start = placed(rows) if start is None else start
    for _ in range(FITTING.weighings if rows.orientations is not None else 1):
        rows = _weighed(rows, start)
        free, stiffness = _freedom(rows, start, level, redundancy, priors)
        fitted = solver(rows, start, free, stiffness)
        start = fitted.state
    held = _tools_as_stated(rows, fitted, free, stiffness)
    if held is not None:
        start, free = held
        fitted = solver(rows, start, free, stiffness)
    return Solved(rows, fitted, free, stiffness)


def _tools_as_stated(
    rows: SetUp, fitted: Fitted, free: NDArray[np.bool_], stiffness: Array
) -> tuple[State, NDArray[np.bool_]] | None:
    """Where to fit again from, and what is free, if tool points are as stated that rows do not tell from the base."""
    _, jacobian = rows.linearised(fitted.state, free)
    weighted = jacobian * np.repeat(fitted.weights, len(jacobian) // len(rows))[:, None]
    information = 1e6 * weighted.T @ jacobian
    columns, n_bases, n_tools = np.flatnonzero(free), 6 * len(rows.base_names), 3 * len(rows.tool_names)
    tools = (columns >= n_bases) & (columns < n_bases + n_tools)
    if not tools.any():
        return None
    deviation = (fitted.state.tools - rows.arm.tool).reshape(-1)[columns[tools] - n_bases]
    at = FrameColumns(np.flatnonzero(columns < n_bases + n_tools), np.flatnonzero(tools))
    noise_mm = 1e3 * scale_of(rows.residuals(fitted.state))
    found = gauge(information + 1e6 * np.diag(stiffness[free]), information, at, deviation, noise_mm)
    if found is None:
        return None
    step, left = np.zeros(len(free)), free.copy()
    step[columns] = found.step
    held = scipy.linalg.qr(found.directions.T, mode="r", pivoting=True)[1][: found.directions.shape[1]]
    left[columns[at.tools[held]]] = False
    return fitted.state.moved(step), left


def _weighed(rows: SetUp, state: State) -> SetUp:
    """The lever by which a turn counts as much as a shift: the ratio of their scatter, by medians."""
    if rows.orientations is None:
        return rows
    known = np.isfinite(rows.orientations).all(axis=(1, 2))
    return replace(rows, lever=scale_of(rows.residuals(state)) / scale_of(rows.turn_residuals(state)[known]))


def _freedom(
    rows: SetUp, start: State, level: Level, redundancy: Redundancy, priors: Priors
) -> tuple[NDArray[np.bool_], Array]:
    """Which parameters are fitted, and how stiffly they are held."""
    free = rows.free(level)
    if redundancy == "priors":
        return free, _stiffness(rows, priors)
    _, jacobian = rows.linearised(start, free)
    chosen = free.copy()
    chosen[free] = identifiable(jacobian, rows.tiers[free], scales_of(rows)[free])
    return chosen, np.zeros(len(free))


def _stiffness(rows: SetUp, priors: Priors) -> Array:
    sizes = {"m": priors.length, "rad": priors.angle, "rad/(N m)": priors.compliance}
    stiffness = np.array([(priors.noise / sizes[unit]) ** 2 for unit in rows.units])
    n_tool = 3 * len(rows.tool_names)
    stiffness[: 6 * len(rows.base_names) + n_tool] = 0.0
    stiffness[-n_tool:] = 0.0
    return stiffness


def scales_of(rows: SetUp) -> Array:
    """Sizes that make columns comparable: 1 m, and the angle that moves the tool by 1 m at full reach."""
    load = 1.0 if rows.loads is None else max(float(np.sqrt(np.mean(rows.loads**2))), FITTING.no_load_nm)
    size = {"m": 1.0, "rad": 1 / rows.arm.reach, "rad/(N m)": 1 / (rows.arm.reach * load)}
    return np.array([size[unit] for unit in rows.units])
