"""out/report.html: what a diagnosis found, on one page that needs no network."""

from __future__ import annotations

import importlib.metadata
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from armscope.core.files import write_text
from armscope.core.numerals import rounded
from armscope.errormodels.reference_models import held_out_rms
from armscope.recordings import Recordings
from armscope.recordings.motion import moving
from armscope.report.figures.diagnosis import SavedFigure, location_shares, save_all, waterfall_steps
from armscope.report.figures.error_field import MOST_ROWS, ErrorField, turnable
from armscope.report.html import render_page
from armscope.report.sections.effect_cards import Card, card
from armscope.robot import Arm
from armscope.verdict.schema import Diagnosis, FoundEffect, NextPoses, SuspectRow
from armscope.verdict.wording import main_and_minor, millimetres, percent

MOST_SUSPECTS = 40
ANSWERS = {
    "nothing missing": ("holds", "nothing is missing"),
    "explained": ("holds", "explained"),
    "partly explained": ("depends", "partly explained"),
    "cannot tell": ("depends", "cannot tell"),
}
GLOSSARY = (
    ("Mismatch, residual", "Measured tool position minus the position that the model predicts from the joint angles."),
    ("Free frames", "Where the robot's base stands in the instrument's frame, and where the measured point sits on the "
     "tool. Both are always fitted first: nobody knows them beforehand to a tenth of a millimetre."),
    ("RMS per axis", "Typical size of the residual: root of the mean square over all x, y and z values. The typical "
     "3D distance is 1.7 times as large."),
    ("Held-out rows", "Rows that took no part in finding or fitting the effects. A model that merely memorises the "
     "rows it has seen fails on them."),
    ("Noise", "What remains when the model is right: instrument and repeatability together, 1 sigma per axis."),
    ("Share of the mismatch", "How much of the squared residual after the free frames an effect explains, averaged "
     "over the orders in which the effects can enter the model (Shapley's value). The shares of all effects and of the "
     "small errors everywhere add up to what the whole model explains."),
    ("Driver", "What an effect follows: a joint's angle, the load of gravity on it, temperature, time, ..."),
    ("Evidence, nats", "How much more probable the recordings are with the effect than without it, as a natural "
     "logarithm, after paying for the size of the library searched. 1 nat is odds of 3 to 1, 5 nats 150 to 1."),
    ("95 % interval", "Where the true number lies in 95 of 100 such analyses, if the name is right. Smooth errors that "
     "no effect explains are counted in, as large as what is left shows them to be."),
    ("Chosen in resampled data", "The rows are drawn anew with replacement and the search is repeated: an effect that "
     "is chosen nearly every time does not hang on a few rows."),
    ("Compliance, stiffness", "How far something gives way per unit of load, and its reciprocal."),
    ("D-H row", "The four numbers (a, α, d, θ; Denavit and Hartenberg) that place one joint relative to the last."),
    ("µrad, mrad", "Millionth and thousandth of a radian. 1 mrad is 0.057° and moves a point 1 m away by 1 mm."),
)  # fmt: skip


def write_report(verdict: Diagnosis, folder: Path | str) -> Path:
    """Write ``report.html`` and ``figures/*`` (PNG and SVG) for a diagnosis; returns the page's path.

    Args:
        verdict: the diagnosis.
        folder: where the page goes.
    """
    folder = Path(folder)
    arm, recordings = verdict.model.arm, verdict.recordings
    references = held_out_rms(arm, recordings, verdict.residuals.before)
    figures = save_all(verdict, arm, recordings, folder / "figures", references)
    page = render_page("diagnosis.html.j2", **_content(verdict, arm, recordings, figures, references))
    write_text(folder / "report.html", page)
    return folder / "report.html"


def _content(
    verdict: Diagnosis,
    arm: Arm,
    recordings: Recordings,
    figures: Mapping[str, SavedFigure],
    references: Sequence[tuple[str, float]],
) -> dict[str, Any]:
    numbered = {id(effect): number for number, effect in enumerate(verdict.effects, start=1)}

    def as_card(effect: Any) -> Card:
        number = numbered[id(effect)]
        name = f"curve_{number}"
        return card(effect, number, name if name in figures else "")

    main, minor = main_and_minor(verdict.effects)
    tag, answer = ANSWERS[verdict.answer]
    return {
        "version": importlib.metadata.version("armscope"),
        "verdict": verdict,
        "source": Path(verdict.source).name,
        "arm": arm,
        "headline": verdict.headline,
        "tag": tag,
        "answer": answer,
        "tiles": _tiles(verdict),
        "improvement": improvement(verdict),
        "figures": figures,
        "field": turnable(arm, _field(verdict, recordings)),
        "field_rows": MOST_ROWS,
        "cards": [as_card(effect) for effect in main],
        "minor": [as_card(effect) for effect in minor],
        "minor_share": percent(sum(effect.share for effect in minor)),
        "open_question": _concerns(verdict.next_poses, main),
        "background": [
            (family.family, percent(family.share), f"{100 * min(max(family.share, 0.0), 1.0):.1f}")
            for family in verdict.background_families
            if family.present
        ],
        "background_share": percent(verdict.background.share),
        "steps": _steps(verdict, references),
        "left_is_told": _left_is_told(verdict),
        "notices": [notice for notice in verdict.notices if not _said(notice.text, verdict.headline)],
        "unexplained_rms": millimetres(verdict.unexplained.rms_mm),
        "suspects": _suspects(verdict.suspects),
        "suspects_left_out": max(0, len(verdict.suspects) - MOST_SUSPECTS),
        "next_poses": None if verdict.next_poses is None else _next_poses(verdict.next_poses),
        "assumptions": assumptions(verdict, arm, recordings),
        "glossary": GLOSSARY,
        "settings": pd.DataFrame(
            [(str(key).replace("_", " "), str(value)) for key, value in verdict.settings.items()],
            columns=["setting", "value"],
        ),
    }


def _field(verdict: Diagnosis, recordings: Recordings) -> ErrorField:
    """The residuals in the workspace, to be turned."""
    rows = verdict.residuals
    bad = {(row.id, row.run): f"fits badly, {row.weight:.2g} of its weight kept" for row in verdict.suspects}
    keys = enumerate(zip(rows.id.tolist(), rows.run.tolist(), strict=True))
    return ErrorField(
        points_mm=rows.points,
        motor_angles=recordings.motor_angles,
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


def _turns_improved(verdict: Diagnosis) -> str:
    """What becomes of the error of orientations, where they were measured."""
    before, after = verdict.held_out.turn_before, verdict.held_out.turn_after
    if not (math.isfinite(before) and math.isfinite(after)):
        return ""
    return f" Of the orientations it goes from {rounded(before)} to {rounded(after)} mrad RMS per axis."


def improvement(verdict: Diagnosis) -> str:
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
        shots = f" With the suspected bad shots it is {millimetres(everything)}." if everything > 1.05 * after else ""
        falls = f"{start}falls from {millimetres(before)} to {millimetres(after)} RMS per axis{apart}{noise}.{shots}"
        return f"{falls}{_turns_improved(verdict)}"
    return f"{start}stays where it is: {millimetres(before)} before, {millimetres(after)} after."


def _steps(verdict: Diagnosis, references: Sequence[tuple[str, float]]) -> pd.DataFrame:
    rows = [(step.label, step.held_out_mm, step.spread_mm, step.fitted_mm) for step in waterfall_steps(verdict)]
    rows += [(f"for comparison: {name}", rms, np.nan, np.nan) for name, rms in references]
    names = ["model", "held-out RMS (mm)", "its spread over the folds (mm)", "RMS on the fitted rows (mm)"]
    return pd.DataFrame(rows, columns=names)


def _left_is_told(verdict: Diagnosis) -> str:
    """The anchor of the card that already shows what is left unexplained; empty where there is none."""
    left = verdict.unexplained
    for number, effect in enumerate(verdict.effects, start=1):
        if left.present and effect.effect == "unknown" and effect.location == left.location:
            return card(effect, number).anchor
    return ""


def _said(text: str, sentence: str) -> bool:
    """Whether a notice only repeats the headline."""
    return text.rstrip(".").lower() in sentence.lower()


def _concerns(poses: NextPoses | None, effects: Sequence[FoundEffect]) -> bool:
    """Whether the two readings that could not be told apart are about one of these effects."""
    return poses is not None and any(
        poses.first.startswith(f"{effect.effect} at {effect.location}") for effect in effects
    )


def _suspects(suspects: Sequence[SuspectRow]) -> pd.DataFrame:
    worst = sorted(suspects, key=lambda row: row.weight)[:MOST_SUSPECTS]
    table = pd.DataFrame(
        [(row.id, row.run or "–", row.residual_mm, f"{row.weight:.2f}") for row in worst],
        columns=["row (id)", "run", "left over (mm)", "weight kept (1 = full)"],
    )
    return table.drop(columns="run") if all(not row.run for row in worst) else table


def _next_poses(poses: NextPoses) -> pd.DataFrame:
    degrees = np.degrees(poses.motor_angles)
    table = pd.DataFrame({"pose": np.arange(1, len(degrees) + 1)})
    for motor in range(degrees.shape[1]):
        table[f"q{motor + 1} (deg)"] = [f"{angle:.1f}" for angle in degrees[:, motor]]
    if np.any(np.nan_to_num(poses.payload_kg) != 0):
        table["payload (kg)"] = [f"{mass:g}" for mass in poses.payload_kg]
    table["the two differ by (mm)"] = poses.separation_mm
    return table


def assumptions(verdict: Diagnosis, arm: Arm, recordings: Recordings) -> list[str]:
    """What the verdict rests on, in sentences."""
    loads = (
        "Gravity loads come from the recorded joint torques."
        if recordings.torque is not None
        else "Gravity loads come from the masses that robot.yaml states."
        if arm.has_masses
        else "robot.yaml states no masses: loads are known up to unknown mass moments, so compliances are products "
        "with them unless a known payload sets the scale."
    )
    context = {
        "side of approach (backlash)": recordings.approach,
        "joint speed (lag)": recordings.speed,
        "temperature (thermal expansion)": recordings.temperature,
        "time (drift)": recordings.time,
        "payload": recordings.payload,
    }
    missing = [name for name, values in context.items() if values is None]
    still = [f"joint {j + 1}" for j in np.flatnonzero(~moving(recordings.motor_angles))]
    sentences = [
        "The base's place in the measurement frame is free for each run, the tool point for each target; what they "
        "can absorb is not part of the mismatch.",
        "Every link, drive and bearing may have small errors, as in any real arm (assumed: of tolerance size, about 1 "
        "mm and 1 mrad, for the geometry); one of them is named only when the recordings ask for it by itself.",
        loads,
        f"The noise per axis, {millimetres(verdict.noise_mm)}, is {verdict.noise_source}."
        if math.isfinite(verdict.noise_mm)
        else "The noise is not known.",
        "Joint angles are the commanded ones, lengths hold at 20 °C, the arm stands still or moves slowly, and each "
        "effect is small: it is found in a linear picture and then fitted exactly.",
    ]
    if verdict.orientations is not None:
        seen = verdict.orientations
        sentences.append(
            f"Measured orientations ({seen.rows} rows) take part: a turn of the tool counts as much as a shift at a "
            f"lever of {seen.lever_mm:.0f} mm, the ratio of what the model leaves of points and of orientations "
            f"({rounded(seen.noise_mrad)} mrad per axis). How the tool is turned on the flange is free. Sizes in mm, "
            "the atlas and the waterfall speak of the tool point alone."
        )
    if missing:
        sentences.append(f"Not recorded, so nothing that follows it can be seen: {', '.join(missing)}.")
    if still:
        sentences.append(f"Never moved, so nothing that follows its angle can be seen: {', '.join(still)}.")
    sentences.extend(f"{note[:1].upper()}{note[1:]}." for note in recordings.notes)
    return sentences
