"""A path's low-pass goes on beyond its ends as the path does: predictions hold in the first and last rows, too."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.motion.samples.ends import going_on
from armscope.motion.samples.low_pass import without_lag
from armscope.motion.samples.preparation import parts, preparation
from armscope.motion.samples.timing import stretches
from armscope.recordings.motions import as_motions
from tests.motion.moving import path, robot, table
from tests.seeds import seeds


def test_a_polynomial_goes_on_as_it_is() -> None:
    t = np.linspace(-1, 1, 201)
    values = np.column_stack([1 + t - 2 * t**2 + t**3 - 0.5 * t**4, t])
    whole, more = going_on(values, 5.0, 100.0)
    far = np.linspace(-1 - 0.01 * more, 1 + 0.01 * more, len(whole))
    np.testing.assert_allclose(whole[:, 0], 1 + far - 2 * far**2 + far**3 - 0.5 * far**4, atol=1e-9)
    np.testing.assert_allclose(whole[:, 1], far, atol=1e-9)


@pytest.mark.parametrize("samples", [2, 3, 7, 20])
def test_few_samples_go_on_too(samples: int) -> None:
    values = np.linspace(0.0, 1.0, samples)[:, None]
    whole, more = going_on(values, 5.0, 100.0)
    np.testing.assert_allclose(np.diff(whole[:, 0]), 1 / (samples - 1), atol=1e-9)
    assert len(without_lag(values, 5.0, 100.0, 15, going=True)) == samples
    np.testing.assert_array_equal(whole[more:-more], values)


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_accelerations_at_the_ends_are_those_of_the_motion(seed: int) -> None:
    """Where it was turned about its end point, a third of them was missing in the last tenth of a second."""
    arm, how = robot(), preparation(200.0, 10.0, "a test", 6.0)
    motions = as_motions(table(arm, seed, runs=1, seconds=6.0), "motions.csv", 3)
    (signals,) = parts(list(stretches(motions)), how, every_sample=True)
    _, _, _, true = path(np.random.default_rng(seed), 3, 6.0, 200.0)
    ends = np.r_[:20, len(true) - 20 : len(true)]
    missed = np.sqrt(np.mean((signals.ddq - true)[ends] ** 2) / np.mean(true**2))
    assert missed < 0.06
