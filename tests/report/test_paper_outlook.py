"""The tables beyond the paper's virtual study: one row per model, whichever arms there are."""

from pathlib import Path

import pandas as pd

from armscope.report.pages.paper import Outlook, ReproducedArm

STAGES = [("identification", "fit"), ("test 1", "open loop"), ("test 1", "closed loop")]


def _cross_table(*real: str) -> pd.DataFrame:
    rows = [("virtual", path, stage) for path, stage in STAGES]
    rows += [(arm, path, stage) for arm in real for path, stage in (("held out", "fit"), ("held out", "prediction"))]
    return pd.DataFrame(
        [
            {"arm": arm, "model": model, "trajectory": path, "stage": stage, "axis": axis, "rms_mm": count + factor}
            for factor, model in enumerate(("Uncompensated", "FDP(CI)"))
            for count, (arm, path, stage) in enumerate(rows)
            for axis in ("x", "3D")
        ]
    )


def test_a_real_arm_has_one_column_of_its_held_out_rows(tmp_path: Path) -> None:
    _cross_table("arm A (lab, 2016)", "arm B (lab, 2017)").to_csv(tmp_path / "cross_table.csv", index=False)
    table = Outlook(tmp_path).real
    assert list(table.columns) == ["held out, 3D RMS in mm", "arm A", "arm B"]
    assert table.to_numpy().tolist() == [["Uncompensated", 4, 6], ["FDP(CI)", 5, 7]]


def test_without_real_arms_their_table_is_empty(tmp_path: Path) -> None:
    _cross_table().to_csv(tmp_path / "cross_table.csv", index=False)
    assert Outlook(tmp_path).real.empty


def test_the_virtual_arm_has_one_column_per_path_and_stage(tmp_path: Path) -> None:
    _cross_table("arm A (lab, 2016)").to_csv(tmp_path / "cross_table.csv", index=False)
    table = Outlook(tmp_path).virtual
    assert list(table.columns) == ["3D RMS error in mm", "fit", "test 1 open loop", "test 1 closed loop"]
    assert table.to_numpy().tolist() == [["Uncompensated", 0, 1, 2], ["FDP(CI)", 1, 2, 3]]


def test_positions_and_orientations_stand_side_by_side(tmp_path: Path) -> None:
    rows = [("6D", path, stage, 1.0, 2.0) for path, stage in STAGES if stage != "open loop"]
    columns = ["model", "trajectory", "stage", "rms_mm", "rms_mrad"]
    pd.DataFrame(rows, columns=columns).to_csv(tmp_path / "full_pose.csv", index=False)
    table = Outlook(tmp_path).full_pose
    assert list(table.columns) == ["model", "fit (mm)", "fit (mrad)", "test 1 (mm)", "test 1 (mrad)"]
    assert table.to_numpy().tolist() == [["6D", 1, 2, 1, 2]]


def test_a_real_arm_in_the_form_of_table_2(tmp_path: Path) -> None:
    rows = [("FDP(CI)", path, axis, 0.5, 85) for path in ("identification", "held out") for axis in ("x", "3D")]
    columns = ["model", "trajectory", "axis", "rms_median", "points"]
    pd.DataFrame(rows, columns=columns).to_csv(tmp_path / "table2.csv", index=False)
    arm = ReproducedArm("arm A", tmp_path, None)
    assert list(arm.table.columns) == ["RMS error in mm", "fitted x", "fitted 3D", "held out x", "held out 3D"]
    assert arm.rows == {"identification": 85, "held out": 85}
