"""An empty cell is not zero: what the run says elsewhere stands there, and a note says so."""

import numpy as np
import pandas as pd

from armscope.recordings.blank_cells import payload_held, temperature_between
from armscope.recordings.motions import as_motions

RUN = np.repeat(["a", "b", "c"], 4)
NONE = np.nan


def test_a_payload_holds_until_the_next_one_of_its_run() -> None:
    payload = np.array([25.0, NONE, NONE, 3.0, NONE, 2.0, NONE, NONE, NONE, NONE, NONE, NONE])
    held, notes = payload_held(payload, RUN)
    np.testing.assert_array_equal(held, [25, 25, 25, 3, 2, 2, 2, 2, NONE, NONE, NONE, NONE])
    assert "empty in 5 rows" in notes[0]
    assert "empty in run c: what the arm carries there is not known" in notes[1]


def test_what_is_whole_stays_and_needs_no_word() -> None:
    payload = np.arange(12.0)
    held, notes = payload_held(payload, RUN)
    np.testing.assert_array_equal(held, payload)
    assert not notes


def test_a_temperature_goes_on_between_rows_of_its_run_alone() -> None:
    temperature = np.array([20.0, NONE, NONE, 23.0, NONE, 30.0, NONE, NONE, NONE, NONE, NONE, NONE])[:, None]
    found, notes = temperature_between(temperature, np.tile(np.arange(4.0), 3), RUN)
    np.testing.assert_allclose(found[:, 0], [20, 21, 22, 23, 30, 30, 30, 30, NONE, NONE, NONE, NONE])
    assert "in 5 rows" in notes[0]
    assert "run c" in notes[1]


def test_a_motions_first_row_may_state_its_payload() -> None:
    """The other 2 rows counted as 0 kg."""
    table = pd.DataFrame({"time_s": [0, 0.01, 0.02], "q1_rad": 0.1, "tau1_nm": 1.0, "payload_kg": [25.0, NONE, NONE]})
    motions = as_motions(table, "motions.csv", 1)
    np.testing.assert_array_equal(motions.payload, [25.0, 25.0, 25.0])
    assert motions.notes[0].startswith("payload_kg is empty in 2 rows")
