"""Before and after in the workspace, to be turned, as arrows, and along each joint's motion."""

from __future__ import annotations

from typing import Any

from armscope.report.figures.along_joints import along_joints_figure
from armscope.report.figures.arm import location_shares
from armscope.report.figures.error_field import MOST_ROWS, ErrorField, turnable
from armscope.report.figures.residual_vectors import MOST_ARROWS, vectors_figure
from armscope.report.subject import Section, Subject


def _context(subject: Subject) -> dict[str, Any]:
    return {"field": turnable(subject.arm, _field(subject)), "field_rows": MOST_ROWS, "arrows": MOST_ARROWS}


def _field(subject: Subject) -> ErrorField:
    """The residuals in the workspace, to be turned."""
    verdict = subject.verdict
    rows = verdict.residuals
    bad = {(row.id, row.run): f"fits badly, {row.weight:.2g} of its weight kept" for row in verdict.suspects}
    keys = enumerate(zip(rows.id.tolist(), rows.run.tolist(), strict=True))
    return ErrorField(
        points_mm=rows.points,
        motor_angles=subject.recordings.motor_angles,
        ids=rows.id.tolist(),
        groups=rows.run.tolist(),
        group_word="run",
        row_word="row",
        stages=(
            ("before", "measured minus nominal, base and tool placed"),
            ("after", "measured minus the fitted model"),
        ),
        errors_mm={"fitted model": (rows.before, rows.after)},
        suspects={row: bad[key] for row, key in keys if key in bad},
        shares=location_shares(verdict),
    )


WORKSPACE = Section("workspace", "Before and after", _context, (vectors_figure, along_joints_figure))
