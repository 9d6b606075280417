"""Extended models: one region is the plain fit, a planted product is found and predicted elsewhere."""

import numpy as np

from armscope.errormodels.features import FDP_CI, ModelSpec, fit_least_squares
from armscope.errormodels.fitted import with_products, with_regions

RNG = np.random.default_rng(3)
POINTS, ELSEWHERE = RNG.uniform(-1000, 1000, (85, 3)), RNG.uniform(-1000, 1000, (40, 3))


def test_one_region_is_the_least_squares_fit():
    errors = RNG.normal(size=(85, 3))
    features = FDP_CI.features(POINTS)
    coefficients, _ = fit_least_squares(features, POINTS, errors)
    model = with_regions(FDP_CI, POINTS, errors, 1)
    assert model.name == "FDP(CI)"
    assert np.allclose(model.predict(ELSEWHERE), features.matrix(ELSEWHERE) @ coefficients.T, atol=1e-9)


def test_two_regions_follow_a_kink_that_one_model_cannot():
    errors = np.abs(POINTS[:, :1]) * [1e-3, 0.0, 0.0]
    one, two = (with_regions(FDP_CI, POINTS, errors, count) for count in (1, 2))
    assert two.name == "FDP(CI), 2 regions"
    left = [np.sqrt(np.mean((errors - model.predict(POINTS)) ** 2)) for model in (one, two)]
    assert left[1] < left[0]


def test_a_planted_product_is_found_and_predicted_elsewhere():
    def planted(points):
        return (points[:, :1] * points[:, 1:2]) * [1e-6, -2e-6, 0.0]

    model, compared = with_products(ModelSpec("polynomial", 2, "cartesian"), POINTS, planted(POINTS), RNG)
    assert "T1(px) T1(py)" in model.features.term_names
    assert np.abs(model.predict(ELSEWHERE) - planted(ELSEWHERE)).max() < 1e-9
    assert compared["chosen"].sum() == 1
