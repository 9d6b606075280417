"""How much better the model becomes on rows that took no part."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pandas as pd

from armscope.core.words import rounded
from armscope.report.figures.waterfall import OTHER_MODELS, STEPS, waterfall_figure, waterfall_steps
from armscope.report.sectioning import Section, Subject
from armscope.verdict.schema import Verdict
from armscope.verdict.wording import millimetres


def _turns_improved(verdict: Verdict) -> str:
    """What becomes of the error of orientations, where they were measured."""
    before, after = verdict.held_out.turn_before, verdict.held_out.turn_after
    if not (math.isfinite(before) and math.isfinite(after)):
        return ""
    return f" Of the orientations it goes from {rounded(before)} to {rounded(after)} mrad RMS per axis."


def improvement(verdict: Verdict) -> str:
    """One sentence: how much smaller the error becomes on rows that took no part."""
    before, after = verdict.held_out.before, verdict.held_out.after
    if verdict.mismatch is None and not verdict.effects:
        return "No effect was fitted, so there is nothing to test on held-out rows."
    if not (math.isfinite(before) and math.isfinite(after)):
        return (
            "Whether the model also holds on rows that took no part in the fit was not tested: there are too few rows "
            "to keep some aside, or the test was switched off."
        )
    folds = f"{verdict.held_out.folds} parts" if verdict.held_out.folds else "parts"
    together = {"configuration": "rows of alike configuration stay together", "run": "whole runs at a time"}
    by = f"; {together.get(verdict.held_out.grouped_by, verdict.held_out.grouped_by)}"
    by = by if verdict.held_out.grouped_by else ""
    start = (
        f"On rows that took no part in search or fit (the whole diagnosis was repeated with one of {folds} of the rows "
        f"kept aside{by}), the error "
    )
    if after < 0.98 * before:
        noise = f"; the noise is {millimetres(verdict.noise_mm)}" if math.isfinite(verdict.noise_mm) else ""
        spread, everything = verdict.held_out.spread, verdict.held_out.after_all_rows
        apart = f" (± {rounded(spread)} mm from part to part)" if math.isfinite(spread) else ""
        shots = _with_bad_shots(verdict) if everything > 1.05 * after else ""
        falls = f"{start}falls from {millimetres(before)} to {millimetres(after)} RMS per axis{apart}{noise}.{shots}"
        return f"{falls}{_turns_improved(verdict)}"
    return f"{start}stays where it is: {millimetres(before)} before, {millimetres(after)} after."


def _with_bad_shots(verdict: Verdict) -> str:
    """The error that counts them, and the row that lies furthest off: one that was mistyped is all of it."""
    error = f" With the suspected bad shots it is {millimetres(verdict.held_out.after_all_rows)}"
    worst = max(verdict.suspects, key=lambda row: row.residual_mm, default=None)
    if worst is None:
        return f"{error}."
    row = f"the row with id {worst.id}" + (f" of run {worst.run}" if worst.run else "")
    return f"{error}: {row} lies {millimetres(worst.residual_mm)} from where the model puts it."


def _context(subject: Subject) -> dict[str, Any]:
    steps = [(s.label, s.held_out_mm, s.spread_mm, s.fitted_mm) for s in waterfall_steps(subject.verdict)]
    steps += [(f"for comparison: {name}", rms, np.nan, np.nan) for name, rms in subject.references]
    names = ["model", "held-out RMS (mm)", "its spread over the folds (mm)", "RMS on the fitted rows (mm)"]
    keys = (*STEPS, OTHER_MODELS) if subject.references else STEPS
    return {"improvement": improvement(subject.verdict), "steps": pd.DataFrame(steps, columns=names), "keys": keys}


TITLE = "How much better the model predicts"
VALIDATION = Section("validation", "Validation", TITLE, _context, (waterfall_figure,), folded=True)
