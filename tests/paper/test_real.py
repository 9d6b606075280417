"""The study on real arms: on an arm whose frames and errors are known, and on real recordings where present."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from armscope.core.inputs import InputError
from armscope.errormodels.features import FDP_AI, FDP_CI
from armscope.errormodels.swarm_fit import fit_swarms
from armscope.paper.beside_printed import table2
from armscope.paper.real import real_measurements
from armscope.paper.residuals import residual_table
from armscope.recordings import as_recordings, read_recordings
from armscope.robot import chain, load_arm

SHARED = Path(__file__).parents[3] / "shared" / "recordings"
BASE = Rotation.from_euler("xyz", [0.3, -0.2, 1.1])
SHIFT = np.array([0.5, -2.0, 1.0])
OFFSETS = {"a": np.array([0.22, 0.01, 0.03]), "b": np.array([0.1, -0.1, 0.05])}


def recordings(arm, n_rows=150, error_m=None, targets=("a",)):
    """Recordings with a known base, known tools and a known error field (in base axes)."""
    q = np.random.default_rng(0).uniform(-1, 1, (n_rows, 6))
    frames = chain(arm, q)
    origins = frames.tool - frames.tool_rotation @ arm.tool
    tables = []
    for target in targets:
        points = origins + frames.tool_rotation @ OFFSETS[target]
        if error_m is not None:
            points = points + error_m(q)
        measured = (BASE.apply(points) + SHIFT) * 1e3
        columns = {f"q{j + 1}_rad": q[:, j] for j in range(6)} | dict(
            zip(("x_mm", "y_mm", "z_mm"), measured.T, strict=True)
        )
        tables.append(
            pd.DataFrame({"id": np.arange(1, n_rows + 1).astype(str), "run": "r", "target": target, **columns})
        )
    return as_recordings(pd.concat(tables, ignore_index=True))


def test_a_perfect_arm_has_no_error_once_the_frames_are_found(arm):
    study = real_measurements(arm, recordings(arm), seed=0)
    for each in study.measurements.sets:
        assert np.abs(each.errors_mm).max() < 1e-6
    assert np.allclose(study.base_position_m, SHIFT, atol=1e-8)
    assert np.allclose(study.base_rotation, BASE.as_matrix(), atol=1e-8)
    assert np.allclose(study.tools_m["a"], OFFSETS["a"], atol=1e-8)
    assert [len(each.motor_angles) for each in study.measurements.sets] == [85, 65]


def test_a_known_error_is_seen_in_base_axes(arm):
    def wave(q):
        return 1e-3 * np.column_stack([np.sin(6 * q[:, 0]), np.zeros(len(q)), np.zeros(len(q))])

    study = real_measurements(arm, recordings(arm, 300, wave), seed=0)
    held_out = study.measurements["held out"]
    expected = wave(held_out.motor_angles) * 1e3
    left = held_out.errors_mm[0] - expected  # what the frames took up of it
    assert np.sqrt(np.mean(left**2)) < 0.6 * np.sqrt(np.mean(expected**2))
    assert np.corrcoef(held_out.errors_mm[0, :, 0], expected[:, 0])[0, 1] > 0.9


def test_targets_of_one_configuration_stay_together(arm):
    study = real_measurements(arm, recordings(arm, 60, targets=("a", "b")), seed=0)
    chosen, rest = (each.motor_angles for each in study.measurements.sets)
    assert len(chosen) + len(rest) == 120
    assert len(chosen) <= 85
    assert not set(map(tuple, chosen)) & set(map(tuple, rest))
    assert np.allclose(study.tools_m["b"], OFFSETS["b"], atol=1e-7)
    assert np.abs(study.measurements["held out"].errors_mm).max() < 1e-5


def test_held_out_rows_have_no_say(arm):
    """Another error in the held-out rows changes nothing that was fitted."""
    table = recordings(arm)
    study = real_measurements(arm, table, seed=0)
    q = study.measurements["held out"].motor_angles
    held_out = np.array([any(np.array_equal(row, other) for other in q) for row in table.motor_angles])
    positions = table.positions.copy()
    positions[held_out] += 0.5
    disturbed = real_measurements(arm, type(table)(**{**vars(table), "positions": positions}), seed=0)
    assert np.array_equal(disturbed.base_position_m, study.base_position_m)
    first, second = (each.measurements.identification.errors_mm for each in (study, disturbed))
    assert np.array_equal(first, second)


def test_rows_are_selected_by_run_and_id(arm):
    table = recordings(arm, 100)
    assert len(table.of_runs(["r"], 31)) == 70
    with pytest.raises(InputError, match=r"column run: found 's'.*'r'|Known"):
        table.of_runs(["s"])
    with pytest.raises(InputError, match="no row has this id"):
        table.of_runs(["r"], 1000)


def test_too_few_rows_and_another_arm_are_refused(arm):
    with pytest.raises(InputError, match="too few"):
        real_measurements(arm, recordings(arm, 6), seed=0)
    with pytest.raises(InputError, match=r"2 identification poses, of 60 rows"):
        real_measurements(arm, recordings(arm, 60), count=2, seed=0)  # the rows are not to blame
    table = recordings(arm, 50)
    seven = type(table)(**{**vars(table), "motor_angles": np.zeros((50, 7))})
    with pytest.raises(InputError, match="has 6 motors"):
        real_measurements(arm, seven, seed=0)


@pytest.mark.shared
@pytest.mark.parametrize(
    ("folder", "run", "first_id", "nominal_mm"),
    [
        ("ma1400-leica", "leica_random", 172, (1.8, 2.6)),
        ("iiwa7-payload", "2016-11-18", None, (0.8, 1.7)),
        ("ur10-ipa", "series_C", None, (0.7, 1.5)),
        ("irb120-offsets", "cal", None, (3.0, 8.0)),
        ("panda-charuco", None, None, (1.0, 5.0)),
    ],
)
def test_real_arms_in_the_form_of_table_2(folder, run, first_id, nominal_mm):
    """The nominal residual is that of independent fits of base and tool (../shared/recordings says 2.17 mm, MA1400)."""
    if not (SHARED / folder).is_dir():
        pytest.skip(f"no {SHARED / folder}: the folder of shared recordings is not beside the checkout")
    real = load_arm(SHARED / folder / "robot.yaml")
    rows = read_recordings(SHARED / folder / "recordings.csv.gz").of_runs([run] if run else (), first_id)
    measurements = real_measurements(real, rows, seed=1).measurements
    fits = fit_swarms(measurements.fit_problems((FDP_CI, FDP_AI), list(measurements.robots)), seeds=[0, 1])
    table = table2(residual_table(measurements, fits)).set_index(["model", "trajectory", "axis"])
    assert nominal_mm[0] < table.loc[("Uncompensated", "held out", "3D"), "rms_median"] < nominal_mm[1]
    for model in ("FDP(CI)", "FDP(AI)"):
        before = table.loc[("Uncompensated", "identification", "3D"), "rms_median"]
        assert table.loc[(model, "identification", "3D"), "rms_median"] < before
    assert table["printed"].isna().all()
