"""Gears have finer waves in the last fit than in the search: other rows are predicted better, and names stay."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import unheard
from armscope.diagnosis import diagnose
from armscope.diagnosis.selection_loop import SelectionLoop
from armscope.fitting.registration import fit_frames
from armscope.measurement.noise import Noise
from armscope.physics.backgrounds import FAMILIES, TRANSMISSION, gear_waves
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import Part
from armscope.physics.frames import free_frames
from armscope.physics.model import Base, FittedModel, predict
from armscope.recordings import Recordings
from armscope.robot import Arm

from ..physics.scenes import arm_named
from .numpy_arms import QUICK
from .planted import one_run

ROWS, OTHERS, NOISE = 300, 200, 0.005


def rough_gears(rng: np.random.Generator) -> tuple[Arm, Recordings, FittedModel]:
    """An arm whose gears all have sixty waves that fall with their number, and poses of it."""
    arm = arm_named("six-axis")
    table = one_run(arm, ROWS + OTHERS, 5)
    waves = [
        Part(wave, 2e-4 * np.array(wave.prior_scale) / PLAUSIBLE.eccentricity_rad * rng.normal(size=2))
        for wave in gear_waves(table, 60)
    ]
    base = Base(np.eye(3), np.zeros(3))
    return arm, table, FittedModel(arm, {"1": base}, (), tuple(waves))


def test_gears_of_a_short_table_are_told_as_gears_and_not_as_curves_of_nobody_knows_what():
    rng = np.random.default_rng(1)
    arm = arm_named("six-axis")
    table = one_run(arm, 200, 1)
    gears = []
    for joint in (1, 2, 3):
        waves = [wave for wave in gear_waves(table, 60) if wave.location == f"joint {joint}"]
        values = rng.normal(size=(60, 2)) / np.arange(1, 61)[:, None]
        values *= 5e-5 / np.sqrt(np.sum(values**2) / 2)
        gears += [Part(wave, value) for wave, value in zip(waves, values, strict=True)]
    points = predict(FittedModel(arm, {"1": Base(np.eye(3), np.zeros(3))}, (), tuple(gears)), table)
    measured = replace(table, positions=points + 2e-5 * rng.normal(size=points.shape))
    told = diagnose(arm, measured, QUICK)
    assert [effect.effect for effect in told.effects] == []
    assert [cause.family for cause in told.causes] == [TRANSMISSION]


@pytest.mark.long
def test_finer_waves_in_the_last_fit_predict_other_rows_better_and_change_no_name():
    rng = np.random.default_rng(11)
    arm, table, truth = rough_gears(rng)
    points = predict(truth, table)
    seen, other = np.arange(ROWS), np.arange(ROWS, ROWS + OTHERS)
    measured = replace(table, positions=points + 1e-3 * NOISE * rng.normal(size=points.shape)).rows(seen)
    frames, blocks = free_frames(measured, False), np.arange(ROWS) % 20
    loop = SelectionLoop(fit_frames(arm, measured), measured, Noise(0.0, 0.0, "unknown"), frames, blocks, unheard)
    loop.families = [gear_waves(measured, PLAUSIBLE.fine_waves) if f == TRANSMISSION else [] for f in FAMILIES]
    loop.round([tuple(4 if f == TRANSMISSION else 0 for f in FAMILIES)])
    chosen = loop.best.candidates
    coarser, finer = loop.earned(), loop.earned(finer=True)
    waves = {part.placed.scanned[0][2] for part in finer.fit.model.background}
    assert max(waves) == PLAUSIBLE.finest_waves > PLAUSIBLE.fine_waves
    assert finer.best.candidates == coarser.best.candidates == chosen
    missed = [np.std(predict(fit.model, table.rows(other)) - points[other]) for fit in (coarser.fit, finer.fit)]
    assert missed[1] < 0.5 * missed[0]
