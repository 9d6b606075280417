"""The noise of a joint's torque, as the fit leaves it and as it was."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy.signal import lfilter

from armscope.core.types import Array
from armscope.motion.fitting.cutoff import chosen_cutoff
from armscope.motion.fitting.model_estimate import stated_model
from armscope.motion.fitting.rows import MotionRows, build_rows
from armscope.motion.fitting.selection import select_causes
from armscope.motion.fitting.weights import TorqueWeights, autocorrelation_time, noise_of
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.placing import place_causes
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.samples.preparation import preparation
from armscope.motion.samples.timing import stretches
from tests.motion.moving import carrying, moved, robot

ROWS, NUMBERS, BLOCKS = 240, 80, 5


def rows_of(count: int) -> MotionRows:
    """Some rows of an arm that moves; what they hold plays no part."""
    arm = robot()
    rows = build_rows(
        TorqueLayout(arm, (), False), list(stretches(moved(arm, 4, seconds=10.0))), preparation(200.0, 10.0, "test"),
        stated_model(arm),
    )  # fmt: skip
    names = ("time", "run", "stretch", "q", "dq", "torque", "nominal", "still")
    return dataclasses.replace(rows, **{name: getattr(rows, name)[:count] for name in names})


def left_of(noise: Array, X: Array) -> tuple[Array, Array]:
    """What a plain fit of columns leaves of noise (K, m), in all and of each fifth by numbers from the rest."""
    whole = noise - X @ np.linalg.lstsq(X, noise, rcond=None)[0]
    apart, block = np.empty_like(noise), np.arange(len(noise)) * BLOCKS // len(noise)
    for number in range(BLOCKS):
        held = block == number
        apart[held] = noise[held] - X[held] @ np.linalg.lstsq(X[~held], noise[~held], rcond=None)[0]
    return whole, apart


def test_what_an_earlier_model_explained_is_no_noise_once_its_name_is_gone() -> None:
    """Joint by joint; where noise grows by a little, or less is left though it lasts, the last model's counts."""
    row = np.ones((10, 5))
    calm = TorqueWeights(np.full(5, 0.2), np.full(5, 4.0), row)
    now = TorqueWeights(np.array([0.5, 0.25, 0.1, 0.21, 0.19]), np.array([4.0, 4.0, 4.0, 20.0, 20.0]), 0.5 * row)
    noise = now.not_far_above(calm)
    assert noise.sigma.tolist() == [0.2, 0.25, 0.1, 0.2, 0.19]
    assert noise.correlated.tolist() == [4.0, 4.0, 4.0, 4.0, 20.0]
    assert noise.row[0].tolist() == [1.0, 0.5, 0.5, 1.0, 0.5]
    assert now.not_far_above(None) is now


def test_noise_that_a_fit_of_many_numbers_took_up_counts_all_the_same() -> None:
    rng, found = np.random.default_rng(3), []
    rows = rows_of(ROWS)
    ones = np.ones((ROWS, rows.torque.shape[1]))
    for _ in range(20):
        noise = rng.normal(size=ones.shape)
        whole, apart = left_of(noise, rng.normal(size=(ROWS, NUMBERS)))
        parts = ((whole, None), (apart, apart), (whole, apart))
        found.append([noise_of(rows, left, ones, other).sigma.mean() for left, other in parts])
    fitted, elsewhere, both = np.mean(found, axis=0)
    assert fitted < 0.85  # a third of the rows went into numbers
    assert elsewhere > 1.15
    assert both == pytest.approx(1.0, abs=0.03)


def test_noise_that_lasts_still_lasts_where_columns_that_last_took_it_up() -> None:
    rng, found = np.random.default_rng(5), []
    one, kept = np.zeros(1000, dtype=np.intp), 0.95
    for _ in range(10):
        slow = lfilter([1.0], [1.0, -kept], rng.normal(size=(1000, 21)), axis=0)
        whole, apart = left_of(slow[:, :1], slow[:, 1:])
        pairs = ((whole[:, 0], None), (whole[:, 0], apart[:, 0]))
        found.append([autocorrelation_time(one, *pair) for pair in pairs])
    fitted, both = np.mean(found, axis=0)
    truth = (1 + kept) / (1 - kept)
    assert fitted < 0.55 * truth
    assert abs(both - truth) < 0.8 * abs(fitted - truth)


def test_noise_is_never_less_than_what_the_fit_leaves() -> None:
    """Where the other blocks say the opposite of a motion, what both leave has a product below zero."""
    rng = np.random.default_rng(7)
    rows = rows_of(ROWS)
    left = rng.normal(size=rows.torque.shape)
    found = noise_of(rows, left, np.ones_like(left), -3 * left)
    assert found.sigma == pytest.approx(np.sqrt(np.mean(left**2, axis=0)))
    assert found.correlated == pytest.approx(noise_of(rows, left, np.ones_like(left)).correlated)


def test_a_load_of_one_run_is_no_noise_of_that_run() -> None:
    arm, recorded = robot(), carrying(6, 4.0)
    train = list(stretches(recorded))
    how, first = chosen_cutoff(arm, train, 10.0)
    layout = TorqueLayout(arm, tuple(place_causes(seen_in(arm, train, 0.02))), False)
    selected = select_causes(layout, train, how, recorded.runs, lambda text, share: None, first.model)
    assert [selected.rows.layout.placed[number].runs for number in selected.best.candidates] == [recorded.runs[1:2]]
    moving = ~selected.rows.still
    left = [np.sqrt(np.mean(own[there] ** 2)) for own, there in zip(selected.residuals.T, moving.T, strict=True)]
    assert selected.noise.sigma == pytest.approx(left, rel=0.1)
