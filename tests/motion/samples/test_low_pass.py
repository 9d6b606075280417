"""What a low-pass leaves is in time; and of a run that is thinned, nothing that is faster comes back as slow."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from armscope.motion.samples.low_pass import mean_about, without_lag, without_what_is_faster
from armscope.motion.samples.timing import stretches
from armscope.recordings.motions import as_motions

RATE, TONE, SLOW = 1000.0, 95.0, 2.0
TIME = np.arange(8000) / RATE


def test_a_slow_wave_passes_in_time_and_a_fast_one_does_not() -> None:
    slow, fast = (np.sin(2 * np.pi * hz * TIME) for hz in (SLOW, TONE))
    left = without_lag(slow + fast, 20.0, RATE, 100)
    np.testing.assert_allclose(left[1000:-1000], slow[1000:-1000], atol=0.01)


def test_a_mean_over_a_sample_holds_where_a_step_was_in_it() -> None:
    step = (TIME > 4.0025).astype(float)[:, None]
    grid = np.arange(0, 8, 0.01)
    found = mean_about(grid, 0.01, TIME, step)[:, 0]
    np.testing.assert_allclose(found[[398, 399, 400, 401]], [0, 0, 0.25, 1], atol=0.06)


def test_what_was_not_recorded_stays_so() -> None:
    values = np.column_stack([np.sin(2 * np.pi * TONE * TIME), np.full(len(TIME), np.nan)])
    found = without_what_is_faster(values, TIME, 1 / RATE, 0.01)
    assert np.isnan(found[:, 1]).all()
    assert np.abs(found[1000:-1000, 0]).max() < 0.01


@pytest.mark.parametrize("joint", ["q1_rad", "tau1_nm"])
def test_a_run_that_is_sampled_faster_than_the_others_has_no_slow_wave_of_a_fast_one(joint: str) -> None:
    """95 Hz in two of five runs came back as 5 Hz, as large, at 100 samples a second."""
    frames = []
    for number, rate in enumerate((1000, 1000, 100, 100, 100)):
        time = np.arange(8 * rate) / rate
        frame = pd.DataFrame({"run": f"r{number}", "time_s": time, "q1_rad": np.sin(time), "tau1_nm": np.cos(time)})
        frame[joint] += np.sin(2 * np.pi * TONE * time) * (rate == 1000)
        frames.append(frame)
    for stretch in stretches(as_motions(pd.concat(frames, ignore_index=True), "motions.csv", 1)):
        assert stretch.rate == pytest.approx(100.0)
        slow = np.sin(stretch.time) if joint == "q1_rad" else np.cos(stretch.time)
        values = (stretch.q if joint == "q1_rad" else stretch.effort)[:, 0]
        np.testing.assert_allclose(values[50:-50], slow[50:-50], atol=0.02 if joint == "q1_rad" else 0.06)
