"""What a verdict holds of the rows and of the model that was fitted to them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.attribution_map import atlas
from armscope.diagnosis.summary.constants import TELLING
from armscope.diagnosis.summary.mislabelled import reads_as
from armscope.diagnosis.summary.untold_sides import as_recorded, left_without_untold, of_unknown_side, without_untold
from armscope.fitting.refit import Refit
from armscope.measurement.constants import WEIGHTS
from armscope.physics.backgrounds import GEOMETRIC
from armscope.physics.carried_on import carried_on
from armscope.physics.effect import Part
from armscope.physics.freeform import about_its_mean, held
from armscope.physics.geometric import BACKGROUND, joint_zero
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings
from armscope.verdict.diagnosis import Residuals
from armscope.verdict.schema import NO_BAD_SHOTS, ROWS_LEFT_OUT, HeldOut, Notice, Orientations, SuspectRow
from armscope.verdict.wording import millimetres


def told_of_rows(state: DiagnosisState) -> dict[str, Any]:
    """What a verdict holds of the rows and of the model fitted to them, whatever is said about it.

    Args:
        state: the finished selection.

    Returns:
        Fields of the `Diagnosis` by name.
    """
    fit, recordings, left = state.fit, state.recordings, left_without_untold(state)
    return {
        "arm": fit.model.arm.name,
        "source": recordings.source,
        "recordings": as_recorded(recordings),
        "rows": len(recordings),
        "runs": tuple(str(run) for run in np.unique(recordings.run)),
        "residual_after_mm": _weighted_rms(fit, left),
        "atlas": atlas(fit.layout, fit.model, recordings, fit.weights.of_reference),
        "residuals": _residuals(state, left),
        "suspects": _suspects(state),
        "model": _to_predict(without_untold(state), recordings),
        "orientations": _orientations(state),
    }


def _weighted_rms(fit: Refit, left: Array) -> float:
    trusted = fit.weights.robust_weight > WEIGHTS.inlier_weight
    return float(np.sqrt(np.mean(left[trusted] ** 2)))


def _residuals(state: DiagnosisState, left: Array) -> Residuals:
    table, fit = state.recordings, state.fit
    return Residuals(
        points=fit.model.to_base(table.positions, table.run) * 1e3,
        before=state.first.points_mm,
        after=left,
        weight=fit.weights.robust_weight,
        id=table.id,
        run=table.run,
    )


def _orientations(state: DiagnosisState) -> Orientations | None:
    """How well the channel of orientations is explained, where it took part."""
    for weights in state.fit.weights.of_channels:
        if weights.channel.name == "orientation":
            left, before = state.fit.channel_residuals["orientation"], state.first["orientation"]
            return Orientations(
                rows=int(np.isfinite(left).all(axis=1).sum()),
                noise_mrad=1e3 * float(np.sqrt(np.mean(left[weights.counts] ** 2))),
                lever_mm=1e3 * weights.scale,
                before_mrad=1e3 * float(np.sqrt(np.mean(before[weights.counts] ** 2))),
                instrument_mrad=1e3
                * _misread_rms(state.fit.model, state.recordings.rows(np.flatnonzero(weights.counts))),
            )
    return None


def _misread_rms(model: FittedModel, rows: Recordings) -> float:
    """By how much orientations were read wrongly with the tool's attitude, rad RMS per axis."""
    misread = model.scene(rows).misread(model.everything)
    return 0.0 if misread is None else float(np.sqrt(np.mean(misread**2)))


def rows_left_out(state: DiagnosisState, held_out: HeldOut) -> list[Notice]:
    """That rows that look like bad shots are many and make a difference; where too many, what is promised is with them.

    Args:
        state: the finished selection.
        held_out: its errors on rows that took no part.

    Returns:
        One notice, or none.
    """
    out = int(np.count_nonzero(state.fit.weights.robust_weight < WEIGHTS.inlier_weight))
    rows, after, with_them = len(state.recordings), held_out.after, held_out.after_all_rows
    if out <= TELLING.few_left_out * rows or not with_them > TELLING.left_out_matters * after:
        return []
    side = "" if state.recordings.approach is not None else ", and play whose side was not recorded looks so"
    text = (
        f"{out} of {rows} rows fit none of this and count little: with them the error on poses that took no part is "
        f"{millimetres(with_them)}, not {millimetres(after)}. So many are seldom bad shots{side}. Measure some of them "
        "again before anything is changed."
    )
    return [Notice(NO_BAD_SHOTS if out > TELLING.most_bad_shots * rows else ROWS_LEFT_OUT, text)]


def _suspects(state: DiagnosisState) -> tuple[SuspectRow, ...]:
    fit, table = state.fit, state.recordings
    relative = fit.weights.robust_weight
    rows = np.flatnonzero((relative < WEIGHTS.inlier_weight) & ~of_unknown_side(state))
    size = np.linalg.norm(fit.residuals, axis=1)
    worst = rows[np.argsort(-size[rows])][: TELLING.listed_suspects]
    return tuple(
        SuspectRow(str(table.id[r]), str(table.run[r]), float(size[r]), float(relative[r]), target)
        for r, target in zip(worst, reads_as(state, worst), strict=True)
    )


def _to_predict(model: FittedModel, recordings: Recordings) -> FittedModel:
    """The model to predict with: its free curves go no farther than they were learned.

    What held-out errors count is in it. A wander in the order of rows stays as the last row found it: a file without it
    misses by all that the arm had warmed up or the base had moved.
    """
    model = _zeros_with_geometry(carried_on(model, recordings), recordings)
    parts = tuple(replace(p, placed=held(p.placed, recordings)) for p in model.parts)
    return replace(model, parts=parts)


def _zeros_with_geometry(model: FittedModel, recordings: Recordings) -> FittedModel:
    """The same model, in which the mean of a joint's curve is a small error of geometry, where these are in it."""
    if not any(part.placed.family == GEOMETRIC for part in model.background):
        return model
    scene, parts, zeros = model.scene(recordings), [], []
    for part in model.parts:
        shape, mean = about_its_mean(part, scene)
        parts.append(shape)
        if mean:
            zero = joint_zero(BACKGROUND, Location.of(part.placed.location).number)
            zeros.append(Part(zero, np.array([mean])))
    return replace(model, parts=tuple(parts), background=(*model.background, *zeros))
