"""out/report.html: what a diagnosis found, on one page that needs no network; and the work order to print."""

from __future__ import annotations

import importlib.metadata
import math
from pathlib import Path
from typing import Any

import pandas as pd
from markupsafe import Markup

from armscope.core.averages import rms
from armscope.core.files import write_table, write_text, yaml_text
from armscope.physics.geometric import LINK_GEOMETRY
from armscope.report.colours import page_variables
from armscope.report.html import render_page
from armscope.report.sectioning import Subject, write_sections
from armscope.report.sections.effect_cards import title_of
from armscope.report.sections.effects import findings
from armscope.report.sections.registry import SECTIONS
from armscope.robot.controllers import UR_KINEMATICS, ZEROS_IN_IT
from armscope.verdict.corrections import (
    SETS_A_ZERO,
    as_entered,
    changes,
    corrected_origins,
    corrected_rows,
    corrected_table,
    corrected_ur_kinematics,
    unsettled,
    wrongly_stated,
    zero_offsets,
)
from armscope.verdict.diagnosis import Diagnosis, promised
from armscope.verdict.effects import INTERVAL
from armscope.verdict.entries import angle
from armscope.verdict.filenames import CURVES
from armscope.verdict.importance import from_part_to_part
from armscope.verdict.not_yet import NOT_YET
from armscope.verdict.payload_place import of_payloads
from armscope.verdict.remainder import asked_of_noise
from armscope.verdict.schema import NO_BAD_SHOTS, ROWS_LEFT_OUT, TOOL_EXCHANGED, Notice
from armscope.verdict.sentences import another_model, holds, makes_worse, more_than_noise, unusable
from armscope.verdict.wording import capitalised, main_and_minor, millimetres, percent, places_in_words
from armscope.verdict.work_order import WorkOrder

ANSWERS = {
    "nothing missing": ("holds", "nothing is missing"),
    "explained": ("holds", "explained"),
    "partly explained": ("depends", "partly explained"),
    "cannot tell": ("depends", "cannot tell"),
}
WARNINGS = (
    "check", "gravity", "approach", "orientations", "stated noise", "fewer rows than parameters", "too few rows",
    "implausible", "load in question", TOOL_EXCHANGED, ROWS_LEFT_OUT, NO_BAD_SHOTS,
)  # fmt: skip
"""Kinds of notices that stand above everything; what the headline says already does not, others lie folded."""
WORSE = f"Rows that took no part in the fit are predicted worse with this model than without it. {NOT_YET}"
REPORT, ORDER = "report.html", "work-order.html"
ZEROS, ROWS, ORIGINS = "zero_offsets.csv", "corrected_dh.csv", "corrected_origins.csv"


def write_report(verdict: Diagnosis, folder: Path | str) -> Path:
    """Write ``report.html``, ``work-order.html``, its tables as CSV, and ``figures/*.svg``."""
    folder, subject = Path(folder), Subject(verdict)
    written = write_sections(SECTIONS, subject, "diagnosis", folder)
    tables = write_work_order(subject, folder)
    page = render_page("diagnosis.html.j2", **_head(verdict), sections=written, tables=tables)
    write_text(folder / REPORT, page)
    return folder / REPORT


def write_work_order(subject: Subject, folder: Path) -> tuple[str, ...]:
    """The work order as a page, and its numbers as tables; none of a model that makes the error larger."""
    verdict, another = subject.verdict, another_model(subject.verdict)
    tasks = () if another or makes_worse(verdict) else subject.order.tasks
    numbers = {} if makes_worse(verdict) else _write_numbers(subject, folder)
    content = {
        **_about(verdict),
        "order": subject.order,
        "before": rms(subject.worth.before),
        "another": another,
        "left": min((task.then_mm for task in tasks if not (task.instead or task.finds_out)), default=None),
        "instead": min((task.then_mm for task in tasks if task.instead), default=None),
        "mm": lambda mm: millimetres(subject.expected(mm)),
        "held_out": math.isfinite(verdict.held_out.after) and holds(verdict),
        "asked": asked_of_noise(verdict).replace("`", ""),
        "differ": from_part_to_part(verdict),
        "background": percent(verdict.background.share),
        "to_confirm": [(capitalised(title_of(e)), e.confirm) for e in main_and_minor(verdict.effects)[0]],
        "wrongly_stated": wrongly_stated(verdict),
        "next_poses": verdict.next_poses.checked if verdict.next_poses and verdict.next_poses.settle else "",
        "left_out": places_in_words([effect.location for effect in unsettled(verdict)]),
        **numbers,
    }
    write_text(folder / ORDER, render_page("work_order.html.j2", **content))
    return tuple(numbers.get("written", ()))


def _write_numbers(subject: Subject, folder: Path) -> dict[str, Any]:
    """Zeros and corrected rows as files, and what the page tells of them."""
    verdict, zeros, rows = subject.verdict, zero_offsets(subject.verdict), corrected_rows(subject.verdict)
    kinematics = corrected_ur_kinematics(verdict)
    named = zeros["cause"] == "named"
    steps = [subject.order.step_of(*(f"{effect} at {joint}" for effect in SETS_A_ZERO)) for joint in zeros["joint"]]
    zeros = zeros.assign(step="" if another_model(verdict) else pd.Series(steps).where(named, ""))
    rows = None if rows is None else rows.assign(step=steps_of_rows(rows, subject.order))
    write_table(folder / ZEROS, as_entered(zeros))
    either = {ROWS: rows, ORIGINS: corrected_origins(verdict)}
    corrected = {name: table for name, table in either.items() if table is not None}
    for name, table in corrected.items():
        write_table(folder / name, table)
    if kinematics is not None:
        write_text(folder / UR_KINEMATICS, f"# {ZEROS_IN_IT}\n{yaml_text(kinematics)}")
    dh, by_calibration = verdict.model.arm.description.dh, subject.order.by_calibration
    heads, cells = corrected_table(verdict)
    return {
        "dh": [] if rows is None else [*zip(cells, rows["step"].tolist(), strict=True)],
        "dh_heads": heads,
        "skewed": "β" in " ".join(heads),
        "calibrated": "" if rows is None else next((s for s in rows["step"] if s and s == by_calibration), ""),
        "rows_change": rows is not None and changes(rows),
        "convention": "" if dh is None else dh.convention,
        "zeros": _zeros_in_words(zeros),
        "written": (ZEROS, *corrected, *([UR_KINEMATICS] if kinematics else [])),
        "kinematics": f"{UR_KINEMATICS}: {ZEROS_IN_IT}" if kinematics else "",
        "tables": [
            *(name for name, table in {ZEROS: zeros, **corrected}.items() if changes(table)),
            *([UR_KINEMATICS] if kinematics else []),
            *([CURVES] if any(effect.nameless and effect.curve is not None for effect in verdict.effects) else []),
        ],
    }


def steps_of_rows(rows: pd.DataFrame, order: WorkOrder) -> list[str]:
    """By D-H row, the step in which it is corrected, and what it must not be done without; "" where it stays."""
    changed = rows.filter(like="correction_").any(axis=1)
    steps = [order.step_of(f"{LINK_GEOMETRY.name} at link {row}") for row in rows["row"]]
    return [step if changes else "" for step, changes in zip(steps, changed, strict=True)]


def _zeros_in_words(zeros: pd.DataFrame) -> list[tuple[str, str, str]]:
    """(joint, by how much it is turned, in which step it is set) of the zeros that were named."""
    named = zeros[zeros["cause"] == "named"]
    turns, halves = named["actual_minus_commanded_mrad"] * 1e-3, named["half_interval_95_mrad"] * 1e-3
    told = zip(named["joint"], turns, halves, named["step"], strict=True)
    return [(str(j), angle(turn, half / INTERVAL), str(step)) for j, turn, half, step in told]


def _about(verdict: Diagnosis) -> dict[str, Any]:
    """What both pages say of what they are about."""
    return {
        "version": importlib.metadata.version("armscope"),
        "arm_name": verdict.arm,
        "verdict": verdict,
        "source": Path(verdict.source).name,
        "warnings": [notice for notice in verdict.notices if _warns(notice, verdict)],
        "worse": WORSE if makes_worse(verdict) else "",
    }


def _head(verdict: Diagnosis) -> dict[str, Any]:
    """What stands above the sections."""
    tag, answer = _answer(verdict)
    causes, _, rest = verdict.headline.partition(". ") if verdict.effects else (verdict.headline, "", "")
    return {
        **_about(verdict),
        "headline": f"{causes}." if rest else causes,
        "rest": rest,
        "tag": tag,
        "answer": answer,
        "tiles": _tiles(verdict),
        "open_question": findings(verdict)["open_question"],
        "shades": Markup(page_variables()),
    }


def _answer(verdict: Diagnosis) -> tuple[str, str]:
    """Colour and words of the answer; never "explained" where more than noise is left, or the table is unusable."""
    if another_model(verdict):
        return "fails", "another model?"
    if unusable(verdict):
        return "fails", "not to be relied on"
    if verdict.answer == "explained" and (more_than_noise(verdict) or makes_worse(verdict)):
        return ANSWERS["partly explained"]
    return ANSWERS[verdict.answer]


def _warns(notice: Notice, verdict: Diagnosis) -> bool:
    """Whether a notice stands above everything: it limits the whole verdict, and the headline doesn't say it."""
    if notice.text.rstrip(".").lower() in verdict.headline.lower():
        return False
    return notice.kind in WARNINGS or notice in of_payloads(verdict) or verdict.mismatch is None


def _noise(verdict: Diagnosis) -> str:
    """Noise that was estimated from what is left is no more than an upper bound where that is not all noise."""
    return "noise, at most" if more_than_noise(verdict) and "residuals" in verdict.noise_source else "noise"


def _tiles(verdict: Diagnosis) -> list[tuple[str, str, str]]:
    """(number, what it is, details) for the strip under the headline."""
    promise = promised(verdict)
    held_out = math.isfinite(promise.before) and math.isfinite(promise.after)
    before = promise.before if held_out else verdict.residual_before_mm
    after = promise.after if held_out else verdict.residual_after_mm
    where = "RMS per axis on held-out rows" if held_out else "RMS per axis on the fitted rows (no held-out rows)"
    where += ", with those that fit nothing" * promise.of_all
    runs = f" in {len(verdict.runs)} runs" if len(verdict.runs) > 1 else ""
    known = math.isfinite(verdict.noise_mm)
    tiles = [(millimetres(before), "error now", where), (millimetres(after), "error with the fitted model", where)]
    if verdict.mismatch is None and not verdict.effects:
        tiles = [(millimetres(before), "error", "RMS per axis once base and tool are placed")]
    return [
        *tiles,
        (millimetres(verdict.noise_mm), _noise(verdict), f"per axis, {verdict.noise_source}" if known else "not known"),
        (f"{verdict.rows:,}".replace(",", " "), "recorded rows", f"{Path(verdict.source).name}{runs}"),
    ]
