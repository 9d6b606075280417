"""out/report.html: what a diagnosis found, on one page that needs no network."""

from __future__ import annotations

import importlib.metadata
import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from markupsafe import Markup

from armscope.core.files import write_text
from armscope.report.html import render_page
from armscope.report.sections.better import improvement
from armscope.report.sections.effects import findings
from armscope.report.sections.registry import SECTIONS
from armscope.report.style import save_figure
from armscope.report.subject import Drawn, Section, Subject
from armscope.verdict.schema import Diagnosis
from armscope.verdict.wording import millimetres

FORMATS = ("png", "svg")
ANSWERS = {
    "nothing missing": ("holds", "nothing is missing"),
    "explained": ("holds", "explained"),
    "partly explained": ("depends", "partly explained"),
    "cannot tell": ("depends", "cannot tell"),
}


@dataclass(frozen=True)
class SavedFigure:
    """A figure's file for the page (SVG) and what it shows, for those who can't see it."""

    path: Path
    alt: str


@dataclass(frozen=True)
class Written:
    """A section as the page takes it."""

    name: str
    link: str
    html: Markup


def write_report(verdict: Diagnosis, folder: Path | str) -> Path:
    """Write ``report.html`` and ``figures/*`` (PNG and SVG) for a diagnosis; returns the page's path.

    Args:
        verdict: the diagnosis.
        folder: where the page goes.
    """
    folder, subject = Path(folder), Subject(verdict)
    sections = [section for section in SECTIONS if section.applies(verdict)]
    figures = {
        drawn.name: _saved(drawn, folder / "figures")
        for section in sections
        for figure in section.figures
        for drawn in figure(subject)
    }
    page = render_page("diagnosis.html.j2", **_head(verdict), sections=list(_written(sections, subject, figures)))
    write_text(folder / "report.html", page)
    return folder / "report.html"


def _saved(drawn: Drawn, folder: Path) -> SavedFigure:
    return SavedFigure(save_figure(drawn.figure, folder / drawn.name, FORMATS)[-1], drawn.alt)


def _written(sections: Iterable[Section], subject: Subject, figures: dict[str, SavedFigure]) -> Iterable[Written]:
    for section in sections:
        context = {"verdict": subject.verdict, "figures": figures, **section.context(subject)}
        # its own template escaped what it was filled with
        yield Written(section.name, section.link, Markup(render_page(f"diagnosis/{section.name}.html.j2", **context)))


def _head(verdict: Diagnosis) -> dict[str, Any]:
    """What stands above the sections."""
    tag, answer = ANSWERS[verdict.answer]
    return {
        "version": importlib.metadata.version("armscope"),
        "verdict": verdict,
        "source": Path(verdict.source).name,
        "headline": verdict.headline,
        "tag": tag,
        "answer": answer,
        "tiles": _tiles(verdict),
        "improvement": improvement(verdict),
        "open_question": findings(verdict)["open_question"],
        "notices": [notice for notice in verdict.notices if not _said(notice.text, verdict.headline)],
    }


def _tiles(verdict: Diagnosis) -> list[tuple[str, str, str]]:
    """(number, what it is, details) for the strip under the headline."""
    held_out = math.isfinite(verdict.held_out.before) and math.isfinite(verdict.held_out.after)
    before = verdict.held_out.before if held_out else verdict.residual_before_mm
    after = verdict.held_out.after if held_out else verdict.residual_after_mm
    where = "RMS per axis on held-out rows" if held_out else "RMS per axis on the fitted rows (no held-out rows)"
    runs = f" in {len(verdict.runs)} runs" if len(verdict.runs) > 1 else ""
    known = math.isfinite(verdict.noise_mm)
    tiles = [
        (millimetres(before), "mismatch before", where),
        (millimetres(after), "mismatch with the fitted model", where),
    ]
    if verdict.mismatch is None and not verdict.effects:
        tiles = [(millimetres(before), "mismatch", "RMS per axis once base and tool are placed")]
    return [
        *tiles,
        (millimetres(verdict.noise_mm), "noise", f"per axis, {verdict.noise_source}" if known else "not known"),
        (f"{verdict.rows:,}".replace(",", " "), "recorded rows", f"{Path(verdict.source).name}{runs}"),
    ]


def _said(text: str, sentence: str) -> bool:
    """Whether a notice only repeats the headline."""
    return text.rstrip(".").lower() in sentence.lower()
