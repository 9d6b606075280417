"""Models learned on one run and applied to another, where only frames are fitted again: physics carries over."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from armscope.calibration.fit import least_squares, placed
from armscope.calibration.geometry import State
from armscope.calibration.held_out import held_out_levels
from armscope.calibration.model import LEVELS, Level, SetUp, set_up
from armscope.calibration.solve import Priors, solve
from armscope.core.averages import rms_distance
from armscope.core.types import unheard
from armscope.diagnosis import Diagnosis, Settings, diagnose
from armscope.fitting.transfer import transfer as carry_over
from armscope.real.constants import PROTOCOL
from armscope.real.curves import turned_by_curves
from armscope.real.protocol import ARMSCOPE
from armscope.real.reference import ReferenceTransfer
from armscope.recordings import Recordings
from armscope.robot import Arm

COMPLIANCES = "compliances"  # Compliances alone are carried over; the rest of the arm stays nominal
ARMSCOPE_ELASTIC = "armscope, elastic part alone"
GEOMETRY_HERE, WITH_CURVES = "geometric, fitted here", "geometric, fitted here, other run's curves"
"""Held out: every D-H value is fitted to training rows of the run itself, without and with curves learned elsewhere."""


def calibrated_transfer(arm: Arm, recordings: Recordings, transfer: ReferenceTransfer) -> dict[str, float]:
    """RMS of the 3D distance (mm) on all rows of another run, by what was learned: a level, or compliances alone.

    Args:
        arm: the nominal arm.
        recordings: all runs of a set.
        transfer: which run is learned on, and which is predicted.

    Returns:
        mm by level.
    """
    learned = set_up(arm, recordings.of_runs([transfer.learned]))
    applied = _of_kind(set_up(arm, recordings.of_runs([transfer.applied])))
    start = placed(learned)
    own = placed(applied) if "base" in transfer.refitted else None
    found = {}
    for level in (*LEVELS, COMPLIANCES):
        if level in ("compliance", COMPLIANCES) and (learned.loads is None or applied.loads is None):
            continue
        known = solve(learned, _learned_at(level), "priors", Priors(), start=start).fitted.state
        if level == COMPLIANCES:
            known = replace(known, constants=np.zeros_like(known.constants))
        found[level] = 1e3 * rms_distance(applied.residuals(_refitted(applied, known, own, transfer)))
    return found


def _diagnosed_transfer(learned: Diagnosis, rows: Recordings, transfer: ReferenceTransfer) -> dict[str, float]:
    """RMS of the 3D distance (mm) on the other run of a whole verdict's model, and of its elastic part alone."""
    if "tool" not in transfer.refitted:
        known = [part.placed.variant for part in learned.model.tools]
        rows = replace(rows, target=np.where(np.isin(rows.target, known), rows.target, known[0]))
    found = {ARMSCOPE: carry_over(learned.model, rows, refitted=transfer.refitted).left_mm}
    parts = (*learned.model.parts, *learned.model.background)
    if any(part.placed.effect.family == "elastic" for part in parts) and "base" in transfer.refitted:
        found[ARMSCOPE_ELASTIC] = carry_over(learned.model, rows, ["elastic"], transfer.refitted).left_mm
    return found


def curves_transfer(arm: Arm, learned: Diagnosis, rows: Recordings) -> dict[str, float]:
    """Held-out RMS of the 3D distance (mm) on the other run with its own geometry, without and with learned curves.

    A curve and the geometry beside which it was learned imitate each other in part, so curves are judged beside a
    geometry that is fitted where they are used.

    Args:
        arm: the nominal arm.
        learned: the verdict on the run that was learned on.
        rows: of the other run.

    Returns:
        mm by model.
    """
    turned = turned_by_curves(learned.model, rows)
    if turned is None:
        return {}
    found = {}
    for name, table in ((GEOMETRY_HERE, rows), (WITH_CURVES, turned)):
        splits, rows_at_most = PROTOCOL.curve_splits, PROTOCOL.curve_rows
        found[name] = 1e3 * held_out_levels(arm, table, ["geometric"], splits, most_rows=rows_at_most)[0].mean
    return found


def learn(arm: Arm, recordings: Recordings, transfers: Sequence[ReferenceTransfer]) -> dict[str, Diagnosis]:
    """The verdict of every run that something is learned on: from points alone, as what stands beside it.

    Args:
        arm: the nominal arm.
        recordings: all runs of a set.
        transfers: which runs are asked for.

    Returns:
        Verdicts by run.
    """
    settings = Settings(resamples=0, cross_validation=False, orientation=False)
    runs = dict.fromkeys(transfer.learned for transfer in transfers)
    return {run: diagnose(arm, recordings.of_runs([run]), settings) for run in runs}


def measure_transfers(
    arm: Arm,
    recordings: Recordings,
    transfers: Sequence[ReferenceTransfer],
    verdicts: Mapping[str, Diagnosis],
    tell: Callable[[str], None] = unheard,
) -> list[tuple[ReferenceTransfer, dict[str, float]]]:
    """RMS of the 3D distance (mm) on rows of the other run, by model; ``verdicts`` as `learn` gives them.

    Args:
        arm: the nominal arm.
        recordings: all runs of a set.
        transfers: which runs are asked for.
        verdicts: by run.
        tell: hears what is being done.

    Returns:
        Each transfer with mm by model.
    """
    found = []
    for transfer in transfers:
        rows = recordings.of_runs([transfer.applied])
        by_model = calibrated_transfer(arm, recordings, transfer)
        by_model |= _diagnosed_transfer(verdicts[transfer.learned], rows, transfer)
        by_model |= curves_transfer(arm, verdicts[transfer.learned], rows)
        tell(f"{transfer.learned} to {transfer.applied}: " + ", ".join(f"{k} {v:.3f}" for k, v in by_model.items()))
        found.append((transfer, by_model))
    return found


def _learned_at(level: str) -> Level:
    return next((known for known in LEVELS if known == level), "compliance")


def _of_kind(applied: SetUp) -> SetUp:
    """The other run's rows, its tool counted as the first tool of the learned run."""
    return replace(applied, tool=np.zeros_like(applied.tool), tool_names=applied.tool_names[:1])


def _refitted(applied: SetUp, known: State, own: State | None, transfer: ReferenceTransfer) -> State:
    """What was learned, in frames that are fitted again where the transfer says so."""
    state = replace(known, tools=known.tools[:1], tool_rotations=known.tool_rotations[:1])
    if own is not None:
        state = replace(state, rotations=own.rotations, translations=own.translations)
    free = np.zeros(len(applied.names), dtype=bool)
    n_bases = 6 * len(applied.base_names)
    free[:n_bases] = "base" in transfer.refitted
    free[n_bases : n_bases + 3] = "tool" in transfer.refitted
    if not free.any():
        return state
    return least_squares(applied, state, free).state


def transfer_table(found: list[tuple[ReferenceTransfer, dict[str, float]]]) -> pd.DataFrame:
    """One row per transfer and model: learned, applied, refitted, model, rms_mm, reference_mm."""
    rows = [
        {
            "learned": transfer.learned,
            "applied": transfer.applied,
            "refitted": " and ".join(transfer.refitted) or "nothing",
            "model": model,
            "rms_mm": value,
            "reference_mm": transfer.figures_mm.get(model, np.nan),
        }
        for transfer, values in found
        for model, value in values.items()
    ]
    return pd.DataFrame(rows, columns=["learned", "applied", "refitted", "model", "rms_mm", "reference_mm"])
