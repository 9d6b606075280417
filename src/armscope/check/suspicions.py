"""What does not fit together: units, orders, frames and rows, each tried against the arm's kinematics.

Every suspicion is a trial: the table is changed as if a common mistake had been made, base and tool are fitted again,
and a mistake is only named where undoing it makes the arm explain the points, or the orientations, that it did not.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment
from scipy.spatial.transform import Rotation

from armscope.calibration.fit import placed, rms_distance, robust_least_squares, spread_of
from armscope.calibration.model import SetUp, State, set_up
from armscope.recordings import Recordings
from armscope.robot import Arm

Array = NDArray[np.float64]

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

MOST_ROWS_FOR_EXCHANGE = 20_000
FAR = 10
"""Rows further off than so many times the usual spread may have exchanged their points."""

TOOL_MOVED = 0.8
"""Tools of their own per run must bring the misfit below this share to be worth a hint."""


@dataclass(frozen=True)
class Suspicion:
    """Something a user should look at: a "problem" makes results meaningless, a "hint" may be as it should."""

    weight: Literal["problem", "hint"]
    statement: str
    cure: str = ""

    def text(self) -> str:
        """In words."""
        return f"{self.statement}. {self.cure}".strip() if self.cure else f"{self.statement}."


@dataclass(frozen=True)
class Consistency:
    """How well the nominal arm explains the points once base and tool are fitted: RMS distance and spread, m.

    ``rows`` is how many were looked at; in long tables they are spread evenly.
    """

    rms: float
    spread: float
    rows: int
    suspicions: tuple[Suspicion, ...]


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
    state = placed(rows, MOST_STEPS)
    misfit = rms_distance(rows.residuals(state))
    spread = max(_spread(some), _predicted_spread(rows, state))
    found: list[Suspicion] = []
    share = _share_left(rows, state)
    if share > FITS:
        found.append(_best_explanation(arm, recordings, share, spread))
    else:
        found += _exchanged_rows(arm, recordings)
        found += _orientation_mistakes(rows, state, some)
        found += _moved_tools(arm, some, misfit)
    return Consistency(misfit, spread, len(some), (*found, *_outside_limits(arm, recordings)))


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
    """Misfit as a share of the spread, by the median row, so that a few bad rows don't hide what the rest says."""
    distance = np.linalg.norm(rows.residuals(state), axis=1)
    centred = np.empty(len(rows))
    for base in range(len(rows.base_names)):
        points = rows.measured[rows.base == base]
        centred[rows.base == base] = np.linalg.norm(points - points.mean(axis=0), axis=1)
    return float(np.median(distance)) / max(float(np.median(centred)), _predicted_spread(rows, state), 1e-12)


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


def _best_explanation(arm: Arm, table: Recordings, share: float, spread: float) -> Suspicion:
    tried = []
    # what no trial looks at need not be copied in each
    unused: dict[str, Any] = dict.fromkeys(
        ("orientation", "time", "temperature", "payload", "approach", "speed", "torque", "sigma", "extra")
    )
    table = replace(table, **unused)
    for trial in _trials(arm):
        rows = set_up(arm, _spread_evenly(trial.undo(table)))
        tried.append((_share_left(rows, placed(rows, MOST_STEPS)), trial))
    least, best = min(tried, key=lambda each: each[0])
    if least < min(FITS, CLEARLY_BETTER * share):
        return Suspicion("problem", best.statement, best.cure)
    return Suspicion(
        "problem",
        f"the arm does not explain the points: {100 * share:.0f} % of their spread of {spread * 1e3:.0f} mm are left "
        "after base and tool are fitted",
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


def _moved_tools(arm: Arm, table: Recordings, misfit: float) -> list[Suspicion]:
    """Whether a target that several runs share sits elsewhere on the flange in some of them."""
    rows = set_up(arm, table, tool_per_run=True)
    if len(rows.tool_names) == len(np.unique(table.target)):
        return []
    alone = rms_distance(rows.residuals(placed(rows, MOST_STEPS)))
    if alone > TOOL_MOVED * misfit:
        return []
    statement = f"the tool seems to have moved between runs: with one of its own per run {alone * 1e3:.3g} mm are left"
    return [Suspicion("hint", statement, "Free the tool per run.")]


READINGS: tuple[tuple[str, str, Callable[[Array], Array]], ...] = (
    ("as declared", "", lambda q: q),
    (
        "the quaternions are in the order x, y, z, w",
        "Declare order: xyzw, or exchange the columns.",
        lambda q: q[:, [3, 0, 1, 2]],
    ),
    (
        "the quaternions turn the other way: they are the tool frame from the measurement frame",
        "Change the sign of qx, qy, qz.",
        lambda q: q * [1, -1, -1, -1],
    ),
    (
        "the quaternions are in the order x, y, z, w and turn the other way",
        "Declare order: xyzw, and change the sign of x, y, z.",
        lambda q: q[:, [3, 0, 1, 2]] * [1, -1, -1, -1],
    ),
)


def _orientation_mistakes(rows: SetUp, state: State, table: Recordings) -> list[Suspicion]:
    """The reading of the quaternions under which the tool sits still on the flange."""
    if table.orientation is None:
        return []
    known = np.isfinite(table.orientation).all(axis=1)
    if known.sum() < 5:
        return []
    _, frames = rows.frames(state)
    expected = state.rotations[rows.base] @ frames.tool_rotation
    spreads = [
        _tool_spread(expected[known], reading(table.orientation[known]), rows.base[known]) for _, _, reading in READINGS
    ]
    best = int(np.argmin(spreads))
    if best != 0 and spreads[best] < CLEARLY_BETTER * spreads[0]:
        statement, cure, _ = READINGS[best]
        seen = f" (scatter of the tool's orientation {np.degrees(spreads[0]):.2g} as declared"
        return [Suspicion("problem", f"{statement}{seen}, {np.degrees(spreads[best]):.2g} degrees so)", cure)]
    if spreads[best] > np.radians(10):
        statement = f"the orientations scatter by {np.degrees(spreads[0]):.2g} degrees against the arm's"
        return [Suspicion("hint", statement, "They are not the tool's in any order; positions can be used alone.")]
    return []


def _tool_spread(expected: Array, quaternions: Array, base: NDArray[np.intp]) -> float:
    """RMS angle of the tool's orientation on the flange about its mean, per base frame, rad."""
    measured = Rotation.from_quat(quaternions[:, [1, 2, 3, 0]])
    on_flange = Rotation.from_matrix(np.swapaxes(expected, 1, 2)) * measured
    squares = 0.0
    for number in np.unique(base):
        of_run = on_flange[base == number]
        squares += float(np.sum((of_run.mean().inv() * of_run).magnitude() ** 2))
    return float(np.sqrt(squares / len(quaternions)))


def _outside_limits(arm: Arm, recordings: Recordings) -> list[Suspicion]:
    low, high = arm.limits.T
    outside = ((recordings.motor_angles < low - 1e-3) | (recordings.motor_angles > high + 1e-3)).sum(axis=0)
    return [
        Suspicion("hint", f"joint {motor + 1} is outside its limits in {count} rows", "Are limits and angles in step?")
        for motor, count in enumerate(outside.tolist())
        if count
    ]
