"""What a command says on standard error, a notebook says as a warning."""

from pathlib import Path

import pandas as pd
import pytest

import armscope
from armscope.notebook.notes import PredictionWarning, with_notes
from armscope.notebook.result import Diagnosed

EXAMPLE = Path(__file__).parents[2] / "examples" / "one-effect"


def test_what_has_no_notes_is_handed_on_in_silence(recwarn: pytest.WarningsRecorder) -> None:
    assert with_notes((3, [])) == 3
    assert not recwarn
    with pytest.warns(PredictionWarning, match="left out"):
        assert with_notes((3, ["something is left out"])) == 3


def test_a_run_that_the_model_does_not_know_is_said() -> None:
    recordings = pd.read_csv(EXAMPLE / "recordings.csv").assign(run="monday")
    found = armscope.diagnose(recordings, EXAMPLE / "robot.yaml", resamples=0, cross_validation=False)
    assert isinstance(found, Diagnosed)
    for predict in (found.predict, lambda rows: armscope.predict(found, rows)):
        with pytest.warns(PredictionWarning, match="'tuesday' is not in the model"):
            predict(recordings.assign(run="tuesday"))
