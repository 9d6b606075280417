"""motions.csv: columns with units, and one clear error for what can't be."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from armscope.core.inputs import InputError
from armscope.recordings.first_lines import is_motion_table
from armscope.recordings.motions import as_motions, read_motions


def table(**more: object) -> pd.DataFrame:
    rows = {"time_s": [0.0, 0.01, 0.02], "q1_rad": [0.1, 0.2, 0.3], "q2_m": [0.0, 0.1, 0.2]}
    return pd.DataFrame({**rows, "tau1_nm": [1.0, 2.0, 3.0], "f2_n": [4.0, 5.0, 6.0], **more})


def test_units_of_turning_and_sliding_joints(tmp_path: Path) -> None:
    path = tmp_path / "motions.csv"
    table(dq1_rad_s=[1.0, 1.0, 1.0], dq2_m_s=[0.5, 0.5, 0.5], q2_cmd_m=0.0, q1_cmd_rad=0.0).to_csv(path, index=False)
    assert is_motion_table(path)
    motions = read_motions(path, 2)
    assert motions.sliding.tolist() == [False, True]
    assert motions.effort[1].tolist() == [2.0, 5.0]
    assert motions.dq is not None
    assert motions.kind == "torque"
    degrees = table().rename(columns={"q1_rad": "q1_deg"})
    assert as_motions(degrees).q[:, 0] == pytest.approx(np.radians([0.1, 0.2, 0.3]))


def test_a_table_of_measured_points_is_none(tmp_path: Path) -> None:
    path = tmp_path / "recordings.csv"
    table(x_mm=1.0, y_mm=1.0, z_mm=1.0).to_csv(path, index=False)
    assert not is_motion_table(path)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: t.drop(columns="time_s"), "no column time_s"),
        (lambda t: t.drop(columns="tau1_nm"), "no column tau1_nm"),
        (lambda t: t.drop(columns="tau1_nm").assign(tau_1=1.0), "mean 'tau_1'"),
        (lambda t: t.drop(columns="q2_m"), "has 1 of them: is this the right robot"),
        (lambda t: t.rename(columns={"q2_m": "q2 rad"}), "mean 'q2 rad'"),
        (lambda t: t.drop(columns=["tau1_nm", "f2_n"]), "what the motors did stands in"),
        (lambda t: t.assign(q1_rad=[10.0, 400.0, 20.0]), "line 3, column q1_rad.*q1_deg"),
        (lambda t: t.assign(q1_deg=1.0), "has a position already"),
        (lambda t: t.assign(q3_rad=1.0), "the arm has 2 motors"),
        (lambda t: t.assign(tau1_nm=["1", "x", "3"]), "line 3, column tau1_nm"),
        (lambda t: t.assign(payload_kg=-1.0), "payload_kg"),
    ],
)  # fmt: skip
def test_what_can_not_be_is_one_error(change, message: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError, match=message):
        as_motions(change(table()), "motions.csv", 2)
