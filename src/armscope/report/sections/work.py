"""What to do: the work order, in short."""

from __future__ import annotations

from typing import Any

from armscope.report.sectioning import Section
from armscope.report.subject import Subject
from armscope.verdict.wording import millimetres


def _context(subject: Subject) -> dict[str, Any]:
    return {"tasks": subject.tasks, "before": millimetres(subject.verdict.residual_before_mm), "mm": millimetres}


WORK = Section("work", "Work order", "What to do", _context, applies=lambda verdict: bool(verdict.effects))
