"""out/report.html of an arm in motion: what makes its torques differ from the model, on one page without a network."""

from __future__ import annotations

import importlib.metadata
from dataclasses import replace
from pathlib import Path

from markupsafe import Markup

from armscope.core.files import write_text
from armscope.motion.pipeline import MotionDiagnosis
from armscope.report.colours import page_variables
from armscope.report.html import render_page, significant
from armscope.report.motion_subject import MotionSubject
from armscope.report.pages.diagnosis import ANSWERS, REPORT
from armscope.report.sectioning import write_sections
from armscope.report.sections.motion import MOTION_SECTIONS

QUIET = ("table", "joint stands", "uneven time")
"""Kinds of notices that lie folded."""


def write_motion_report(found: MotionDiagnosis, source: str, folder: Path | str) -> Path:
    """Write ``report.html`` and ``figures/*.svg`` of a diagnosis of a motion.

    Args:
        found: the diagnosis.
        source: the table's name.
        folder: where the page goes.

    Returns:
        The page's path.
    """
    folder, subject = Path(folder), MotionSubject(found, source)
    sections = write_sections(MOTION_SECTIONS, subject, "motion", folder)
    verdict = found.verdict
    causes, _, rest = verdict.headline.partition(". ")
    tag, answer = ANSWERS[verdict.answer]
    page = render_page(
        "motion.html.j2",
        version=importlib.metadata.version("armscope"),
        arm_name=found.arm.name,
        source=source,
        verdict=verdict,
        tag=tag,
        answer=answer,
        headline=f"{causes}." if rest else causes,
        rest=rest,
        warnings=[
            replace(notice, text=notice.text.replace("`", "")) for notice in verdict.notices if notice.kind not in QUIET
        ],
        tiles=_tiles(subject),
        sections=sections,
        shades=Markup(page_variables()),
    )
    write_text(folder / REPORT, page)
    return folder / REPORT


def _tiles(subject: MotionSubject) -> list[tuple[str, str, str]]:
    """(number, what it is, details) for the strip under the headline."""
    verdict, held_out = subject.verdict, subject.verdict.held_out
    many = len(verdict.runs) > 1
    runs = f" in {len(verdict.runs)} runs" if many else ""
    return [
        (_percent(held_out.stated), "error of the arm as stated", "of the torque, on held-out motion"),
        (_percent(held_out.background), "with friction and rotors", "fitted for every joint"),
        (_percent(held_out.model), "with masses and causes", f"held out: {held_out.what}"),
        (f"{verdict.samples:,}".replace(",", " "), "samples", f"{subject.source}{runs}, {verdict.rows} rows used"),
    ]


def _percent(share: float) -> str:
    return f"{significant(100 * share, 2)} %"
