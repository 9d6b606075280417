"""A verdict without one: it says why, and what the nominal arm leaves."""

import numpy as np
import pytest

from armscope.diagnosis.undecided import undecided
from armscope.fitting.registration import fit_frames
from armscope.measurement.noise import Noise
from armscope.verdict.schema import Notice

from .planted import planted


def test_it_names_nothing_and_says_why():
    arm, table = planted("six-axis", {}, 30, 0.03, seed=6)
    left = np.full((30, 3), 0.2)
    verdict = undecided(
        fit_frames(arm, table), table, left, Noise(0.0, 0.0, "stated"), (Notice("rows", "Too few."),), 1.0
    )
    assert (verdict.answer, verdict.effects, verdict.mismatch) == ("cannot tell", (), None)
    assert verdict.residual_before_mm == verdict.residual_after_mm == pytest.approx(0.2)
    assert verdict.headline.startswith("Cannot tell: ")
    assert np.isnan(verdict.noise_mm)  # none was stated, and none was found
