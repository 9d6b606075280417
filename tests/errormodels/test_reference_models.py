"""The paper's models on the same rows, as the report compares them."""

import numpy as np
import pytest

from armscope.errormodels.reference_models import held_out_rms
from armscope.robot import forward_kinematics
from tests.report import verdicts


def test_the_papers_linear_model_finds_a_linear_error_and_nothing_in_noise():
    case = verdicts.case(rows=300)
    random = np.random.default_rng(0)
    noise = random.normal(0, 0.03, (300, 3))
    points = 1e3 * forward_kinematics(case.arm, case.recordings.motor_angles)
    linear = 1e-3 * points @ random.normal(size=(3, 3)) + noise
    found_rms = dict(held_out_rms(case.arm, case.recordings, linear))
    assert found_rms["FDP(CI)"] == pytest.approx(0.03, rel=0.1)
    assert found_rms["FDP(AI)"] > 3 * found_rms["FDP(CI)"]
    on_noise = dict(held_out_rms(case.arm, case.recordings, noise))
    assert on_noise["Fourier 2 (AI)"] > np.sqrt(np.mean(noise**2)), "held-out rows punish what only memorises"


def test_a_model_with_more_terms_than_rows_is_not_compared():
    case = verdicts.case(rows=20)
    names = [name for name, _ in held_out_rms(case.arm, case.recordings, np.zeros((20, 3)))]
    assert "FDP(CI)" in names
    assert "Fourier 2 (AI)" not in names
