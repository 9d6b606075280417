"""Fits by swarm against least squares, random search and hand-made truths."""

import json

import numpy as np
import pytest

from armscope.errormodels.features import FDP_AI, FDP_CI, FOURIER_2_AI, PAPER_MODELS, SDP_AI, SDP_CI, fit_least_squares
from armscope.errormodels.fitted import SwarmFit
from armscope.errormodels.swarm_fit import FitProblem, fit_random_search, fit_swarms
from armscope.swarm.result import StopReason
from armscope.swarm.settings import SwarmSettings
from tests.errormodels.rows import identification, problem

POLYNOMIALS = [FDP_CI, FDP_AI, SDP_CI, SDP_AI]
SEEDS = range(20)
SHORT = SwarmSettings(particles=20, iterations=15)


def same_fit(first: SwarmFit, second: SwarmFit) -> bool:
    return json.dumps(first.to_dict(history=True)) == json.dumps(second.to_dict(history=True))


@pytest.mark.parametrize("basis", ["standardised", "qr"])
def test_constriction_reaches_least_squares_within_one_percent_for_all_four_polynomials(basis):
    for fitted in fit_swarms([problem(spec) for spec in POLYNOMIALS], SEEDS, basis=basis):
        assert fitted.excess_percent.max() < 1, fitted.name


def test_on_the_qr_basis_the_25_term_models_get_there_too():
    for fitted in fit_swarms([problem(spec) for spec in PAPER_MODELS[4:]], SEEDS):
        assert fitted.excess_percent.max() < 1, fitted.name


def test_the_formula_as_printed_stays_far_above_least_squares_and_behind_random_search():
    problems = [problem(SDP_AI), problem(FOURIER_2_AI)]
    printed = fit_swarms(problems, SEEDS, SwarmSettings(update="original"))
    random = fit_random_search(problems, range(5))
    for swarm, baseline in zip(printed, random, strict=True):
        assert np.median(swarm.excess_percent) > 60
        assert np.median(swarm.excess_mm) > np.median(baseline.excess_mm)


def test_no_swarm_beats_least_squares():
    for fitted in fit_swarms([problem(spec) for spec in PAPER_MODELS], range(5)):
        assert (fitted.excess_percent > -1e-9).all()


@pytest.mark.parametrize("basis", ["raw", "standardised", "qr"])
def test_the_fitness_is_the_rms_of_what_the_prediction_leaves(basis):
    angles, _, errors = identification()
    (fitted,) = fit_swarms([problem(SDP_AI)], [1, 2], SHORT, basis)
    for row, seed in enumerate(fitted.seeds):
        residuals = errors - fitted.predict(angles, seed)
        assert np.allclose(np.sqrt(np.mean(residuals**2, axis=0)), fitted.fitness_mm[row], rtol=1e-9)
        assert np.array_equal(fitted.predict_all(angles)[row], fitted.predict(angles, seed))


def test_without_a_seed_each_axis_predicts_with_its_best():
    angles, *_ = identification()
    (fitted,) = fit_swarms([problem(SDP_AI)], [1, 2, 3, 4], SHORT)
    best = fitted.fitness_mm.argmin(axis=0)
    assert len(set(best)) > 1, "this test needs axes with different best seeds"
    assert np.array_equal(fitted.predict(angles), fitted.predict_all(angles)[best, :, np.arange(3)].T)


def test_least_squares_agrees_with_the_normal_equations():
    angles, _, errors = identification()
    features = SDP_AI.features(angles)
    columns = features.matrix(angles)
    coefficients, rms = fit_least_squares(features, angles, errors)
    assert np.allclose(columns.T @ (errors - columns @ coefficients.T), 0, atol=1e-9)
    assert np.allclose(rms, np.sqrt(np.mean((errors - columns @ coefficients.T) ** 2, axis=0)), rtol=1e-12)


def test_planted_coefficients_come_back_in_raw_units():
    _, positions, _ = identification()
    planted = np.array(
        [[0.7312, -0.0013, 0.00089, -0.00151], [-0.4195, -0.0013, -0.00126, 0.00171], [3.0, 0.0, 0.0, 0.0]]
    )
    errors = FDP_CI.features(positions).matrix(positions) @ planted.T
    for basis in ("raw", "standardised", "qr"):
        (fitted,) = fit_swarms([FitProblem(FDP_CI, positions, errors)], [5], basis=basis)
        assert np.allclose(fitted.least_squares, planted, atol=1e-10)
        assert np.allclose(fitted.coefficients[0], planted, atol=1e-5)


def test_a_fit_does_not_depend_on_what_else_is_in_the_batch():
    problems = [problem(spec) for spec in PAPER_MODELS]
    together = fit_swarms(problems, [3, 4], SHORT)
    backwards = fit_swarms(problems[::-1], [3, 4], SHORT)[::-1]
    for k, spec in enumerate(PAPER_MODELS):
        (alone,) = fit_swarms([problems[k]], [3, 4], SHORT)
        assert alone.name == spec.name
        assert same_fit(alone, together[k])
        assert same_fit(alone, backwards[k])
        (one_seed,) = fit_swarms([problems[k]], [4], SHORT)
        assert np.array_equal(one_seed.coefficients[0], alone.coefficients[1])


def test_seeds_axes_labels_and_models_have_streams_of_their_own():
    angles, _, errors = identification()
    same_axes = np.repeat(errors[:, :1], 3, axis=1)
    here, there = (FitProblem(FDP_AI, angles, same_axes, label) for label in ("here", "there"))
    fits = fit_swarms([here, there], [1, 2], SHORT)
    values = np.concatenate([fit.fitness_mm.ravel() for fit in fits])
    assert len(set(values)) == 12


def test_both_engines_give_the_same_fit():
    problems = [problem(spec) for spec in PAPER_MODELS]
    for basis in ("raw", "qr"):
        compiled, reference = (fit_swarms(problems, [1], SHORT, basis, engine) for engine in ("numba", "numpy"))
        for ours, theirs in zip(compiled, reference, strict=True):
            assert np.allclose(ours.history_mm, theirs.history_mm, rtol=1e-9)


def test_a_threshold_in_millimetres_stops_the_swarm_and_the_reason_is_kept():
    (fitted,) = fit_swarms([problem(FDP_AI)], [1, 2], SwarmSettings(threshold=1e3))
    assert (fitted.reasons == StopReason.THRESHOLD).all()
    assert (fitted.iterations == 0).all()


def test_a_single_column_of_errors_is_one_axis():
    angles, _, errors = identification()
    (fitted,) = fit_swarms([FitProblem(FDP_AI, angles, errors[:, 1])], [1], SHORT)
    assert fitted.axes == ("error",)
    assert fitted.predict(angles).shape == (85, 1)


def test_errors_of_zero_are_predicted_as_zero():
    angles, _, errors = identification()
    (fitted,) = fit_swarms([FitProblem(SDP_AI, angles, 0 * errors)], [1], SHORT)
    assert (fitted.predict(angles) == 0).all()
    assert (fitted.excess_percent == 0).all()


def test_still_joints_and_dropped_terms_are_named_in_the_result():
    angles, _, errors = identification(still_wrist=True)
    angles[:, 5] = np.where(angles[:, 5] > 0, 0.5, -0.25)
    (fitted,) = fit_swarms([FitProblem(SDP_AI, angles, errors)], [1], SHORT)
    assert fitted.features.moving == (True, True, True, False, False, True)
    assert fitted.dropped == ("theta6^2",)
    dropped = fitted.features.term_names.index("theta6^2")
    assert (fitted.coefficients[..., dropped] == 0).all()
    assert (fitted.least_squares[..., dropped] == 0).all()


@pytest.mark.parametrize("history", [True, False])
def test_a_fitted_model_survives_the_way_through_json(history):
    (fitted,) = fit_swarms([problem(SDP_CI)], [1, 2], SHORT)
    again = SwarmFit.from_dict(json.loads(json.dumps(fitted.to_dict(history))))
    assert same_fit(again, fitted) or not history
    _, positions, _ = identification()
    assert np.array_equal(again.predict(positions), fitted.predict(positions))
    assert (again.reasons == fitted.reasons).all()
    assert again.history_mm.shape == (2, 3, 16 if history else 0)


@pytest.mark.parametrize(("seeds", "rule"), [([], "at least one"), ([1, 1], "different"), ([-1], "0 or more")])
def test_seeds_that_can_not_be_used_are_refused(seeds, rule):
    with pytest.raises(ValueError, match=rule):
        fit_swarms([problem(FDP_AI)], seeds, SHORT)


def test_errors_that_do_not_fit_the_rows_are_refused():
    angles, _, errors = identification()
    for wrong in (errors[:-1], errors[:, :2], errors[:, :, None]):
        with pytest.raises(ValueError, match="rows x 3, or rows"):
            fit_swarms([FitProblem(FDP_AI, angles, wrong)], [1], SHORT)
    errors[7, 1] = np.nan
    with pytest.raises(ValueError, match="row 7"):
        fit_swarms([FitProblem(FDP_AI, angles, errors)], [1], SHORT)


def test_an_unknown_seed_is_not_predicted_with():
    (fitted,) = fit_swarms([problem(FDP_AI)], [1, 2], SHORT)
    with pytest.raises(ValueError, match="fitted with 1, 2"):
        fitted.predict(identification()[0], seed=3)


def test_nothing_to_fit_is_nothing():
    assert fit_swarms([], [1]) == []
