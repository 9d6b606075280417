"""Which arm of the library explains a table best: for recordings that the stated arm does not explain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.calibration.fit import placed
from armscope.calibration.model import set_up
from armscope.check.constants import OTHER_ARMS, TRIALS
from armscope.check.suspicion import Suspicion
from armscope.core.averages import rms_distance
from armscope.core.sampling import spread_evenly
from armscope.recordings import Recordings
from armscope.robot.arm import Arm, build_arm
from armscope.robot.library import nominal_description, nominal_names
from armscope.verdict.schema import ANOTHER_MODEL


@dataclass(frozen=True)
class NominalFit:
    """How well an arm of the library explains a table once base and tool are fitted."""

    name: str  # by which `armscope init` writes the arm
    title: str  # the arm's name in full
    rms_mm: float  # RMS distance that is left, mm
    explains: bool  # whether that is a small share of the points' spread, as the check's own rule says


def better_arm(arm: Arm, recordings: Recordings, rms_m: float) -> list[Suspicion]:
    """Whether an arm of the library explains a table clearly better than the stated one.

    Args:
        arm: the stated arm, and
        recordings: the table.
        rms_m: RMS distance that the stated arm leaves once base and tool are fitted, m.

    Returns:
        The hint, or nothing.
    """
    if rms_m < OTHER_ARMS.worth_a_look * arm.reach:
        return []
    best = next((fit for fit in nominal_fits(recordings) if fit.explains), None)
    if best is None or best.rms_mm > OTHER_ARMS.better * 1e3 * rms_m:
        return []
    statement = (
        f"is this another model of the arm? {best.title} of the library leaves {best.rms_mm:.2g} mm "
        f"where {arm.name} leaves {1e3 * rms_m:.2g} mm"
    )
    cure = f"`armscope init {best.name} -o robot.yaml` writes it: diagnose again with it before you change anything."
    return [Suspicion("hint", statement, cure, ANOTHER_MODEL)]


def nominal_fits(recordings: Recordings) -> tuple[NominalFit, ...]:
    """The library's arms with the table's number of motors, the best first; joint zeros and signs as in the library.
    ``recordings``: the table; of a long one rows are taken evenly."""
    usable = np.flatnonzero(np.isfinite(recordings.positions).all(axis=1))
    some = recordings.rows(usable[spread_evenly(len(usable), TRIALS.rows)] if len(usable) > TRIALS.rows else usable)
    points = some.positions - np.array([some.positions[some.run == run].mean(axis=0) for run in some.run])
    spread = rms_distance(points)
    arms = ((name, nominal_description(name)) for name in nominal_names())
    fitting = ((name, build_arm(each)) for name, each in arms if each.n_motors(_joints(each)) == some.n_motors)
    tried = [(_fit(name, arm, some, spread, TRIALS.first_steps), name, arm) for name, arm in fitting]
    # what explains the points is near after the first steps
    found = [
        _fit(name, arm, some, spread) if 1e-3 * fit.rms_mm <= TRIALS.far * spread else fit for fit, name, arm in tried
    ]
    return tuple(sorted(found, key=lambda fit: fit.rms_mm))


def _joints(description: object) -> int:
    dh = getattr(description, "dh", None)
    return 0 if dh is None else len(dh.joints)


def _fit(name: str, arm: Arm, table: Recordings, spread: float, steps: int = TRIALS.steps) -> NominalFit:
    rows = set_up(arm, table)
    left = rms_distance(rows.residuals(placed(rows, steps)))
    return NominalFit(name, arm.name, 1e3 * left, left <= TRIALS.fits * spread)
