"""Torques of a table of motions by a model file: every row at its own time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.motion.check import refuse_other_joints
from armscope.motion.library.changes_catalogue import CHANGES
from armscope.motion.library.clauses_of_changes import spells
from armscope.motion.library.warmth import is_while_running
from armscope.motion.model.file import load_motion_model
from armscope.motion.model.fitted import MotionModel, predicted_links, predicted_torque
from armscope.motion.samples.timing import Stretch, mended_rows, stretches
from armscope.motion.samples.turns import counted_on, laid_about
from armscope.recordings.motions import Motions, read_motions, torque_columns

WARM = ("warm speed", "warm side", "curve over temperature")
"""Laws that follow a temperature."""


def predict_motions(model: Path, motions: Path) -> tuple[pd.DataFrame, list[str]]:
    """The torques that a model says, at every row of a table of motions.

    Args:
        model: model.yaml of a diagnosis of a motion.
        motions: a table like motions.csv, with torques or without.

    Returns:
        Columns run, time_s (as recorded), tau1_nm ... (sliding: f1_n), where the model is of currents current1_a ...,
        and where it knows links beside their motors q1_link_rad ...; and notes.

    Raises:
        InputError: a file that can't be used, or a temperature that the model follows and the table lacks.
    """
    fitted = load_motion_model(model)
    return torque_table(fitted, read_motions(motions, fitted.arm.n_motors, measured=False))


def torque_table(fitted: MotionModel, rows: Motions) -> tuple[pd.DataFrame, list[str]]:
    """The torques that a model says, as `armscope predict` writes them; and notes.

    Args:
        fitted: the model.
        rows: of a motion; its torques are not looked at.

    Returns:
        As `predict_motions`.

    Raises:
        InputError: as `predict_motions`.
    """
    refuse_other_joints(fitted.arm, rows)
    rows, turns = counted_on(rows)
    rows, about = laid_about(rows, fitted.positions)
    follows = {getattr(cause.placed.columns, "kind", "") for cause in fitted.causes}
    if rows.temperature is None and follows & set(WARM):
        rule = "a cause in the model follows it, so it must be known in every row"
        raise InputError(rows.source, "line 1", "no column temperature_c", rule, "Add it to the table.")
    if rows.temperature is not None and follows & set(WARM) and np.isnan(rows.temperature).any():
        run = rows.run[np.isnan(rows.temperature).any(axis=1)][0]
        rule = "a cause in the model follows it, so it must be known in every run"
        raise InputError(rows.source, f"run {run}", "no temperature in any row", rule, "State it once at least.")
    fitted, left_out = of_other_motion(fitted)
    torque, notes = torque_of_rows(fitted, rows)
    table = (
        pd.DataFrame({"run": rows.run, "time_s": rows.time}) if rows.run.any() else pd.DataFrame({"time_s": rows.time})
    )
    names = torque_columns(fitted.arm.sliding)
    table[names] = torque
    if fitted.links:
        links, _ = _at_rows(rows, lambda laid: predicted_links(fitted, laid))
        for j in sorted({cause.placed.joints[0] for cause in fitted.links}):
            table[f"q{j + 1}_link_{'m' if fitted.arm.sliding[j] else 'rad'}"] = links[:, j]
    if fitted.kind == "current":
        table[[f"current{j + 1}_a" for j in range(fitted.arm.n_motors)]] = torque / fitted.arm.gains
    left_out += of_single_runs(fitted, rows.runs)
    return table, [*rows.notes, *(notice.text for notice in (*turns, *about)), *notes, *left_out]


def of_other_motion(model: MotionModel) -> tuple[MotionModel, list[str]]:
    """The model without what came and went while its own motion was recorded, and a note on each.

    What the arm carried then, or read, no other motion has, nor the same path once more.
    """
    changes = [cause for cause in model.causes if cause.placed.cause in CHANGES]
    warming = [cause for cause in model.causes if is_while_running(cause.placed.columns)]
    kept = tuple(cause for cause in model.causes if cause not in changes)
    notes = (
        [
            f"Not in this prediction: {cause.placed} ({spells(cause.placed.scanned)}), which came and went while the "
            "model's own motion was recorded. State what is carried as payload_kg in every row."
            for cause in changes
        ]
        + [
            f"Taken as at the end of the model's own motion: {cause.placed}, which changed meanwhile. How warm "
            "the arm is here nobody knows: record temperature_c."
            for cause in warming
        ]
        + [
            f"Taken to come back in each run: {cause.placed}, over the time since the model's own motion began."
            for cause in kept
            if getattr(cause.placed.columns, "kind", "") == "curve over time"
        ]
    )
    return replace(model, causes=kept), notes


def of_single_runs(model: MotionModel, runs: Sequence[str]) -> list[str]:
    """A note on each load that one run of the model's own motion had: a run of that name has it here, no other."""
    notes = []
    for cause in model.causes:
        own, there = ", ".join(cause.placed.runs), ", ".join(run for run in cause.placed.runs if run in runs)
        if there:
            notes.append(
                f"Run {there} is taken to have what the model's own run of that name had: {cause.placed}. Where it is "
                "another motion, give it another name, and state what is carried as payload_kg."
            )
        elif own:
            notes.append(
                f"Not in this prediction: {cause.placed}, of run {own} of the model's own motion alone. State what is "
                "carried as payload_kg."
            )
    return notes


def torque_of_rows(model: MotionModel, motions: Motions) -> tuple[Array, list[str]]:
    """The torque at every row: laid on an even grid, predicted, and taken at the row's own (mended) time.

    Args:
        model: the model.
        motions: rows in any order of runs; torques are not looked at.

    Returns:
        (N, m) N m (N), NaN where a motion is too short; and notes.

    Raises:
        InputError: time goes back, or is not in seconds.
    """
    return _at_rows(motions, lambda laid: predicted_torque(model, laid))


def _at_rows(motions: Motions, says: Callable[[list[Stretch]], list[Array]]) -> tuple[Array, list[str]]:
    kept, time, notices = mended_rows(motions)
    laid = [replace(stretch, since=None) for stretch in stretches(motions.rows(kept).at_times(time))]
    torque = np.full(motions.q.shape, np.nan)
    found = says(laid)
    of_kept = np.full((len(kept), motions.n_motors), np.nan)
    run = motions.run[kept]
    for stretch, values in zip(laid, found, strict=True):
        slack = 0.5 / stretch.rate
        inside = np.flatnonzero(
            (run == stretch.run) & (time >= stretch.time[0] - slack) & (time <= stretch.time[-1] + 2 * slack)
        )
        of_kept[inside] = np.column_stack([np.interp(time[inside], stretch.time, column) for column in values.T])
    # a repeated row has the torque of the row that it repeats
    torque[kept] = of_kept
    order = np.arange(len(motions))
    last = np.maximum.accumulate(np.where(np.isin(order, kept), order, -1))
    repeated = (last != order) & (last >= 0)
    torque[repeated] = torque[last[repeated]]
    return torque, [notice.text for notice in notices]
