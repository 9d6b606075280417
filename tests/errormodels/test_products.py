"""Products between inputs: the true ones are found among many, and none where there is nothing to find."""

import numpy as np
import pytest

from armscope.errormodels.features import FOURIER_2_AI, SDP_AI, ModelSpec, fit_least_squares
from armscope.errormodels.products import ProductFeatures, candidate_terms, fit_products

CUBIC_CI = ModelSpec("polynomial", 3, "cartesian")


def angles(count=120, seed=0):
    rows = np.random.default_rng(seed).uniform(-1.2, 1.2, (count, 6))
    rows[:, 3:5] = 0.0
    return rows


def planted(rows, noise=0.02, seed=5):
    a, b, c = rows[:, 0], rows[:, 1], rows[:, 2]
    law = np.column_stack([2 * np.sin(a) * np.cos(b), 1.5 * np.cos(a) * np.cos(b), np.sin(c) + 0.7])
    return law + np.random.default_rng(seed).normal(0, noise, law.shape)


def test_planted_products_are_found_and_little_else():
    features, coefficients, compared = fit_products(FOURIER_2_AI, angles(), planted(angles()), np.random.default_rng(1))
    true = {"const", "sin(theta1) cos(theta2)", "cos(theta1) cos(theta2)", "sin(theta3)"}
    assert true <= set(features.term_names)
    assert len(features.term_names) <= 8
    fresh = angles(500, 9)
    left = features.matrix(fresh) @ coefficients.T - planted(fresh, 0.0)
    assert np.sqrt(np.mean(left**2)) < 0.02
    row = compared[compared["chosen"]].iloc[0]
    assert row["held_out_rms_mm"] == pytest.approx(0.02 * np.sqrt(3), rel=0.25)


def test_sums_of_one_input_terms_cannot_follow_products():
    rows, fresh = angles(), angles(500, 9)
    sums = FOURIER_2_AI.features(rows)
    coefficients, _ = fit_least_squares(sums, rows, planted(rows))
    left = sums.matrix(fresh) @ coefficients.T - planted(fresh, 0.0)
    assert np.sqrt(np.mean(left**2)) > 5 * 0.02  # five times the noise, which products reach


def test_pure_noise_gets_a_constant_or_hardly_more():
    noise = np.random.default_rng(4).normal(size=(120, 3))
    features, _, _ = fit_products(FOURIER_2_AI, angles(), noise, np.random.default_rng(1))
    assert len(features.terms) <= 2


@pytest.mark.parametrize("spec", [FOURIER_2_AI, SDP_AI, CUBIC_CI, ModelSpec("fourier", 2, "cartesian")])
def test_slopes_are_the_products_derivatives(spec):
    rows = angles(40) if spec.space == "angular" else np.random.default_rng(2).uniform(500, 1500, (40, 3))
    spread = np.ptp(rows, axis=0) / 2
    features = ProductFeatures(spec, rows.mean(axis=0), spread, candidate_terms(spec, spread))
    again = ProductFeatures.from_dict(features.to_dict())
    step = 1e-5 * spread.max()
    for k in range(rows.shape[1]):
        shift = step * np.eye(rows.shape[1])[k]
        slope = (features.matrix(rows + shift) - features.matrix(rows - shift)) / (2 * step)
        np.testing.assert_allclose(again.slopes(rows)[:, :, k], slope, atol=1e-7 * max(1, np.abs(slope).max()))


def test_candidates_are_counted_as_by_hand():
    # three inputs, total degree 2: constant, 3 linear, 3 squares, 3 mixed
    assert len(candidate_terms(ModelSpec("polynomial", 2, "cartesian"), np.ones(3))) == 10
    # two inputs that move, harmonics up to 2: constant, 2 x (2 + 2), 2 x 2 mixed
    moving = np.array([1.0, 1.0, 0.0])
    assert len(candidate_terms(ModelSpec("fourier", 2, "angular"), moving)) == 13
