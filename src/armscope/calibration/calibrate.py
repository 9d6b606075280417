"""Plain geometric calibration: base, tools and the identifiable constants from measured points, with covariance."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from armscope.calibration.fit import rms_distance, spread_of
from armscope.calibration.model import Level, SetUp, State, set_up
from armscope.calibration.solve import Priors, Redundancy, Solved, solve
from armscope.calibration.splits import split
from armscope.inputs import InputError
from armscope.recordings import Recordings
from armscope.robot import Arm

Array = NDArray[np.float64]
SUSPECT_SIGMAS = 6.0
DECIDING_SPLITS = 3
"""Splits on which it is decided whether orientations help."""

DECIDING_ROWS = 1000
"""Rows to train on that are enough for this decision; long tables are thinned."""

HARM = 1.01
"""Orientations are left out if they raise the held-out RMS of positions by more than this factor."""


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
        note: why orientations were used or left out; empty where there are none.
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
    note: str = ""

    @functools.cached_property
    def arm(self) -> Arm:
        """The corrected arm with the nominal tool; the fitted tools stand in `state.tools`."""
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
        arm = self.set_up.arm
        lines = [
            f"{arm.name}: {self.level} calibration on {n_rows} rows, {int(self.free.sum())} parameters",
            f"RMS of the 3D distance {self.rms_distance * 1e3:.4g} mm after {self.steps} steps; {self.reason}",
        ]
        if arm.description.urdf is not None and arm.description.actuation is None:
            motors = ", ".join(f"q{motor} {name}" for motor, name in enumerate(arm.joint_names, start=1))
            lines.append(f"motors: {motors}")
        if self.note:
            lines.append(self.note)
        if self.held:
            lines.append("held at nominal, not identifiable from these poses: " + ", ".join(self.held))
        if len(suspects):
            more = ", ..." if len(suspects) > 12 else ""
            lines.append(f"{len(suspects)} rows look like bad shots: " + ", ".join(suspects[:12]) + more)
        for name, unit, value, error in self.table.itertuples(index=False):
            shown = {"m": "mm", "rad": "mrad", "rad/(N m)": "mrad/(N m)"}[unit]
            lines.append(f"  {name:<28} {value * 1e3:12.5g} +- {error * 1e3:.2g} {shown}")
        return "\n".join(lines)


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
    orientation: bool | None = None,
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
        orientation: use measured orientations, weighed by the scatter that positions and orientations show; None uses
            them unless positions of rows that took no part are then predicted worse, which happens where an arm errs
            more in orientation than its constants can say.

    Raises:
        InputError: another number of motors than the arm's, or fewer measured numbers than parameters.
    """
    priors = priors or Priors()

    rows = set_up(arm, recordings, one_base, tool_per_run, orientation is not False)
    without = replace(rows, orientations=None)

    def solved_for(some: SetUp) -> Solved:
        return solve(some, level, redundancy, priors, robust)

    note = ""
    if orientation is None and rows.orientations is not None:
        helps, note = _orientation_helps(rows, without, recordings, solved_for)
        rows = rows if helps else without
    solved = solved_for(rows)
    _require_rows(recordings, solved, redundancy)
    rows, fitted = solved.rows, solved.fitted
    distance = np.linalg.norm(rows.residuals(fitted.state), axis=1)
    ids = [f"{run}: {name}" if run else name for run, name in zip(recordings.run, recordings.id, strict=True)]
    return Calibration(
        level=level,
        set_up=rows,
        state=fitted.state,
        free=solved.free,
        weights=fitted.weights,
        covariance=_covariance(solved),
        steps=fitted.steps,
        reason=fitted.reason,
        suspects=distance > SUSPECT_SIGMAS * spread_of(distance),
        ids=np.array(ids),
        note=note,
    )


def _orientation_helps(
    rows: SetUp, without: SetUp, recordings: Recordings, solved_for: Callable[[SetUp], Solved]
) -> tuple[bool, str]:
    """Whether positions of rows that took no part are predicted as well with orientations as without."""
    found = []
    for variant in (without, rows):
        squares = []
        for seed in range(DECIDING_SPLITS):
            train, test = split(recordings, seed)
            train = train[:: max(1, len(train) // DECIDING_ROWS)]
            fitted = solved_for(variant.rows(train)).fitted
            squares.append(rms_distance(without.rows(test).residuals(fitted.state)) ** 2)
        found.append(1e3 * float(np.sqrt(np.mean(squares))))
    helps = found[1] <= HARM * found[0]
    said = f"held-out RMS distance {found[1]:.3g} mm with them, {found[0]:.3g} mm without"
    return helps, f"orientations {'used' if helps else 'left out'}: {said}"


def _require_rows(recordings: Recordings, solved: Solved, redundancy: Redundancy) -> None:
    needed, n_rows = int(solved.free.sum()), len(solved.rows)
    if redundancy == "fixed" and 3 * n_rows <= needed:
        raise InputError(
            recordings.source,
            "",
            f"{n_rows} rows",
            f"{needed} parameters need more than {needed // 3} measured points",
            "Measure more poses, or free fewer parameters (level nominal or offsets).",
        )


def _covariance(solved: Solved) -> Array:
    """Covariance of the fitted parameters, with the noise that the residuals show.

    Without weights sigma^2 (J'J + priors)^-1; with weights the sandwich of Huber (1981), which counts how the
    residuals of each row really scatter.
    """
    fitted, free = solved.fitted, solved.free
    residual, jacobian = solved.rows.linearised(fitted.state, free)
    per_row = len(residual) // len(solved.rows)
    per_component = np.repeat(fitted.weights, per_row)
    normal = (jacobian * per_component[:, None]).T @ jacobian + np.diag(solved.stiffness[free])
    inverse = np.linalg.pinv(normal, hermitian=True, rcond=1e-15)
    freedom = max(len(residual) - int(free.sum()), 1)
    if np.all(fitted.weights == 1):
        return inverse * float(residual @ residual) / freedom
    weighed = (per_component * residual).reshape(-1, per_row)
    pull = np.einsum("nc,ncp->np", weighed, jacobian.reshape(-1, per_row, free.sum()))
    return inverse @ (pull.T @ pull) @ inverse * len(residual) / freedom
