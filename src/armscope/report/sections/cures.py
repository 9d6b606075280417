"""Try before you cure: each cause can be switched off, and the error in the workspace follows."""

from __future__ import annotations

import base64
import json
import math
from typing import Any

import numpy as np
from markupsafe import Markup

from armscope.core.averages import rms
from armscope.core.types import Array
from armscope.report.figures.arm import location_shares
from armscope.report.figures.error_field import ErrorField, turnable
from armscope.report.sectioning import Section, Subject
from armscope.verdict.sentences import holds
from armscope.verdict.wording import capitalised, millimetres, plain

FINEST = 32_767  # Errors are embedded as whole numbers of 16 bits: a part in so many of the largest

AFTER = "only beside what gives way: alone it changes nothing"  # In place of what curing a wrong payload alone leaves


def _context(subject: Subject) -> dict[str, Any]:
    worth, verdict = subject.worth, subject.verdict
    before = rms(worth.before)

    awaiting = {cause.name for cause in worth.causes if cause.requires}

    def cured(moved: Array) -> float:
        return rms(worth.before - moved)

    def told(mm: float) -> str:
        return millimetres(subject.expected(mm))

    return {
        "field": turnable(subject.arm, _field(subject)),
        "cures": Markup(json.dumps(_data(subject), separators=(",", ":"))),
        "held_out": math.isfinite(verdict.held_out.after) and holds(verdict),
        "switches": [
            (capitalised(plain(name)), AFTER if name in awaiting else f"alone: {told(before)} → {told(cured(moved))}")
            for name, moved in worth.switches
        ],
        "shown": len(worth.rows),
        "left_out": verdict.rows - len(worth.rows),
        "bad_shots": len(verdict.suspects),
    }


def _data(subject: Subject) -> dict[str, Any]:
    """What cures.js reads: mm as 16-bit whole numbers of a unit of their own, and what to expect of other poses.

    The square expected is a straight line over the square on the recorded rows: its value at no error, and its slope.
    """
    worth = subject.worth
    ends = [(rms(errors) ** 2, subject.expected(rms(errors)) ** 2) for errors in (worth.before, worth.left)]
    (most, expected), (least, expected_least) = ends
    slope = (expected - expected_least) / (most - least) if most > least else 1.0
    line = [expected_least - slope * least, slope]
    return {"expected": line, "before": _packed(worth.before), "cures": [_packed(moved) for _, moved in worth.switches]}


def _packed(errors: Array) -> dict[str, Any]:
    unit = float(np.abs(errors).max(initial=0.0)) / FINEST or 1.0
    whole = np.round(errors / unit).astype("<i2")
    return {"unit": unit, "values": base64.b64encode(whole.tobytes()).decode()}


def _field(subject: Subject) -> ErrorField:
    """The residuals in the workspace, to be turned."""
    verdict, rows = subject.verdict, subject.worth.rows
    return ErrorField(
        points_mm=verdict.residuals.points[rows],
        motor_angles=subject.recordings.motor_angles[rows],
        ids=verdict.residuals.id[rows].tolist(),
        groups=verdict.residuals.run[rows].tolist(),
        group_word="run",
        row_word="row",
        stages=(("error", "measured minus modelled, as switched above"),),
        errors_mm={"model": (subject.worth.before,)},
        shares=location_shares(verdict),
    )


CURES = Section("cures", "Try the cures", "How much better: try before you cure", _context)
