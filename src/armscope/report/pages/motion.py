"""out/report.html of an arm in motion: what makes its torques differ from the model, on one page without a network."""

from __future__ import annotations

import importlib.metadata
from dataclasses import replace
from pathlib import Path
from typing import Any

from markupsafe import Markup

from armscope.core.files import write_text
from armscope.motion.pipeline import MotionDiagnosis
from armscope.report.colours import page_variables
from armscope.report.html import render_page
from armscope.report.motion_subject import MotionSubject
from armscope.report.pages.diagnosis import ANSWERS, ORDER, REPORT
from armscope.report.sectioning import write_sections
from armscope.report.sections.motion import MOTION_SECTIONS
from armscope.report.sections.motion_work import error_in_words, motion_work_order

QUIET = ("table", "joint stands", "uneven time")  # Kinds of notices that lie folded


def write_motion_report(
    found: MotionDiagnosis, source: str, folder: Path | str, robot: Path | str = "robot.yaml"
) -> Path:
    """Write ``report.html``, ``work-order.html`` and ``figures/*.svg`` of a diagnosis of a motion.

    Args:
        found: the diagnosis.
        source: the table's name.
        folder: where the page goes.
        robot: the arm's file, as the user named it.

    Returns:
        The page's path.
    """
    subject, folder = MotionSubject(found, source, robot, folder), Path(folder)
    sections = write_sections(MOTION_SECTIONS, subject, "motion", folder)
    verdict = found.verdict
    causes, _, rest = verdict.headline.partition(". ")
    tag, answer = ANSWERS[verdict.answer]
    page = render_page(
        "motion.html.j2",
        **_about(subject),
        tag=tag,
        answer=answer,
        headline=f"{causes}." if rest else causes,
        rest=rest,
        tiles=_tiles(subject),
        sections=sections,
        shades=Markup(page_variables()),
    )
    write_text(folder / REPORT, page)
    write_text(
        folder / ORDER, render_page("motion_work_order.html.j2", **_about(subject), **motion_work_order(subject))
    )
    return folder / REPORT


def _about(subject: MotionSubject) -> dict[str, Any]:
    """What both pages say of what they are about."""
    notices = [notice for notice in subject.verdict.notices if notice.kind not in QUIET]
    return {
        "version": importlib.metadata.version("armscope"),
        "arm_name": subject.arm.name,
        "source": subject.source,
        "verdict": subject.verdict,
        "warnings": [replace(notice, text=notice.text.replace("`", "")) for notice in notices],
    }


def _tiles(subject: MotionSubject) -> list[tuple[str, str, str]]:
    """(number, what it is, details) for the strip under the headline."""
    verdict, held_out = subject.verdict, subject.verdict.held_out
    many = len(verdict.runs) > 1
    runs = f" in {len(verdict.runs)} runs" if many else ""
    return [
        (error_in_words(held_out.stated), "error of the arm as stated", "of the torque, on held-out motion"),
        (error_in_words(held_out.background), "with friction and rotors", "fitted for every joint"),
        (error_in_words(held_out.model), "with masses and causes", f"held out: {held_out.what}"),
        (f"{verdict.samples:,}".replace(",", " "), "samples", f"{subject.source}{runs}, {verdict.rows} rows used"),
    ]
