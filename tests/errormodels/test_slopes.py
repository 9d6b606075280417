"""The terms' derivatives against finite differences."""

import numpy as np
import pytest

from armscope.errormodels.features import PAPER_MODELS, ModelSpec

SPECS = [*PAPER_MODELS, ModelSpec("fourier", 2, "cartesian"), ModelSpec("polynomial", 3, "cartesian")]


@pytest.mark.parametrize("spec", SPECS, ids=lambda spec: spec.name)
def test_slopes_are_the_terms_derivatives(spec):
    rng = np.random.default_rng(4)
    size = 3 if spec.space == "cartesian" else 6
    inputs = rng.uniform(-1.2, 1.2, (20, size)) * (800.0 if size == 3 else 1.0)
    features = spec.features(inputs)
    step = 1e-5 * np.ptp(inputs)
    for k in range(size):
        shift = step * np.eye(size)[k]
        differences = (features.matrix(inputs + shift) - features.matrix(inputs - shift)) / (2 * step)
        slopes = features.slopes(inputs)[:, :, k]
        np.testing.assert_allclose(slopes, differences, rtol=1e-6, atol=1e-8 * np.abs(differences).max())


def test_inputs_that_stand_still_have_no_slope():
    inputs = np.random.default_rng(1).uniform(-1, 1, (30, 6))
    inputs[:, 3] = 0.25
    slopes = ModelSpec("polynomial", 2, "angular").features(inputs).slopes(inputs)
    assert not slopes[:, :, 3].any()
    assert slopes[:, :, 2].any()
