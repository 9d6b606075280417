"""What is stated of an arm and its points contradict: the tool's numbers, where a payload sits, which arm it is."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from armscope.calibration.fit import placed
from armscope.calibration.geometry import State
from armscope.calibration.model import set_up
from armscope.check.constants import OTHER_ARMS, TRIALS
from armscope.check.suspicion import Suspicion
from armscope.core.averages import rms_distance
from armscope.core.sampling import spread_evenly
from armscope.recordings import Recordings
from armscope.robot.arm import Arm, build_arm
from armscope.robot.library import nominal_description, nominal_names
from armscope.verdict.schema import ANOTHER_MODEL


def tool_stated_otherwise(arm: Arm, state: State) -> list[Suspicion]:
    """Whether the one measured tool point is where `tool_mm` would be with its numbers exchanged or turned round.

    Points alone find the tool without it. Commands in the base frame, loads and drawings start from what is stated.

    Returns:
        A hint with the numbers as the points have them, or nothing.
    """
    stated = np.array(arm.description.tool_mm)
    if not stated.any() or len(state.tools) != 1:
        return []
    found = 1e3 * state.tools[0]
    readings = np.array(
        [
            stated[list(order)] * signs
            for order in itertools.permutations(range(3))
            for signs in itertools.product((1, -1), repeat=3)
        ]
    )
    off = np.linalg.norm(readings - found, axis=1)
    if off.min() > TRIALS.tool_read_otherwise * np.linalg.norm(stated - found):
        return []
    at, as_stated, otherwise = (", ".join(f"{each + 0.0:.4g}" for each in numbers) for numbers in
                                (found.round(1), stated, readings[off.argmin()]))  # fmt: skip
    statement = f"the points sit at [{at}] mm in the last frame, where `tool_mm` says [{as_stated}]"
    return [Suspicion("hint", statement, f"Are its numbers in another order, or of other signs: [{otherwise}]?")]


def payload_at_the_flange(arm: Arm, recordings: Recordings, state: State) -> list[Suspicion]:
    """Payloads whose place nobody stated, where the points show a tool: its lever is in every compliance.

    Args:
        arm: the nominal arm.
        recordings: the table.
        state: base and tool that were fitted.

    Returns:
        A hint with the place, or nothing.
    """
    if recordings.payload is None or not np.nan_to_num(recordings.payload).max() > 0 or any(arm.description.tool_mm):
        return []
    at = 1e3 * state.tools.mean(axis=0)
    if np.linalg.norm(at) < TRIALS.lever_mm:
        return []
    told = ", ".join(f"{each:.0f}" for each in at)
    statement = "payload_kg is recorded, no tool_mm stated: each payload counts as sitting in the last frame's origin"
    cure = f"State `tool_mm` in the robot's file, if it sits where the points are measured: [{told}]."
    return [Suspicion("hint", statement, cure)]


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
