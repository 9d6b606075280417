"""Plain geometric calibration: base, tools and the identifiable constants from measured points, with covariance."""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from armscope.calibration.fit import Fitted, least_squares, placed, robust_least_squares, spread_of
from armscope.calibration.identifiability import identifiable
from armscope.calibration.model import Level, SetUp, State, set_up
from armscope.inputs import InputError
from armscope.recordings import Recordings
from armscope.robot import Arm

Array = NDArray[np.float64]
Redundancy = Literal["fixed", "priors"]
SUSPECT_SIGMAS = 6.0
WEIGHINGS = 3
"""Fits with orientations: the weight of the first comes from the nominal arm, that of the next from the fit before."""


@dataclass(frozen=True)
class Priors:
    """1-sigma sizes by which redundant parameters are held near nominal, and the noise they are weighed against.

    Defaults: those of the reference figures.
    """

    length: float = 3e-3
    angle: float = 5e-3
    compliance: float = 1e-3
    noise: float = 1e-4


@dataclass(frozen=True, eq=False)
class Calibration:
    """A calibrated arm.

    Attributes:
        level: what was free beyond base and tool.
        set_up: rows, frames and the nominal arm.
        state: the fitted values.
        free: (P,) which parameters were fitted.
        weights: (N,) of the rows; all 1 without the robust option.
        covariance: (free, free) of the fitted parameters, in their units; base parameters as twists in base axes.
        steps: Gauss-Newton steps made.
        reason: why the fit stopped.
        suspects: (N,) rows that look like bad shots: beyond six times the spread.
        ids: (N,) the rows' ids, "run: id".
    """

    level: Level
    set_up: SetUp
    state: State
    free: NDArray[np.bool_]
    weights: Array
    covariance: Array
    steps: int
    reason: str
    suspects: NDArray[np.bool_]
    ids: NDArray[np.str_]

    @functools.cached_property
    def arm(self) -> Arm:
        """The corrected arm; its tool is that of the first target."""
        return self.set_up.frames(self.state)[0]

    @functools.cached_property
    def residuals(self) -> Array:
        """(N, 3) measured minus predicted, measurement frame, m."""
        return self.set_up.residuals(self.state)

    @property
    def rms_distance(self) -> float:
        """Root mean square of the 3D distance over the rows, m."""
        return rms_distance(self.residuals)

    @property
    def held(self) -> tuple[str, ...]:
        """Parameters of the level that the poses can't tell apart from others, held at nominal."""
        wanted = self.set_up.free(self.level)
        return tuple(name for name, want, free in zip(self.set_up.names, wanted, self.free, strict=True) if want > free)

    @property
    def table(self) -> pd.DataFrame:
        """One row per fitted parameter: name, unit, value (of the arm's constants: the change), stderr."""
        base = np.concatenate([self.state.translations, Rotation.from_matrix(self.state.rotations).as_rotvec()], axis=1)
        turns = Rotation.from_matrix(self.state.tool_rotations).as_rotvec()
        state = self.state
        values = np.concatenate([base.ravel(), state.tools.ravel(), state.constants, state.compliances, turns.ravel()])
        return pd.DataFrame(
            {
                "parameter": np.array(self.set_up.names)[self.free],
                "unit": np.array(self.set_up.units)[self.free],
                "value": values[self.free],
                "stderr": np.sqrt(np.diag(self.covariance)),
            }
        )

    def text(self) -> str:
        """The calibration in words, lengths in mm and angles in mrad."""
        n_rows, suspects = len(self.set_up), self.ids[self.suspects]
        lines = [
            f"{self.set_up.arm.name}: {self.level} calibration on {n_rows} rows, {int(self.free.sum())} parameters",
            f"RMS of the 3D distance {self.rms_distance * 1e3:.4g} mm after {self.steps} steps; {self.reason}",
        ]
        if self.held:
            lines.append("held at nominal, not identifiable from these poses: " + ", ".join(self.held))
        if len(suspects):
            more = ", ..." if len(suspects) > 12 else ""
            lines.append(f"{len(suspects)} rows look like bad shots: " + ", ".join(suspects[:12]) + more)
        for name, unit, value, error in self.table.itertuples(index=False):
            shown = {"m": "mm", "rad": "mrad", "rad/(N m)": "mrad/(N m)"}[unit]
            lines.append(f"  {name:<28} {value * 1e3:12.5g} +- {error * 1e3:.2g} {shown}")
        return "\n".join(lines)


def rms_distance(residuals: Array) -> float:
    """Root mean square of the 3D distance of residuals (N, 3)."""
    return float(np.sqrt(np.mean(np.sum(residuals**2, axis=1))))


def calibrate(
    arm: Arm,
    recordings: Recordings,
    level: Level = "geometric",
    *,
    redundancy: Redundancy = "fixed",
    priors: Priors | None = None,
    robust: bool = False,
    one_base: bool = False,
    tool_per_run: bool = False,
    orientation: bool = True,
) -> Calibration:
    """Fit base frames, tools and the arm's constants to measured positions, and orientations where there are any.

    Args:
        arm: the nominal arm.
        recordings: measured points; base free per run, tool per target.
        level: what is free beyond base and tool, see `model.LEVELS`.
        redundancy: parameters that imitate each other are "fixed" at nominal until the rest can be told apart
            (rank-revealing QR), or all free and held by "priors".
        priors: sizes for `redundancy` "priors"; None takes the defaults.
        robust: take the say from bad shots (Tukey's biweight).
        one_base: one base frame for all runs.
        tool_per_run: a tool of its own for every run.
        orientation: use measured orientations, each weighed by the scatter that positions and orientations show.

    Raises:
        InputError: another number of motors than the arm's, or fewer measured numbers than parameters.
    """
    priors = priors or Priors()
    rows = set_up(arm, recordings, one_base, tool_per_run, orientation)
    start = placed(rows)
    for _ in range(WEIGHINGS if rows.orientations is not None else 1):
        rows = _weighed(rows, start)
        free, stiffness = freedom(rows, start, level, redundancy, priors)
        _require_rows(recordings, rows, free, redundancy)
        fitted = fit(rows, start, free, stiffness, robust)
        start = fitted.state
    distance = np.linalg.norm(rows.residuals(fitted.state), axis=1)
    ids = [f"{run}: {name}" if run else name for run, name in zip(recordings.run, recordings.id, strict=True)]
    return Calibration(
        level=level,
        set_up=rows,
        state=fitted.state,
        free=free,
        weights=fitted.weights,
        covariance=_covariance(rows, fitted, free, stiffness),
        steps=fitted.steps,
        reason=fitted.reason,
        suspects=distance > SUSPECT_SIGMAS * spread_of(distance),
        ids=np.array(ids),
    )


def _weighed(rows: SetUp, state: State) -> SetUp:
    """The lever by which a turn counts as much as a shift: the ratio of their scatter, by medians."""
    if rows.orientations is None:
        return rows
    known = np.isfinite(rows.orientations).all(axis=(1, 2))
    shift = np.linalg.norm(rows.residuals(state), axis=1)
    turn = np.linalg.norm(rows.turn_residuals(state)[known], axis=1)
    return replace(rows, lever=spread_of(shift) / spread_of(turn))


def fit(rows: SetUp, start: State, free: NDArray[np.bool_], stiffness: Array, robust: bool = False) -> Fitted:
    """Fit what is free from a start, with or without weights against bad shots."""
    solver = robust_least_squares if robust else least_squares
    return solver(rows, start, free, stiffness)


def freedom(
    rows: SetUp, start: State, level: Level, redundancy: Redundancy, priors: Priors
) -> tuple[NDArray[np.bool_], Array]:
    """Which parameters are fitted, and how stiffly they are held."""
    free = rows.free(level)
    if redundancy == "priors":
        return free, _stiffness(rows, priors)
    _, jacobian = rows.linearised(start, free)
    chosen = free.copy()
    chosen[free] = identifiable(jacobian, rows.tiers[free], _scales(rows)[free])
    return chosen, np.zeros(len(free))


def _stiffness(rows: SetUp, priors: Priors) -> Array:
    sizes = {"m": priors.length, "rad": priors.angle, "rad/(N m)": priors.compliance}
    stiffness = np.array([(priors.noise / sizes[unit]) ** 2 for unit in rows.units])
    n_tool = 3 * len(rows.tool_names)
    stiffness[: 6 * len(rows.base_names) + n_tool] = 0.0
    stiffness[-n_tool:] = 0.0
    return stiffness


def _scales(rows: SetUp) -> Array:
    """Sizes that make columns comparable: 1 m, and the angle that moves the tool by 1 m at full reach."""
    load = 1.0 if rows.loads is None else max(float(np.sqrt(np.mean(rows.loads**2))), 1e-9)
    size = {"m": 1.0, "rad": 1 / rows.arm.reach, "rad/(N m)": 1 / (rows.arm.reach * load)}
    return np.array([size[unit] for unit in rows.units])


def _require_rows(recordings: Recordings, rows: SetUp, free: NDArray[np.bool_], redundancy: Redundancy) -> None:
    needed = int(free.sum())
    if redundancy == "fixed" and 3 * len(rows) <= needed:
        raise InputError(
            recordings.source,
            "",
            f"{len(rows)} rows",
            f"{needed} parameters need more than {needed // 3} measured points",
            "Measure more poses, or free fewer parameters (level nominal or offsets).",
        )


def _covariance(rows: SetUp, fitted: Fitted, free: NDArray[np.bool_], stiffness: Array) -> Array:
    """Covariance of the fitted parameters, with the noise that the residuals show.

    Without weights sigma^2 (J'J + priors)^-1; with weights the sandwich of Huber (1981), which counts how the
    residuals of each row really scatter.
    """
    residual, jacobian = rows.linearised(fitted.state, free)
    per_row = len(residual) // len(rows)
    per_component = np.repeat(fitted.weights, per_row)
    normal = (jacobian * per_component[:, None]).T @ jacobian + np.diag(stiffness[free])
    inverse = np.linalg.pinv(normal, hermitian=True, rcond=1e-15)
    freedom = max(len(residual) - int(free.sum()), 1)
    if np.all(fitted.weights == 1):
        return inverse * float(residual @ residual) / freedom
    weighed = (per_component * residual).reshape(-1, per_row)
    pull = np.einsum("nc,ncp->np", weighed, jacobian.reshape(-1, per_row, free.sum()))
    return inverse @ (pull.T @ pull) @ inverse * len(residual) / freedom
