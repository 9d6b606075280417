"""What does not fit together: units, orders, frames and rows, each tried against the arm's kinematics.

Every suspicion is a trial: the table is changed as if a common mistake had been made, base and tool are fitted again,
and a mistake is only named where undoing it makes the arm explain the points, or the orientations, that it did not.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from armscope.calibration.fit import placed, rms_distance, robust_least_squares, spread_of
from armscope.calibration.model import SetUp, State, set_up
from armscope.check.contents import MOVED_RAD
from armscope.check.orientations import orientation_mistakes
from armscope.check.suspicion import Suspicion
from armscope.core.types import Array
from armscope.recordings import Recordings
from armscope.robot import Arm

MOST_ROWS = 400
"""Mistakes of a whole table show in a part of it: the trials look at so many rows, spread evenly."""

FITS = 0.05
"""A table fits an arm if base and tool leave at most this share of the points' spread."""

MOST_STEPS = 12
"""Steps of refinement per trial: the right one settles in fewer, a wrong one need not settle."""

ROWS_PER_PARAMETER = 2
"""Measured numbers per frame parameter below which anything fits."""

CLEARLY_BETTER = 0.3
"""Undoing a mistake must bring the misfit below this share."""

AS_GOOD = 1.05
"""Mistakes whose undoing leaves this many times the least are as good: some are the same to an arm's kinematics."""

MOST_ROWS_FOR_EXCHANGE = 20_000
FAR = 10
"""Rows further off than so many times the usual spread may have exchanged their points."""

TOOL_MOVED = 0.8
"""Tools of their own per run must bring the misfit below this share to be worth a hint."""


@dataclass(frozen=True)
class Consistency:
    """How well the nominal arm explains the points once base and tool are fitted: RMS distance and spread, m.

    ``rows`` is how many were looked at; in long tables they are spread evenly. ``orientations`` says whether measured
    orientations, if there are any, are the tool's.
    """

    rms: float
    spread: float
    rows: int
    suspicions: tuple[Suspicion, ...]
    orientations: bool = True


def against_arm(arm: Arm, recordings: Recordings) -> Consistency:
    """Try the common mistakes on a table.

    Args:
        arm: the nominal arm.
        recordings: the table as it was read.
    """
    if recordings.n_motors != arm.n_motors:
        statement = f"the table has {recordings.n_motors} motor angles, {arm.name} has {arm.n_motors} motors"
        wrong = Suspicion("problem", statement, "Is this the right robot for the recordings?")
        return Consistency(float("nan"), _spread(recordings), 0, (wrong,))
    some = _spread_evenly(recordings)
    rows = set_up(arm, some)
    if 3 * len(rows) < ROWS_PER_PARAMETER * rows.free("nominal").sum():
        hint = Suspicion("hint", "too few rows to fit base and tool, so nothing was tried against the arm")
        return Consistency(float("nan"), _spread(recordings), 0, (hint,))
    if np.ptp(recordings.motor_angles, axis=0).max() < MOVED_RAD:  # what is left is noise
        return Consistency(float("nan"), _spread(recordings), 0, ())
    state = placed(rows, MOST_STEPS)
    misfit = rms_distance(rows.residuals(state))
    spread = max(_spread(some), _predicted_spread(rows, state))
    found: list[Suspicion] = []
    turned: list[Suspicion] = []
    if _share_left(rows, state) > FITS:
        found += _moved_tools(arm, some, misfit, FITS) or [_explanation(arm, recordings)]
    else:
        found += _exchanged_rows(arm, recordings)
        turned = orientation_mistakes(rows, state, some.orientation)
        found += turned
        found += _moved_tools(arm, some, misfit)
    return Consistency(misfit, spread, len(some), (*found, *_outside_limits(arm, recordings)), orientations=not turned)


def _spread_evenly(recordings: Recordings) -> Recordings:
    if len(recordings) <= MOST_ROWS:
        return recordings
    return recordings.rows(np.unique(np.linspace(0, len(recordings) - 1, MOST_ROWS).astype(int)))


def _spread(recordings: Recordings) -> float:
    """RMS distance of the points from the mean of their run, m."""
    squares = 0.0
    for run in np.unique(recordings.run):
        points = recordings.positions[recordings.run == run]
        squares += float(np.sum((points - points.mean(axis=0)) ** 2))
    return float(np.sqrt(squares / len(recordings)))


def _share_left(rows: SetUp, state: State) -> float:
    """Misfit as a share of the spread, by the median row of the worst run, so that a few bad rows count little.

    A tool longer than the arm explains a run's points where few joints move, and nothing else: it is a misfit, too.
    """
    distance = np.linalg.norm(rows.residuals(state), axis=1)
    centred = np.empty(len(rows))
    runs = [rows.base == base for base in range(len(rows.base_names))]
    for of_run in runs:
        points = rows.measured[of_run]
        centred[of_run] = np.linalg.norm(points - points.mean(axis=0), axis=1)
    spread = max(float(np.median(centred)), _predicted_spread(rows, state), 1e-12)
    too_long = float(np.linalg.norm(state.tools, axis=1).max() > rows.arm.reach)
    return max(too_long, *(float(np.median(distance[of_run])) / spread for of_run in runs if of_run.any()))


def _tried(arm: Arm, table: Recordings) -> tuple[float, float]:
    """Share left and spread (m) of a table, base and tool fitted."""
    rows = set_up(arm, _spread_evenly(table))
    state = placed(rows, MOST_STEPS)
    return _share_left(rows, state), max(_spread(table), _predicted_spread(rows, state))


def _predicted_spread(rows: SetUp, state: State) -> float:
    points = rows.predicted(state)
    return float(np.sqrt(np.mean(np.sum((points - points.mean(axis=0)) ** 2, axis=1))))


@dataclass(frozen=True)
class _Trial:
    """A mistake that may have been made, and the table with it undone."""

    statement: str
    cure: str
    undo: Callable[[Recordings], Recordings]


def _trials(arm: Arm) -> Iterator[_Trial]:
    yield _Trial(
        "the joint angles look like degrees that were declared as radians",
        "Call the columns q1_deg ..., or say unit: deg in the mapping.",
        lambda table: replace(table, motor_angles=np.radians(table.motor_angles)),
    )
    yield _Trial(
        "the joint angles look like radians that were declared as degrees",
        "Call the columns q1_rad ..., or say unit: rad in the mapping.",
        lambda table: replace(table, motor_angles=np.degrees(table.motor_angles)),
    )
    yield _Trial(
        "the positions look like metres that were declared as millimetres",
        "Call the columns x_m, y_m, z_m.",
        lambda table: replace(table, positions=table.positions * 1e3),
    )
    yield _Trial(
        "the positions look like millimetres that were declared as metres",
        "Call the columns x_mm, y_mm, z_mm.",
        lambda table: replace(table, positions=table.positions * 1e-3),
    )
    for factor, unit in ((10.0, "centimetres"), (25.4, "inches")):
        yield _Trial(
            f"the positions look like {unit} that were declared as millimetres",
            f"Multiply them by {factor:g}.",
            functools.partial(_enlarged, factor=factor),
        )
    yield _Trial(
        "the measurement frame is left-handed: the points are a mirror image of the arm's",
        "Flip the sign of one axis, or exchange two, where the points come from.",
        lambda table: replace(table, positions=table.positions * [1.0, 1.0, -1.0]),
    )
    yield _Trial(
        "the joints stand in reverse order",
        "q1 is the joint nearest the base.",
        lambda table: replace(table, motor_angles=table.motor_angles[:, ::-1]),
    )
    for shift in (-2, -1, 1, 2):
        yield _Trial(
            f"the measured points come {abs(shift)} row(s) too {'late' if shift < 0 else 'early'} for the joint angles",
            "Join angles and points by what they have in common, not by their order.",
            functools.partial(_shifted, shift=shift),
        )
    for motor in range(arm.n_motors):
        signs = np.where(np.arange(arm.n_motors) == motor, -1.0, 1.0)
        yield _Trial(
            f"joint {motor + 1} turns the other way than the arm's model says",
            f"Give q{motor + 1} the other sign, or turn the axis in robot.yaml (alpha of the rows beside it).",
            functools.partial(_turned_round, signs=signs),
        )

    for motor, degrees in itertools.product(range(arm.n_motors), (-90, 90, 180)):
        zero = np.where(np.arange(arm.n_motors) == motor, np.radians(degrees), 0.0)
        yield _Trial(
            f"the zero of joint {motor + 1} is {abs(degrees)} degrees off",
            f"Add {degrees} degrees to q{motor + 1}, or to its theta_offset_deg in robot.yaml.",
            functools.partial(_from_zero, zero=zero),
        )
    for one, other in itertools.combinations(range(arm.n_motors), 2):
        order = np.arange(arm.n_motors)
        order[[one, other]] = other, one
        yield _Trial(
            f"the angles of joints {one + 1} and {other + 1} are exchanged",
            "Exchange their columns.",
            functools.partial(_reordered, order=order),
        )


def _enlarged(table: Recordings, factor: float) -> Recordings:
    return replace(table, positions=table.positions * factor)


def _from_zero(table: Recordings, zero: Array) -> Recordings:
    return replace(table, motor_angles=table.motor_angles + zero)


def _reordered(table: Recordings, order: NDArray[np.intp]) -> Recordings:
    return replace(table, motor_angles=table.motor_angles[:, order])


def _turned_round(table: Recordings, signs: Array) -> Recordings:
    return replace(table, motor_angles=table.motor_angles * signs)


def _shifted(table: Recordings, shift: int) -> Recordings:
    """Points moved by some rows against the angles, within each run; what has no partner is left out."""
    kept, partner = [], []
    for run in np.unique(table.run):
        rows = np.flatnonzero(table.run == run)
        kept.append(rows[max(0, shift) : len(rows) + min(0, shift)])
        partner.append(rows[max(0, -shift) : len(rows) + min(0, -shift)])
    moved = table.rows(np.concatenate(kept))
    return replace(moved, positions=table.positions[np.concatenate(partner)])


def _explanation(arm: Arm, table: Recordings) -> Suspicion:
    """Why the arm does not explain the points; where runs don't share the fault, of those that have it."""
    # what no trial looks at need not be copied in each
    unused: dict[str, Any] = dict.fromkeys(
        ("orientation", "time", "temperature", "payload", "approach", "speed", "torque", "sigma", "extra")
    )
    table = replace(table, **unused)
    runs = dict.fromkeys(table.run.tolist())
    if len(runs) > 1:
        bad = [run for run in runs if _fails_alone(arm, table.rows(table.run == run))]
        if 0 < len(bad) < len(runs):
            return _best_trial(arm, table.rows(np.isin(table.run, bad)), " in run " + ", ".join(bad))
    return _best_trial(arm, table, "")


def _fails_alone(arm: Arm, of_run: Recordings) -> bool:
    rows = set_up(arm, _spread_evenly(of_run))
    if 3 * len(rows) < ROWS_PER_PARAMETER * rows.free("nominal").sum():
        return False
    return _share_left(rows, placed(rows, MOST_STEPS)) > FITS


def _best_trial(arm: Arm, table: Recordings, where: str) -> Suspicion:
    share, spread = _tried(arm, table)
    tried = [(_tried(arm, trial.undo(table))[0], trial) for trial in _trials(arm)]
    least = min(left for left, _ in tried)
    if least < min(FITS, CLEARLY_BETTER * share):
        best, *others = [trial for left, trial in tried if left <= AS_GOOD * least]
        alternatives = " ".join(f"Or {other.statement}: the points can't tell." for other in others)
        return Suspicion("problem", best.statement + where, f"{best.cure} {alternatives}".strip())
    return Suspicion(
        "problem",
        f"the arm does not explain the points{where}: {100 * min(share, 1):.0f} % of their spread of "
        f"{spread * 1e3:.0f} mm are left after base and tool are fitted",
        "Is it another robot, are angles and points of different rows, or is a joint's zero far off?",
    )


def _exchanged_rows(arm: Arm, recordings: Recordings) -> list[Suspicion]:
    """Pairs or rings of rows whose points fit each other's angles."""
    some = recordings.rows(slice(0, MOST_ROWS_FOR_EXCHANGE))
    rows = set_up(arm, some)
    state = placed(rows, MOST_STEPS)
    distance = np.linalg.norm(rows.residuals(state), axis=1)
    if distance.max() < FAR * spread_of(distance):
        return []
    residuals = rows.residuals(robust_least_squares(rows, state, rows.free("nominal")).state)
    distance = np.linalg.norm(residuals, axis=1)
    usual = spread_of(distance)
    far = np.flatnonzero(distance > FAR * usual)
    if not 2 <= len(far) <= 500:
        return []
    predicted = some.positions[far] - residuals[far]
    between = np.linalg.norm(predicted[:, None] - some.positions[far][None], axis=2)
    between[rows.base[far][:, None] != rows.base[far][None]] = 1e6
    angles_of, points_of = linear_sum_assignment(between)
    matched = (between[angles_of, points_of] < 6 * usual) & (angles_of != points_of)
    if not matched.any():
        return []
    names = [f"{some.run[row]}: {some.id[row]}".removeprefix(": ") for row in far[angles_of[matched]]]
    more = ", ..." if len(names) > 10 else ""
    statement = f"{len(names)} rows seem to have exchanged their points: " + ", ".join(names[:10]) + more
    return [Suspicion("problem", statement, "Their points fit each other's joint angles.")]


def _moved_tools(arm: Arm, table: Recordings, misfit: float, least_share: float | None = None) -> list[Suspicion]:
    """Whether a target that several runs share sits elsewhere on the flange in some of them.

    Args:
        least_share: of the spread that tools of their own may leave; None asks for a clearly smaller misfit only.
    """
    rows = set_up(arm, table, tool_per_run=True)
    if len(rows.tool_names) == len(np.unique(table.target)):
        return []
    state = placed(rows, MOST_STEPS)
    alone = rms_distance(rows.residuals(state))
    numbers, own = 3 * len(rows), rows.free("nominal").sum()
    shared = own - 3 * (len(rows.tool_names) - len(np.unique(table.target)))
    expected = misfit * np.sqrt(max(numbers - own, 0) / max(numbers - shared, 1))  # of tools that did not move
    if alone > TOOL_MOVED * expected or (least_share is not None and _share_left(rows, state) > least_share):
        return []
    statement = f"the tool seems to have moved between runs: with one of its own per run {alone * 1e3:.3g} mm are left"
    return [Suspicion("hint", statement, "Free the tool per run.")]


def _outside_limits(arm: Arm, recordings: Recordings) -> list[Suspicion]:
    low, high = arm.limits.T
    outside = ((recordings.motor_angles < low - 1e-3) | (recordings.motor_angles > high + 1e-3)).sum(axis=0)
    return [
        Suspicion("hint", f"joint {motor + 1} is outside its limits in {count} rows", "Are limits and angles in step?")
        for motor, count in enumerate(outside.tolist())
        if count
    ]
