"""Plain geometric calibration: base, tools and the identifiable constants from measured points, with covariance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from armscope.calibration.confounding import Confounded, confounded_parameters
from armscope.calibration.constants import CALIBRATING, FITTING
from armscope.calibration.fit import placed
from armscope.calibration.held_out import foretold, random_split
from armscope.calibration.model import Level, SetUp, set_up
from armscope.calibration.plausibility import doubtful_loads, implausible_fit, no_held_out_gain, require_loads
from armscope.calibration.result import Calibration, misses_by_run
from armscope.calibration.solve import Priors, Redundancy, Solved, scales_of, solve
from armscope.core.averages import rms_distance
from armscope.core.inputs import InputError
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.fitting.constants import EXCHANGE
from armscope.fitting.exchanged_tool import exchanged_tool
from armscope.fitting.registration import fit_frames
from armscope.measurement.robust import scale_of
from armscope.recordings import Recordings
from armscope.robot import Arm


def _sharing(
    arm: Arm, recordings: Recordings, one_base: bool, tool_per_run: bool | None
) -> tuple[list[str], list[str]]:
    """What speaks against the frames that runs are said to share: notes and doubts, as sentences.

    A note if tools must be free per run and nobody said otherwise.
    """
    if len(np.unique(recordings.run)) < 2:
        return [], []
    notes, doubts = list[str](), list[str]()
    some = replace(recordings.rows(spread_evenly(len(recordings), CALIBRATING.rows_of_frames)), orientation=None)
    if not tool_per_run and (found := exchanged_tool(fit_frames(arm, some), some)):
        text = f"one tool for all runs leaves {found.shared_mm:.3g} mm, one per run {found.own_mm:.3g} mm"
        if tool_per_run is None:
            notes.append(f"{text}: it was exchanged, and is free in every run")
        else:
            doubts.append(f"{text}: it was exchanged")
    if one_base:
        free = bool(notes) or bool(tool_per_run)
        shared, own = (_usual_miss(arm, some, one, free) for one in (True, False))
        if shared > EXCHANGE.worse * own:
            text = f"one base frame for all runs leaves {shared * 1e3:.3g} mm, one per run {own * 1e3:.3g} mm"
            doubts.append(f"{text}: it was moved")
    return notes, doubts


def _usual_miss(arm: Arm, recordings: Recordings, one_base: bool, tool_per_run: bool) -> float:
    """The spread (1-sigma per axis by the median, m) about base and tool, for the numbers that these cost.

    Infinite where frames for so few rows would follow anything.
    """
    rows = set_up(arm, recordings, one_base, tool_per_run)
    measured, spent = 3 * len(rows), 6 * len(rows.base_names) + 3 * len(rows.tool_names)
    if measured < EXCHANGE.least_numbers * spent:
        return float(np.inf)
    spread = scale_of(rows.residuals(placed(rows)))
    return spread * float(np.sqrt(measured / (measured - spent)))


# so many parameters: each is a choice of its own that a user makes by name, and all have a default
def calibrate(
    arm: Arm,
    recordings: Recordings,
    level: Level = "geometric",
    *,
    redundancy: Redundancy = "fixed",
    priors: Priors | None = None,
    robust: bool = False,
    one_base: bool = False,
    tool_per_run: bool | None = None,
    orientation: bool | None = None,
    splits: int = 0,
) -> Calibration:
    """Fit base frames, tools and the arm's constants to measured positions, and orientations where there are any.

    Args:
        arm: the nominal arm.
        recordings: measured points; base free per run, tool per target.
        level: what is free beyond base and tool, see `model.LEVELS`.
        redundancy: parameters that imitate each other are "fixed" at nominal until the rest can be told apart
            (rank-revealing QR), or all free and held by "priors".
        priors: sizes for `redundancy` "priors"; None takes the defaults.
        robust: take the say from bad shots (weights fall with the fourth power).
        one_base: one base frame for all runs.
        tool_per_run: a tool of its own for every run; None: where one for all leaves more than twice as much.
        orientation: use measured orientations, weighed by the scatter that positions and orientations show; None uses
            them unless positions of rows that took no part are then predicted worse, which happens where an arm errs
            more in orientation than its constants can say.
        splits: how often 70 % of the configurations are drawn to learn from and the rest to be tested on; 0 never, and
            not where base or tool are shared by runs that do not share them.

    Returns:
        Constants with covariance, frames, held-out errors, and what could not be told apart.

    Raises:
        InputError: another number of motors than the arm's, fewer measured numbers than parameters, or compliances
            without loads.
    """
    priors = priors or Priors()
    notes, doubts = _sharing(arm, recordings, one_base, tool_per_run)
    tool_per_run = bool(notes) if tool_per_run is None else tool_per_run
    rows = set_up(arm, recordings, one_base, tool_per_run, orientation is not False)
    require_loads(recordings, rows, level)

    def solved_for(some: SetUp) -> Solved:
        return solve(some, level, redundancy, priors, robust)

    if orientation is None and rows.orientations is not None:
        helps, note = (False, "") if doubts else _orientation_helps(rows, recordings, solved_for)
        rows, notes = rows if helps else replace(rows, orientations=None), [*notes, *filter(None, [note])]
    solved = solved_for(rows)
    _require_rows(recordings, solved, redundancy)
    rows, fitted = solved.rows, solved.fitted
    distance = np.linalg.norm(rows.residuals(fitted.state), axis=1)
    ids = [f"{run}: {name}" if run else name for run, name in zip(recordings.run, recordings.id, strict=True)]
    covariance = _covariance(solved)
    misses = None
    if splits and not doubts:  # what should not be used need not be tested
        free = int(np.count_nonzero(solved.free))
        misses = misses_by_run(rows, recordings, fitted.state, lambda it: solved_for(it).fitted.state, splits, free)
    return Calibration(
        level=level,
        set_up=rows,
        state=fitted.state,
        free=solved.free,
        weights=fitted.weights,
        covariance=covariance,
        steps=fitted.steps,
        reason=fitted.reason,
        suspects=distance > CALIBRATING.suspect_sigmas * scale_of(rows.residuals(fitted.state)),
        ids=np.array(ids),
        notes=tuple(notes + doubtful_loads(solved, level, covariance) + no_held_out_gain(misses)),
        doubts=tuple(doubts + implausible_fit(solved)),
        held=_held(solved, level),
        misses=misses,
    )


def _held(solved: Solved, level: Level) -> tuple[Confounded, ...]:
    rows = solved.rows
    wanted = rows.free(level)
    _, jacobian = rows.linearised(solved.fitted.state, wanted)
    names = tuple(name for name, want in zip(rows.names, wanted, strict=True) if want)
    return confounded_parameters(jacobian, solved.free[wanted], scales_of(rows)[wanted], names)


def _orientation_helps(rows: SetUp, recordings: Recordings, solved_for: Callable[[SetUp], Solved]) -> tuple[bool, str]:
    """Whether positions of rows that took no part are predicted as well with orientations as without."""
    without = replace(rows, orientations=None)
    found = []
    for variant in (without, rows):
        squares = []
        for seed in range(CALIBRATING.deciding_splits):
            train, test = random_split(recordings, seed)
            train = train[:: max(1, len(train) // CALIBRATING.deciding_rows)]
            test = foretold(rows, train, test)
            fitted = solved_for(variant.rows(train)).fitted
            squares.append(rms_distance(without.rows(test).residuals(fitted.state)) ** 2)
        found.append(1e3 * float(np.sqrt(np.mean(squares))))
    helps = found[1] <= CALIBRATING.harm * found[0]
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
    inverse = np.linalg.pinv(normal, hermitian=True, rcond=FITTING.unseen)
    freedom = max(len(residual) - int(free.sum()), 1)
    if np.all(fitted.weights == 1):
        return inverse * float(residual @ residual) / freedom
    weighed = (per_component * residual).reshape(-1, per_row)
    pull = np.einsum("nc,ncp->np", weighed, jacobian.reshape(-1, per_row, free.sum()))
    return np.asarray(inverse @ (pull.T @ pull) @ inverse * len(residual) / freedom)
