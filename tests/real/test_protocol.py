"""Figures of the protocol come from rows that took no part; references stay as they were stated."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from armscope.calibration.held_out import random_split
from armscope.core.inputs import InputError
from armscope.real import protocol
from armscope.real.protocol import ARMSCOPE, ORIENTED, measure_run, paper_models, protocol_table
from armscope.real.reference import Best, Reference, ReferenceRun, ReferenceTransfer, load_reference
from armscope.real.transfer import calibrated_transfer, learn, measure_transfers
from armscope.recordings import as_recordings
from tests.real.recorded import arm, table

REFERENCES = sorted((Path(__file__).parents[2] / "config" / "recordings").glob("*/reference.yaml"))
NOISE_MM = 0.02


def offsets(angles, rng):
    return np.tile([0.0, 2e-3, -1e-3, 0, 1e-3, 0], (len(angles), 1))


def recordings(*tables):
    return as_recordings(pd.concat(tables, ignore_index=True), "made up", 6)


@pytest.fixture(scope="module")
def measured():
    rows = recordings(table(120, NOISE_MM, error_rad=offsets))
    run = ReferenceRun(
        name="one", run="one", splits=2, figures_mm={"nominal": (1.5, 0.1)}, best=Best(mm=0.05, what="x")
    )
    return run, measure_run(arm(), rows, run)


@pytest.mark.long
def test_a_known_arm_is_predicted_to_its_noise(measured):
    run, found = measured
    shown = protocol_table(found.splits, run).set_index("model")["mean_mm"]
    floor = NOISE_MM * np.sqrt(3)
    assert shown["nominal"] > 10 * floor
    assert floor * 0.8 < shown["offsets"] < 1.3 * floor
    assert floor * 0.8 < shown[ARMSCOPE] < 1.3 * floor
    assert {"joint 2", "joint 3", "joint 5"} <= set(found.names["location"])


@pytest.mark.long
def test_orientations_are_learned_from_in_a_row_of_its_own():
    run = ReferenceRun(name="one", run="one", splits=2, figures_mm={"nominal": (1.5, 0.1)})
    rows = recordings(table(60, 0.3, error_rad=offsets, turn_noise_rad=1e-4))
    found = measure_run(arm(), rows, run, oriented_splits=1)
    table_ = protocol_table(found.splits, run).set_index("model")
    assert table_["splits"][ARMSCOPE] == 2
    assert table_["splits"][ORIENTED] == 1
    assert np.isnan(table_["turn_mrad"][ARMSCOPE])
    # the angle has three components, and joints' zeros are found far better than their noise
    assert table_["turn_mrad"][ORIENTED] == pytest.approx(0.1 * np.sqrt(3), rel=0.2)
    first = found.splits[found.splits["split"] == 0].set_index("model")["rms_mm"]
    assert first[ORIENTED] < 1.02 * first[ARMSCOPE]
    assert set(found.names["model"]) == {ARMSCOPE, ORIENTED}


def test_the_diagnosis_never_sees_a_test_row(measured, monkeypatch):
    run, _ = measured
    rows = recordings(table(60, NOISE_MM, error_rad=offsets))
    seen = []

    def spying(arm_, table_, settings):
        assert not settings.orientation
        seen.append(set(table_.id))
        raise KeyboardInterrupt

    monkeypatch.setattr(protocol, "diagnose", spying)
    with pytest.raises(KeyboardInterrupt):
        measure_run(arm(), rows, run)
    train, test = random_split(rows, 0)
    assert seen[0] == set(rows.id[train])
    assert not seen[0] & set(rows.id[test])


def test_the_papers_models_are_fitted_at_85_rows_and_tested_on_the_rest():
    rows = paper_models(arm(), recordings(table(200, NOISE_MM, error_rad=offsets)))
    assert {(row["train"], row["test"]) for row in rows} == {(85, 115)}
    left = {row["model"]: row["rms_mm"] for row in rows}
    assert left["SDP(AI)"] < left["frames only"]


def test_the_best_figure_is_the_one_to_reach(measured):
    run, found = measured
    row = protocol_table(found.splits, run).set_index("model").loc[ARMSCOPE]
    assert (row["best_mm"], row["best_by"]) == (0.05, "x")
    assert run.model_copy(update={"best": None}).lowest.mm == 1.5


@pytest.mark.long
def test_what_belongs_to_the_arm_carries_over_to_a_run_in_another_place():
    rows = recordings(
        table(120, NOISE_MM, error_rad=offsets), table(60, NOISE_MM, seed=1, error_rad=offsets, run="two")
    )
    transfer = ReferenceTransfer(learned="one", applied="two", refitted=("base", "tool"))
    verdicts = learn(arm(), rows, [transfer])
    ((_, found),) = measure_transfers(arm(), rows, [transfer], verdicts)
    floor = NOISE_MM * np.sqrt(3)
    assert found["nominal"] > 10 * floor
    for model in ("offsets", ARMSCOPE):
        assert found[model] < 1.3 * floor


def test_frames_that_are_kept_are_not_fitted_again():
    moved = table(60, NOISE_MM, seed=1, error_rad=offsets, run="two")
    moved["x_mm"] += 5.0
    rows = recordings(table(120, NOISE_MM, error_rad=offsets), moved)
    kept, fitted = (
        calibrated_transfer(arm(), rows, ReferenceTransfer(learned="one", applied="two", refitted=frames))["offsets"]
        for frames in ((), ("base",))
    )
    assert kept == pytest.approx(5.0, abs=0.05)
    assert fitted < 0.06


@pytest.mark.parametrize("path", REFERENCES, ids=lambda path: path.parent.name)
def test_committed_references_can_be_read(path):
    assert load_reference(path).runs


def test_a_misspelt_run_names_the_nearest():
    with pytest.raises(InputError, match="Did you mean 'one'"):
        recordings(table(20)).of_runs(["onne"])


def test_an_unknown_level_in_a_reference_is_an_error():
    with pytest.raises(ValueError, match="geometrick"):
        Reference.model_validate(
            {"source": "here", "runs": [{"name": "a", "run": "a", "figures_mm": {"geometrick": [1, 1]}}]}
        )
