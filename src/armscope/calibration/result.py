"""What a calibration found: constants with covariance, frames, held-out errors, and all of it in words."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.calibration.confounding import Confounded
from armscope.calibration.constants import CALIBRATING, SIZES
from armscope.calibration.fit import placed
from armscope.calibration.geometry import State, nominal_values
from armscope.calibration.held_out import foretold, parts_to_test
from armscope.calibration.model import Level, SetUp
from armscope.core.averages import rms_distance
from armscope.core.told import InWords
from armscope.core.types import Array
from armscope.recordings import Recordings
from armscope.robot import Arm

ALL = "all"


# so many parameters: a table and its calibration (three), how that is done again (one), and how it is tested (two)
def misses_by_run(
    rows: SetUp, recordings: Recordings, fitted: State, refit: Callable[[SetUp], State], splits: int, parameters: int
) -> pd.DataFrame:
    """RMS of the 3D distance by run, and of all rows.

    Args:
        rows: the set-up of the whole table.
        recordings: the table.
        fitted: the calibration of all rows.
        refit: the same calibration of some of the rows.
        splits: how often 70 % of the configurations are drawn to learn from; see `parts_to_test` of short tables.
        parameters: how many are fitted.

    Returns:
        run ("all" first), rows, in_sample_mm, held_out_mm and held_out_std_mm (mean and standard deviation over the
        splits), frames_only_mm (held out with base and tool alone). A row is tested only where its base and tool were
        learned.
    """
    without = replace(rows, orientations=None)
    names = [ALL, *dict.fromkeys(recordings.run.tolist())]
    if len(names) == 2:
        names = names[:1]
    of_run = {name: np.full(len(rows), True) if name == ALL else recordings.run == name for name in names}
    whole = without.residuals(fitted)
    held: dict[str, list[float]] = {name: [] for name in names}
    alone: dict[str, list[float]] = {name: [] for name in names}
    for seed, pairs in enumerate(parts_to_test(recordings, splits, parameters)):
        tested, found, frames = [], np.empty_like(whole), np.empty_like(whole)
        for train, test in pairs:
            if len(train) > CALIBRATING.rows_of_runs:
                train = np.sort(np.random.default_rng(seed).permutation(train)[: CALIBRATING.rows_of_runs])
            test = foretold(rows, train, test)
            found[test] = without.residuals(refit(rows.rows(train)))[test]
            frames[test] = without.residuals(placed(without.rows(train)))[test]
            tested.append(test)
        for name in names:
            mine = np.concatenate(tested)
            mine = mine[of_run[name][mine]]
            if len(mine):
                held[name].append(1e3 * rms_distance(found[mine]))
                alone[name].append(1e3 * rms_distance(frames[mine]))
    return pd.DataFrame(
        {
            "run": names,
            "rows": [int(of_run[name].sum()) for name in names],
            "in_sample_mm": [1e3 * rms_distance(whole[of_run[name]]) for name in names],
            "held_out_mm": [_mean(held[name]) for name in names],
            "held_out_std_mm": [float(np.std(held[name])) if held[name] else np.nan for name in names],
            "frames_only_mm": [_mean(alone[name]) for name in names],
        }
    )


def no_gain(misses: pd.DataFrame | None) -> bool:
    """Whether poses that took no part are foretold no better than by base and tool alone."""
    return misses is not None and bool(misses["held_out_mm"].iloc[0] >= misses["frames_only_mm"].iloc[0])


def _mean(values: list[float]) -> float:
    return float(np.mean(values)) if values else np.nan


SHOWN = {"m": (1e3, "mm"), "rad": (1e3, "mrad"), "rad/(N m)": (1e6, "µrad/(N m)")}  # Factor and unit for reading
UNDETERMINED = {"m": SIZES.length_m, "rad": SIZES.angle_rad, "rad/(N m)": SIZES.compliance_rad_nm}
"""Standard errors from which rows say less of a constant than what is plausible of any arm."""


@dataclass(frozen=True, eq=False, repr=False)
class Calibration(InWords):
    """A calibrated arm."""

    level: Level  # what was free beyond base and tool
    set_up: SetUp  # rows, frames and the nominal arm
    state: State
    free: NDArray[np.bool_]  # (P,) which parameters were fitted
    weights: Array  # (N,) of the rows; all 1 without the robust option
    covariance: Array  # (free, free) of the fitted parameters, in their units; base parameters as twists in base axes
    steps: int
    reason: str  # why the fit stopped
    suspects: NDArray[np.bool_]  # (N,) rows that look like bad shots: beyond six times the spread
    ids: NDArray[np.str_]  # (N,) the rows' ids, "run: id"
    notes: tuple[str, ...] = ()  # what was decided: orientations used or left out, tools free per run
    doubts: tuple[str, ...] = ()  # why the result should not be used; empty if all is well
    # parameters of the level that stay nominal, since the poses cannot tell them from others, and from which
    held: tuple[Confounded, ...] = ()
    misses: pd.DataFrame | None = None  # in-sample and held-out RMS by run, see `misses_by_run`; None if not asked for

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
    def rms_without_compliances(self) -> float | None:
        """The same, m, of the arm's constants alone, as a controller takes them; None where no compliance is fitted."""
        if not self.state.compliances.any():
            return None
        rigid = replace(self.state, compliances=np.zeros_like(self.state.compliances))
        return rms_distance(self.set_up.residuals(rigid))

    @property
    def nominal_serves(self) -> bool:
        """Whether constants were fitted that help no pose that took no part: base and tool alone do as well."""
        return self.level != "nominal" and no_gain(self.misses)

    @property
    def table(self) -> pd.DataFrame:
        """One row per fitted parameter: name, unit, value (of the arm's constants: the change), stderr, nominal.

        Base frames: position and rotation vector, their standard errors along and about the base's own axes. Nominal
        values stand beside D-H constants and tool points.
        """
        from scipy.spatial.transform import Rotation  # slow to import

        base = np.concatenate([self.state.translations, Rotation.from_matrix(self.state.rotations).as_rotvec()], axis=1)
        turns = Rotation.from_matrix(self.state.tool_rotations).as_rotvec()
        state, rows = self.state, self.set_up
        values = np.concatenate([base.ravel(), state.tools.ravel(), state.constants, state.compliances, turns.ravel()])
        nominal = np.full(len(values), np.nan)
        tools = slice(base.size, base.size + state.tools.size)
        nominal[tools] = np.tile(rows.arm.tool, len(rows.tool_names))
        nominal[tools.stop : tools.stop + len(rows.constants)] = nominal_values(rows.arm, rows.constants)
        return pd.DataFrame(
            {
                "parameter": np.array(rows.names)[self.free],
                "unit": np.array(rows.units)[self.free],
                "value": values[self.free],
                "stderr": np.sqrt(np.diag(self.covariance)),
                "nominal": nominal[self.free],
            }
        )

    @property
    def held_table(self) -> pd.DataFrame:
        """One row per parameter held: parameter, imitated_by (joined by " + "), share_left of what it does."""
        return pd.DataFrame(
            [(each.name, " + ".join(each.partners), each.left) for each in self.held],
            columns=["parameter", "imitated_by", "share_left"],
        )

    @property
    def covariance_table(self) -> pd.DataFrame:
        """Covariance of the fitted parameters, in products of their units: parameter, and one column of each."""
        names = np.array(self.set_up.names)[self.free]
        return pd.DataFrame(self.covariance, columns=names).assign(parameter=names)[["parameter", *names]]

    def sentences(self) -> tuple[str, ...]:
        """Rows and parameters, what it leaves, why it is doubtful, and what holds the rest."""
        held = f", {len(self.held)} more held at nominal" if self.held else ""
        return (
            f"{_about(self)}{held}.",
            f"{_misses(self)[0]}.",
            *(f"Doubtful: {doubt}." for doubt in self.doubts),
            "text() says all of it, table has the numbers, arm is the corrected arm.",
        )

    def text(self) -> str:
        """The calibration in words, lengths in mm and angles in mrad."""
        return in_words(self)


def in_words(calibration: Calibration) -> str:
    """Lengths in mm, angles in mrad, compliances in µrad/(N m); what D-H constants become as in robot.yaml."""
    arm = calibration.set_up.arm
    lines = [_about(calibration)]
    lines += _misses(calibration)
    if arm.description.urdf is not None and arm.description.actuation is None:
        motors = ", ".join(f"q{motor} {name}" for motor, name in enumerate(arm.joint_names, start=1))
        lines.append(f"motors: {motors}")
    lines += _elastic(calibration)
    lines += calibration.notes
    lines += [f"doubtful: {doubt}" for doubt in calibration.doubts]
    if len(suspects := calibration.ids[calibration.suspects]):
        more = ", ..." if len(suspects) > CALIBRATING.suspects else ""
        look = "row looks like a bad shot" if len(suspects) == 1 else "rows look like bad shots"
        lines.append(f"{len(suspects)} {look}: {', '.join(suspects[: CALIBRATING.suspects])}{more}")
    lines.append("fitted, with standard errors (of base frames: along and about the base's own axes):")
    lines += [_parameter(*row) for row in calibration.table.itertuples(index=False)]
    if calibration.held:
        lines.append("held at nominal: from these poses not told apart from what moves the tool alike (the standard")
        lines.append("errors above are right if it is exactly nominal: where it is off, those named here take it up):")
        lines += [f"  {each.text()}" for each in calibration.held]
    return "\n".join(lines)


def _about(calibration: Calibration) -> str:
    rows, parameters = len(calibration.set_up), int(calibration.free.sum())
    return f"{calibration.set_up.arm.name}: {calibration.level} calibration on {rows} rows, {parameters} parameters"


def _parameter(name: str, unit: str, value: float, stderr: float, nominal: float) -> str:
    factor, shown = SHOWN[unit]
    beside = ""
    if not np.isnan(nominal):
        beside = f"  (nominal {nominal * factor:.6g} {shown})"
        if name.startswith("joint "):  # the value is a change
            after = nominal + value
            becomes = f"{np.degrees(after):.5g} deg" if unit == "rad" else f"{1e3 * after:.6g} mm"
            beside = f"  (becomes {becomes})" if stderr < UNDETERMINED[unit] else "  (undetermined: see its error)"
    return f"  {name:<28} {value * factor:12.5g} +- {stderr * factor:.2g} {shown}{beside}"


def _elastic(calibration: Calibration) -> list[str]:
    """That constants which were fitted beside compliances hold only together with them."""
    alone = calibration.rms_without_compliances
    if alone is None or calibration.nominal_serves:  # then they are not written
        return []
    return [
        f"the constants hold together with the compliances, which are in frames.yaml (robot.yaml and URDF have no "
        f"place for them): without them {alone * 1e3:.4g} mm are left of these rows, with them "
        f"{calibration.rms_distance * 1e3:.4g} mm. A controller without such a model wants `--level geometric`"
    ]


def _misses(calibration: Calibration) -> list[str]:
    stopped = f"after {calibration.steps} steps; {calibration.reason}"
    if calibration.misses is None:
        return [f"RMS of the 3D distance {calibration.rms_distance * 1e3:.4g} mm {stopped}"]
    lines = []
    for run, _, inside, held, spread, alone in calibration.misses.itertuples(index=False):
        where = "RMS of the 3D distance" if run == ALL else f"  run {run}:"
        outside = f"held out {held:.4g} +- {spread:.2g} mm (base and tool alone {alone:.4g} mm)"
        lines.append(f"{where} {inside:.4g} mm on the rows fitted, {outside if np.isfinite(held) else 'none held out'}")
    return [*lines, stopped]
