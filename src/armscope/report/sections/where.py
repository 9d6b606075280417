"""Where the trouble is: the arm coloured by share, and the effects in their order."""

from __future__ import annotations

from typing import Any

from armscope.report.figures.arm import arm_figure
from armscope.report.sectioning import Section
from armscope.report.sections.effects import findings
from armscope.report.subject import Subject


def _context(subject: Subject) -> dict[str, Any]:
    return {**findings(subject.verdict), "arm": subject.arm}


WHERE = Section("where", "Where", "Where the trouble is", _context, (arm_figure,))
