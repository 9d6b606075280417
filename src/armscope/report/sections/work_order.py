"""What to do: the work order, in short."""

from __future__ import annotations

import math
from typing import Any

from armscope.core.averages import rms
from armscope.report.sectioning import Section, Subject
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.importance import from_part_to_part
from armscope.verdict.not_yet import NOT_YET
from armscope.verdict.sentences import holds, makes_worse
from armscope.verdict.wording import millimetres

SHOWN = 6  # Steps that stand open: those that pay most; the others unfold, and all stand in the work order to print


def _context(subject: Subject) -> dict[str, Any]:
    return {
        "not_yet": NOT_YET if makes_worse(subject.verdict) else "",
        "order": subject.order,
        "shown": SHOWN if len(subject.order.tasks) > SHOWN + 1 else len(subject.order.tasks),
        "mm": lambda mm: millimetres(subject.expected(mm)),
        "held_out": math.isfinite(subject.verdict.held_out.after) and holds(subject.verdict),
        "differ": from_part_to_part(subject.verdict),
        "folds": subject.verdict.held_out.folds,
        "before": rms(subject.worth.before),
    }


def _something_to_do(verdict: Diagnosis) -> bool:
    return bool(verdict.effects or (verdict.mismatch and verdict.background.present))


WORK_ORDER = Section("work_order", "Work order", "What to do", _context, applies=_something_to_do)
