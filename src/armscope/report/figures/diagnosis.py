"""All figures of a diagnosis, drawn from its verdict and kept as files."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from armscope.core.numerals import shown_unit
from armscope.core.sampling import spread_evenly
from armscope.recordings import Recordings
from armscope.recordings.motion import moving
from armscope.report.figures.arm_picture import draw_arm
from armscope.report.figures.atlas import draw_atlas
from armscope.report.figures.effect_curve import Curve, draw_curves
from armscope.report.figures.next_poses import draw_poses
from armscope.report.figures.residual_vectors import draw_along_joints, draw_vectors
from armscope.report.figures.waterfall import draw_waterfall
from armscope.report.style import save_figure
from armscope.robot import Arm, chain, position_jacobian
from armscope.verdict.schema import INTERVAL, Atlas, Diagnosis, FoundEffect, Verdict, WaterfallStep
from armscope.verdict.schema import Curve as FoundCurve
from armscope.verdict.sentences import atlas_column
from armscope.verdict.wording import plain

FORMATS = ("png", "svg")
MOST_ROWS = 20_000
"""Running means along the joints need no more rows than this."""


@dataclass(frozen=True)
class SavedFigure:
    """A figure's file for the page (SVG) and what it shows, for those who can't see it."""

    path: Path
    alt: str


def save_all(
    verdict: Diagnosis, arm: Arm, recordings: Recordings, folder: Path, references: Sequence[tuple[str, float]]
) -> dict[str, SavedFigure]:
    """Draw and save all figures that this verdict has something for, by name.

    Args:
        verdict, arm, recordings: the diagnosis and what it was made of.
        folder: where the files go.
        references: other models' RMS on held-out rows, mm, for the waterfall.
    """
    saved: dict[str, SavedFigure] = {}

    def keep(name: str, figure: Figure, alt: str) -> None:
        paths = save_figure(figure, folder / name, FORMATS)
        saved[name] = SavedFigure(paths[-1], alt)

    keep(
        "arm",
        draw_arm(arm, recordings.motor_angles, location_shares(verdict)),
        "The arm in a recorded pose, joints and links coloured by their share of the mismatch",
    )
    if verdict.atlas is not None and np.isfinite(verdict.atlas.share).any():
        shares, left, marked = atlas_tables(verdict.atlas, verdict.effects)
        keep("atlas", draw_atlas(shares, marked, left), "Map of the share of the mismatch by location and driver")
    known = gathered([step for step in waterfall_steps(verdict) if np.isfinite(step.held_out_mm)])
    if known:
        noise = verdict.noise_mm if np.isfinite(verdict.noise_mm) else None
        steps, spreads = [(step.label, step.held_out_mm) for step in known], [step.spread_mm for step in known]
        drawn = draw_waterfall(steps, noise, references, spreads)
        keep("waterfall", drawn, "Held-out error as effects enter the model, with its spread from fold to fold")
    residuals = verdict.residuals
    keep(
        "vectors",
        draw_vectors(residuals.points * 1e-3, residuals.before, residuals.after),
        "Residual vectors in the workspace, before and after",
    )
    rows = spread_evenly(len(recordings), MOST_ROWS)
    angles = recordings.motor_angles[rows]
    if moving(angles).any():
        jacobian = position_jacobian(arm, chain(arm, angles))
        keep(
            "along_joints",
            draw_along_joints(angles, jacobian, residuals.before[rows], residuals.after[rows]),
            "Residual along each joint's motion against its angle, before and after",
        )
    for number, effect in enumerate(verdict.effects, start=1):
        if effect.curve is not None and worth_drawing(effect):
            keep(
                f"curve_{number}",
                draw_curves([curve_of(effect, effect.curve)]),
                f"What happens at {effect.location} over the {effect.curve.driver}, with its 95 % band",
            )
    if verdict.next_poses is not None and len(verdict.next_poses.motor_angles):
        keep("next_poses", draw_poses(arm, verdict.next_poses.motor_angles), "The arm in the poses to measure next")
    return saved


def location_shares(verdict: Verdict) -> dict[str, float]:
    """Share of the mismatch by location: of all effects found, and of what is left unexplained at a known place."""
    shares: dict[str, float] = {}
    for effect in verdict.effects:
        shares[effect.location] = shares.get(effect.location, 0.0) + min(max(effect.share, 0.0), 1.0)
    left = verdict.unexplained
    told = any(effect.effect == "unknown" and effect.location == left.location for effect in verdict.effects)
    if left.present and left.location and not told and verdict.residual_before_mm > 0:
        share = (left.rms_mm / verdict.residual_before_mm) ** 2
        shares[left.location] = shares.get(left.location, 0.0) + min(share, 1.0)
    return {location: min(share, 1.0) for location, share in shares.items()}


def waterfall_steps(verdict: Verdict) -> list[WaterfallStep]:
    """The verdict's steps in plain words, without a last one for tolerances that nobody asked for."""
    steps = list(verdict.waterfall)
    if len(steps) > 1 and not verdict.background.present and steps[-1].label.startswith("tolerances"):
        steps.pop()
    return [
        replace(step, label=f"+ {plain(step.label)}" if number else "base and tool placed, no effect")
        for number, step in enumerate(steps)
    ]


def gathered(steps: Sequence[WaterfallStep]) -> list[WaterfallStep]:
    """The steps with minor effects that follow one another taken as one: together they are hardly to be seen."""
    together: list[WaterfallStep] = []
    for minor, group in itertools.groupby(steps, lambda step: step.minor):
        members = list(group)
        if minor and len(members) > 1:
            members = [replace(members[-1], label=f"+ {len(members)} minor effects")]
        together += members
    return together


def worth_drawing(effect: FoundEffect) -> bool:
    """Whether an effect's curve says more than its one number does."""
    return effect.curve is not None and (effect.effect == "unknown" or len(effect.parameters) > 1)


def atlas_tables(
    atlas: Atlas, effects: Sequence[FoundEffect]
) -> tuple[pd.DataFrame, pd.DataFrame, list[tuple[str, str]]]:
    """Location x driver tables of the best direction's share, on top of the frames and of the model; named cells."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # all directions NaN: there is no such effect
        tables = [
            pd.DataFrame(np.nanmax(values, axis=1), index=atlas.locations, columns=atlas.drivers)
            for values in (atlas.share, atlas.left)
        ]
    there = tables[0].notna()
    rows, columns = there.index[there.any(axis=1)], there.columns[there.any(axis=0)]
    shares, left = (table.reindex(index=rows, columns=columns) for table in tables)
    marked = [(effect.location, column) for effect in effects if (column := atlas_column(effect))]
    return shares, left, marked


def curve_of(effect: FoundEffect, found: FoundCurve) -> Curve:
    """An effect's curve in the units of a figure: degrees for angles, µrad or mm for what it does."""
    x, x_unit = (np.degrees(found.at), "deg") if found.driver_unit == "rad" else (found.at, found.driver_unit)
    size = float(np.max(np.abs(found.value), initial=0.0))
    factor, unit = shown_unit(found.value_unit, size)
    value, band = factor * found.value, INTERVAL * factor * found.stderr
    does = "moves by" if found.value_unit.startswith("m") else "turns by"
    return Curve(
        title=f"what {effect.location} does over the {found.driver}",
        x=x,
        value=value,
        low=value - band,
        high=value + band,
        x_label=f"{found.driver} ({x_unit})" if x_unit else found.driver,
        y_label=f"{effect.location} {does} ({unit})",
    )
