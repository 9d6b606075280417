"""What does not fit together: units, orders, frames and rows, each tried against the arm's kinematics.

Every suspicion is a trial: the table is changed as if a common mistake had been made, base and tool are fitted again,
and a mistake is only named where undoing it makes the arm explain the points, or the orientations, that it did not.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from armscope.calibration.fit import placed, robust_least_squares
from armscope.calibration.geometry import State
from armscope.calibration.model import SetUp, set_up
from armscope.check.approach import exchanged_sides, leading_joints
from armscope.check.common_mistakes import MIRRORED, Trial, trials
from armscope.check.constants import TRIALS
from armscope.check.gravity import gravity_mistake
from armscope.check.rows_far_off import rows_far_off
from armscope.check.settling import not_at_rest
from armscope.check.stated_arm import better_arm, payload_at_the_flange, tool_stated_otherwise
from armscope.check.suspicion import Suspicion
from armscope.check.targets import named_row_by_row, two_reflectors
from armscope.core.averages import rms_distance
from armscope.core.grouping import same_configuration
from armscope.core.sampling import spread_evenly
from armscope.recordings import Recordings
from armscope.recordings.columns import counted_from_zero
from armscope.recordings.motion import moving
from armscope.robot import Arm
from armscope.verdict.schema import ANOTHER_MODEL

WRONG_ROBOT = "wrong robot"


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
    """Try the common mistakes on a table."""
    if recordings.n_motors != arm.n_motors:
        statement = f"the table has {recordings.n_motors} motor angles, {arm.name} has {arm.n_motors} motors"
        cure = "" if recordings.extra is None else counted_from_zero(map(str, recordings.extra.columns))
        wrong = Suspicion("problem", statement, cure or "Is this the right robot for the recordings?")
        return Consistency(float("nan"), _spread(recordings), 0, (wrong,))
    if numbered := named_row_by_row(recordings):
        return Consistency(float("nan"), _spread(recordings), 0, tuple(numbered))
    some = _spread_evenly(recordings)
    rows = set_up(arm, some)
    if 3 * len(rows) < TRIALS.rows_per_parameter * rows.free("nominal").sum():
        needed = -(-TRIALS.rows_per_parameter * int(rows.free("nominal").sum()) // 3)
        cure = f"{len(rows)} are there, {needed} are needed."
        statement = "too few rows to fit base and tool, so nothing was tried against the arm"
        hint = Suspicion("hint", statement, cure)
        return Consistency(float("nan"), _spread(recordings), 0, (hint,))
    if not moving(recordings.motor_angles).any():  # what is left is noise
        return Consistency(float("nan"), _spread(recordings), 0, ())
    state = _placed_by_most(rows)
    misfit = rms_distance(rows.residuals(state))
    spread = max(_spread(some), _predicted_spread(rows, state))
    found: list[Suspicion] = []
    turned: list[Suspicion] = []
    share = _share_left(rows, state)
    if share > TRIALS.fits:
        found += _moved_tools(arm, replace(some, orientation=None), explains=True) or _unexplained(
            arm, recordings, misfit
        )
    else:
        found += _doubtful(arm, recordings, misfit) if share > TRIALS.doubtful else []
        found += better_arm(arm, some, misfit) + _too_coarse(arm, misfit) + gravity_mistake(arm, some, state)
        found += (
            exchanged_sides(recordings)
            + leading_joints(arm, some, state)
            + not_at_rest(arm, recordings, state)
            + rows_far_off(arm, recordings, _placed_by_most)
        )
        found += payload_at_the_flange(arm, recordings, state) + tool_stated_otherwise(arm, state)
        from armscope.check.orientations import orientation_mistakes  # imports the effects, which a refusal needs not

        turned = orientation_mistakes(rows, state, some.orientation)
        found += turned
        found += _moved_tools(arm, replace(some, orientation=None) if turned else some)
    return Consistency(misfit, spread, len(some), (*found, *_outside_limits(arm, recordings)), orientations=not turned)


def _placed_by_most(rows: SetUp) -> State:
    """Base and tool, by least squares; by most of the rows where these explain the points and all of them do not.

    One lost reading of metres, or a slip of the decimal point, puts all others off.
    """
    state = placed(rows, TRIALS.steps)
    if _share_left(rows, state) <= TRIALS.fits:
        return state
    by_most = robust_least_squares(rows, state, rows.free("nominal")).state
    return by_most if _share_left(rows, by_most) <= TRIALS.fits else state


def _unexplained(arm: Arm, recordings: Recordings, misfit: float) -> list[Suspicion]:
    """The mistake whose undoing explains the points, another arm of the library that does, or neither."""
    if two := two_reflectors(arm, _spread_evenly(recordings), misfit):
        return two
    mistake = explanation(arm, recordings)
    other = better_arm(arm, _spread_evenly(recordings), misfit) if mistake.kind == WRONG_ROBOT else []
    return [replace(mistake, cure=f"I{other[0].text()[1:]}", kind=ANOTHER_MODEL)] if other else [mistake]


def _doubtful(arm: Arm, recordings: Recordings, misfit: float) -> list[Suspicion]:
    """The mistake whose undoing explains points that the arm explains badly: of a joint near the tool, say.

    A joint that turns a short tool the other way leaves centimetres, as a zero some degrees off does.
    """
    if two := two_reflectors(arm, _spread_evenly(recordings), misfit):
        return two
    mistake = explanation(arm, recordings)
    if mistake.kind != WRONG_ROBOT:
        return [mistake]
    statement = f"base and tool leave {1e3 * misfit:.3g} mm RMS, more than an arm leaves that was built to its drawing"
    cure = "Is a joint's zero degrees off, a joint's column or sign another's, or is it another arm?"
    return [Suspicion("hint", statement, cure)]


def _spread_evenly(recordings: Recordings) -> Recordings:
    if len(recordings) <= TRIALS.rows:
        return recordings
    return recordings.rows(spread_evenly(len(recordings), TRIALS.rows))


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


def _tried(arm: Arm, table: Recordings, steps: int = TRIALS.steps) -> tuple[float, float]:
    """Share left and spread (m) of a table, base and tool fitted by so many steps at most."""
    rows = set_up(arm, _spread_evenly(table))
    state = placed(rows, steps)
    return _share_left(rows, state), max(_spread(table), _predicted_spread(rows, state))


def _predicted_spread(rows: SetUp, state: State) -> float:
    points = rows.predicted(state)
    return rms_distance(points - points.mean(axis=0))


def explanation(arm: Arm, table: Recordings) -> Suspicion:
    """Why the arm does not explain the points; where runs don't share the fault, of those that have it."""
    # what no trial looks at need not be copied or computed in each
    arm = replace(arm, masses=np.zeros_like(arm.masses))
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
    if 3 * len(rows) < TRIALS.rows_per_parameter * rows.free("nominal").sum():
        return False
    return _share_left(rows, placed(rows, TRIALS.steps)) > TRIALS.fits


def _best_trial(arm: Arm, table: Recordings, where: str) -> Suspicion:
    share, spread = _tried(arm, table)
    tried = _all_tried(arm, table)
    least = min(left for left, _ in tried)
    if least < min(TRIALS.fits, TRIALS.clearly_better * share):
        best, *others = [trial for left, trial in tried if left <= TRIALS.as_good * least]
        alternatives = " ".join(f"Or {other.statement}: the points can't tell." for other in others)
        # what mirrors an arm is told by its signs first, since instruments are right-handed
        kind = MIRRORED if any(other.kind == MIRRORED for other in others) else best.kind
        return Suspicion("problem", best.statement + where, f"{best.cure} {alternatives}".strip(), kind)
    of_points = _spread(table)
    if of_points < TRIALS.point * spread:
        statement = f"the points{where} lie within {1e3 * of_points:.2g} mm, though the arm's lie within"
        cure = "Are these errors, measured minus nominal? Points are needed: where the tool was."
        return Suspicion("problem", f"{statement} {1e3 * spread:.0f} mm", cure, WRONG_ROBOT)
    return Suspicion(
        "problem",
        f"the arm does not explain the points{where}: {100 * min(share, 1):.0f} % of their spread of "
        f"{spread * 1e3:.0f} mm are left after base and tool are fitted",
        "Is it another robot, are angles and points of different rows, or is a joint's zero far off?",
        WRONG_ROBOT,
    )


def _all_tried(arm: Arm, table: Recordings) -> list[tuple[float, Trial]]:
    """The share that is left with each mistake undone: by a few steps, and by all where that is near enough to matter.

    From a start in closed form, what explains the points is near after one step. Most mistakes were not made.
    """
    tried = [(_tried(trial.arm(arm), trial.undo(table), TRIALS.first_steps)[0], trial) for trial in trials(arm)]
    nearest = sorted(left for left, _ in tried)[: TRIALS.refined]
    limit = max(nearest[-1], TRIALS.far)
    return [(_tried(trial.arm(arm), trial.undo(table))[0] if left <= limit else left, trial) for left, trial in tried]


def _moved_tools(arm: Arm, table: Recordings, explains: bool = False) -> list[Suspicion]:
    """Whether a target that several runs share sits elsewhere on the flange in some of them."""
    if len(np.unique(table.run)) < 2:
        return []
    from armscope.fitting.exchanged_tool import exchanged_tool  # as above
    from armscope.fitting.registration import fit_frames

    found = exchanged_tool(fit_frames(arm, table), table)
    if found is None:
        return []
    if explains:
        rows = set_up(arm, table, tool_per_run=True)
        if _share_left(rows, placed(rows, TRIALS.steps)) > TRIALS.fits:
            return []
    statement = f"the tool seems to have moved between runs, {found.apart}"
    cure = f"With one of its own per run {found.own_mm:.3g} mm are left: free it there."
    if np.bincount(same_configuration(table.motor_angles)).max() > 1:
        cure += " Or are these reflectors, seen at the same poses? Their names belong into column target."
    return [Suspicion("hint", statement, cure)]


def _too_coarse(arm: Arm, misfit: float) -> list[Suspicion]:
    """An uncertainty larger than all that is left would hide every error: most likely it is in another unit."""
    left = misfit / np.sqrt(3)
    if arm.sigma is None or arm.sigma < TRIALS.too_coarse * left:
        return []
    statement = (
        f"robot.yaml states an instrument of {1e3 * arm.sigma:.3g} mm, but the nominal arm already meets the points "
        f"to {1e3 * left:.2g} mm per axis"
    )
    return [Suspicion("problem", statement, "sigma_mm is in mm: was it in micrometres?")]


def _outside_limits(arm: Arm, recordings: Recordings) -> list[Suspicion]:
    low, high = arm.limits.T
    angles, slack = recordings.motor_angles, TRIALS.limit_slack
    outside = ((angles < low - slack) | (angles > high + slack)).sum(axis=0)
    return [
        Suspicion("hint", f"joint {motor + 1} is outside its limits in {count} rows", "Are limits and angles in step?")
        for motor, count in enumerate(outside.tolist())
        if count
    ]
