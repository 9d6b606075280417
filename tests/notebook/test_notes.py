"""What a command says on standard error, a notebook says as a warning."""

from pathlib import Path

import pandas as pd
import pytest

import armscope
from armscope import PosesWarning, PredictionWarning
from armscope.core.inputs import InputError
from armscope.notebook.notes import with_notes
from armscope.notebook.result import Diagnosed

EXAMPLE = Path(__file__).parents[2] / "examples" / "one-effect"


def test_what_has_no_notes_is_handed_on_in_silence(recwarn: pytest.WarningsRecorder) -> None:
    assert with_notes((3, [])) == 3
    assert not recwarn
    with pytest.warns(PredictionWarning, match="left out"):
        assert with_notes((3, ["something is left out"])) == 3


@pytest.fixture(scope="module")
def one_effect() -> tuple[pd.DataFrame, Diagnosed]:
    """Recordings of an arm whose second joint gives way, and what is found."""
    recordings = pd.read_csv(EXAMPLE / "recordings.csv").assign(run="monday")
    found = armscope.diagnose(recordings, EXAMPLE / "robot.yaml", resamples=0, cross_validation=False)
    assert isinstance(found, Diagnosed)
    return recordings, found


@pytest.mark.long
def test_a_run_that_the_model_does_not_know_is_said(one_effect: tuple[pd.DataFrame, Diagnosed]) -> None:
    recordings, found = one_effect
    for predict in (found.predict, lambda rows: armscope.predict(found, rows)):
        with pytest.warns(PredictionWarning, match="'tuesday' is not in the model"):
            predict(recordings.assign(run="tuesday"))


def test_a_load_that_an_effect_follows_is_never_taken_for_none(one_effect: tuple[pd.DataFrame, Diagnosed]) -> None:
    """As the command refuses it."""
    recordings, found = one_effect
    nothing_stated = recordings.drop(columns="payload_kg")
    for predict in (found.predict, lambda rows: armscope.predict(found, rows)):
        with pytest.raises(InputError, match="payload_kg"):
            predict(nothing_stated)
    with pytest.warns(PredictionWarning, match="the arm carries nothing"):  # nobody knows what its recordings held
        armscope.predict(found.model, nothing_stated)


def test_orientations_come_from_a_notebook_too(one_effect: tuple[pd.DataFrame, Diagnosed]) -> None:
    recordings, found = one_effect
    assert list(armscope.predict(found, recordings, pose=True).columns)[-4:] == ["qw", "qx", "qy", "qz"]


def test_what_chosen_poses_were_not_checked_for_is_told() -> None:
    """By the options of the command line: with a floor and a tracker there is less to say."""
    options = {"candidates": 60, "starts": 1}
    with pytest.warns(PosesWarning) as told:
        armscope.choose_poses(EXAMPLE / "robot.yaml", 15, **options)
    words = " ".join(str(each.message) for each in told)
    assert "no --floor-mm" in words
    assert "no --tracker" in words
    with pytest.warns(PosesWarning) as told:
        armscope.choose_poses(EXAMPLE / "robot.yaml", 15, floor_mm=0, tracker=(4000, 0, 1500), radius_mm=20, **options)
    (body,) = told
    assert "20 mm radius" in str(body.message)
