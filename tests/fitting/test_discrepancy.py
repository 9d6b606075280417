"""Standard errors own up to errors that no effect explains - and stay as they are where there is only noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import multivariate_normal

from armscope.diagnosis import Settings, diagnose
from armscope.fitting import discrepancy as uncertainty
from armscope.fitting.constants import DISCREPANCY
from armscope.fitting.discrepancy import model_error
from armscope.fitting.linearisation import point_residuals
from armscope.fitting.refit import Refit, refit
from armscope.fitting.registration import fit_frames
from armscope.measurement.row_weights import RowNoise
from armscope.physics.frames import free_frames
from armscope.physics.model import predict
from armscope.physics.registry import library
from armscope.recordings import Recordings
from armscope.robot import Arm

from ..diagnosis.planted import planted

NOISE_MM = 0.02
COUPLING = ("joint_coupling", "joint 5 from joint 4")
DRIFT = ("base_drift", "base")
WANTED = {COUPLING: [1e-3], DRIFT: [2e-4, 0.0, -1e-4, 0.0, 2e-4, 0.0]}


def fitted(arm: Arm, table: Recordings) -> Refit:
    """Both effects fitted with the exact model, every row as good as any other."""
    start = fit_frames(arm, table)
    effects = [(next(p for p in library(arm, table) if p.key == key), 0.1) for key in WANTED]
    same = RowNoise(np.ones(len(table)), np.ones(len(table)))
    return refit(start, table, free_frames(table, False), [], effects, same, 0.0)


def stderr(fit: Refit, covariance: np.ndarray) -> np.ndarray:
    """Of the values of both effects."""
    at = np.concatenate([fit.layout.of(part.placed) for part in fit.model.parts])
    return np.asarray(np.sqrt(np.diag(covariance)[at]))


def values(fit: Refit) -> np.ndarray:
    return np.concatenate([part.values for part in fit.model.parts])


def wandering(table: Recordings, step_mm: float, rng: np.random.Generator) -> Recordings:
    """The same rows while the base walks at random, about its mean."""
    walk = np.cumsum(step_mm * 1e-3 * rng.normal(size=(len(table), 3)), axis=0)
    return replace(table, positions=table.positions + walk - walk.mean(axis=0))


def turning(arm: Arm, table: Recordings, size: float, rng: np.random.Generator) -> Recordings:
    """The same rows while every motor errs by a wave across three motor angles."""
    model = fit_frames(arm, table)
    waves = rng.uniform(0.5, 1.2, (arm.n_motors, arm.n_motors)) * rng.choice([-1, 0, 1], (arm.n_motors, arm.n_motors))
    turns = size * np.sin(table.motor_angles @ waves.T + rng.uniform(0, 2 * np.pi, arm.n_motors))
    moved = predict(model, replace(table, motor_angles=table.motor_angles + turns)) - predict(model, table)
    return replace(table, positions=table.positions + moved)


@pytest.mark.long
def test_where_there_is_only_noise_the_covariance_is_the_fits_own() -> None:
    wider = []
    for seed in range(6):
        arm, table = planted(("six-axis", "seven-axis")[seed % 2], WANTED, 200, NOISE_MM, seed=300 + 10 * seed)
        fit = fitted(arm, table)
        found = model_error(fit, table, 0.0)
        assert found.notices() == []
        wider.append(stderr(fit, found.covariance) / stderr(fit, fit.covariance))
    assert np.median(wider) < 1.06
    assert np.max(wider) < 1.5  # a drift is what a small wander, which nobody can rule out, looks like


@pytest.mark.long
@pytest.mark.parametrize(
    "kind",
    # where nothing errs, the covariance is the fit's own: see above
    ["wander", *(pytest.param(kind, marks=pytest.mark.long) for kind in ("nothing", "turn"))],
)
def test_values_fitted_again_and_again_scatter_as_their_standard_errors_say(kind: str) -> None:
    """Brute force: the exact fit repeated on readings that err anew each time, the arm and its poses the same."""
    arm, table = planted("six-axis", WANTED, 150, 0.0, seed=41)
    rng = np.random.default_rng(7)
    shifts, stated, naive = [], [], []
    for _ in range(25):
        wrong = replace(table, positions=table.positions + 1e-3 * NOISE_MM * rng.normal(size=table.positions.shape))
        if kind != "nothing":
            wrong = wandering(wrong, 0.01, rng) if kind == "wander" else turning(arm, wrong, 1e-4, rng)
        fit = fitted(arm, wrong)
        shifts.append(values(fit) - np.concatenate(list(WANTED.values())))
        stated.append(stderr(fit, model_error(fit, wrong, 0.0).covariance))
        naive.append(stderr(fit, fit.covariance))
    scatter = np.sqrt(np.mean(np.square(shifts), axis=0))
    ratio, before = (np.sqrt(np.mean(np.square(each), axis=0)) / scatter for each in (stated, naive))
    # a wander misleads the drift's translation, joints that err mislead the coupling
    misled = {"nothing": slice(0), "wander": slice(1, 4), "turn": slice(0, 1)}[kind]
    assert np.all(before[misled] < 0.5)
    assert np.all(ratio > 0.7)
    assert np.all(ratio < (1.5 if kind == "nothing" else 2.2))


def test_evidence_is_that_of_the_dense_normal_distribution() -> None:
    rng = np.random.default_rng(3)
    Z, y = rng.normal(size=(40, 6)) / 5, 0.8 * rng.normal(size=40)
    # a noise that can't become less stays where it is
    found = uncertainty._weigh(Z.T @ Z, Z.T @ y, float(y @ y), 40.0, 1.0, 0.2)
    sizes = np.array(DISCREPANCY.sizes)
    dense = np.array([multivariate_normal(np.zeros(40), np.eye(40) + s**2 * Z @ Z.T).logpdf(y) for s in (0.0, *sizes)])
    likely = np.exp(dense - dense[0]) * np.array([1.0, *[0.2 / len(sizes)] * len(sizes)])
    assert found.evidence == pytest.approx(np.log(likely[1:].sum()), abs=1e-9)
    assert found.variance == pytest.approx(float(likely[1:] @ sizes**2 / likely.sum()), rel=1e-9)


def test_an_error_moves_values_as_the_exact_fit_moves() -> None:
    """The linear step of values under an error, against fitting the readings with and without it."""
    arm, table = planted("six-axis", WANTED, 150, NOISE_MM, seed=43)
    fit = fitted(arm, table)
    slow = uncertainty._slow(table, np.arange(len(table)))[:, 2:3] * np.array([[0.0, 1e-5, 0.0]])  # 10 um along y
    base = next(iter(fit.model.bases.values()))
    moved = fitted(arm, replace(table, positions=table.positions + slow @ base.rotation.T))
    sums = uncertainty._sums(fit, table, np.arange(len(table)))
    # of 3 x k columns, the third of those along y
    count = sums.of["the base moves in the order of rows"].stop // 3
    column = sums.cross[:, count + 2]
    step = np.linalg.solve(sums.normal + np.diag(fit.noise**2 * fit.precision), column)
    at = np.concatenate([fit.layout.of(part.placed) for part in fit.model.parts])
    shift = values(moved) - values(fit)
    along = step[at] * (shift @ step[at]) / (step[at] @ step[at])
    assert np.linalg.norm((shift - along) / stderr(fit, fit.covariance)) < 0.05 * np.linalg.norm(
        shift / stderr(fit, fit.covariance)
    )


@given(st.integers(0, 10_000), st.floats(0.01, 3.0))
def test_no_standard_error_falls_below_the_fits_own(seed: int, white: float) -> None:
    rng = np.random.default_rng(seed)
    root, extra = rng.normal(size=(2, 5, 5))
    own = root @ root.T + 1e-6 * np.eye(5)
    told = uncertainty._not_below(own, white * own + extra @ extra.T)
    assert np.all(np.diag(told) >= np.diag(own) * (1 - 1e-12))
    assert np.linalg.eigvalsh(told).min() > 0


def test_a_long_table_is_told_from_some_of_its_rows_as_from_all(monkeypatch: pytest.MonkeyPatch) -> None:
    arm, table = planted("six-axis", WANTED, 600, NOISE_MM, seed=45)
    table = wandering(table, 0.005, np.random.default_rng(1))
    fit = fitted(arm, table)
    whole = stderr(fit, model_error(fit, table, 0.0).covariance)
    monkeypatch.setattr(uncertainty, "DISCREPANCY", replace(DISCREPANCY, most_rows=300))
    some = stderr(fit, model_error(fit, table, 0.0).covariance)
    assert np.all(whole[1:4] > 5 * stderr(fit, fit.covariance)[1:4])
    assert np.all(np.abs(np.log(some / whole)) < 0.4)


@pytest.mark.long
def test_a_verdict_says_so_and_widens_its_intervals() -> None:
    arm, table = planted("six-axis", {COUPLING: [1e-3]}, 150, NOISE_MM, seed=47)
    quick = Settings(resamples=0, cross_validation=False)
    clean = diagnose(arm, table, quick)
    wrong = diagnose(arm, turning(arm, table, 5e-5, np.random.default_rng(2)), quick)
    errors = []
    for verdict in (clean, wrong):
        (found,) = [effect for effect in verdict.effects if (effect.effect, effect.location) == COUPLING]
        errors.append(found.parameters[0].stderr)
    assert errors[1] > 1.5 * errors[0]
    assert [notice.kind for notice in clean.notices].count("model error") == 0
    (told,) = [notice.text for notice in wrong.notices if notice.kind == "model error"]
    assert "from pose to pose" in told
    assert "in the order of rows" not in told


def test_a_noise_that_is_known_is_no_model_error() -> None:
    """Residuals below the stated noise show nothing, whatever they look like."""
    arm, table = planted("six-axis", WANTED, 120, NOISE_MM, seed=49)
    table = wandering(table, 0.005, np.random.default_rng(3))
    fit = fitted(arm, table)
    assert point_residuals(fit.model, table).std() < 0.1
    found = model_error(replace(fit, covariance=fit.covariance * (0.1 / fit.noise) ** 2), table, 0.1)
    assert np.allclose(found.covariance, fit.covariance * (0.1 / fit.noise) ** 2, rtol=0.05)
