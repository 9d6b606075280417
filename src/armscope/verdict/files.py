"""A verdict as files: verdict.json, model.yaml, predicted.csv, next_poses.csv, and the data behind the figures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from armscope.core.files import read_json, write_json, write_table
from armscope.physics.model_file import save_model
from armscope.recordings.columns import angle_columns
from armscope.verdict.contributions import ground_of, parts_of
from armscope.verdict.diagnosis import Atlas, Diagnosis
from armscope.verdict.filenames import CURVES, VERDICT
from armscope.verdict.schema import Verdict

COLUMNS = ("effect", "location", "driver", "at", "at_unit", "value", "stderr", "unit", "zero_in_value")


def curves_table(verdict: Diagnosis) -> pd.DataFrame | None:
    """Every effect's curve over its driver, one row per point; None where there is none.

    `value` is what is subtracted from a command: `zero_in_value` of it is constant, the joint's own zero where it
    follows the joint's angle; no other step of the work order sets it, and the rest is the curve about its mean.
    """
    told = [(effect, effect.curve) for effect in verdict.effects if effect.curve is not None]
    if not told:
        return None
    parts = parts_of(verdict)
    ground = ground_of(verdict) if any(effect.nameless for effect, _ in told) else None
    pieces = []
    for effect, curve in told:
        zero = ground.own_zero(effect, parts[id(effect)]) if ground is not None else 0.0
        about = (effect.effect, effect.location, curve.driver)
        values = (curve.at, curve.driver_unit, curve.value + zero, curve.stderr, curve.value_unit, zero)
        pieces.append(pd.DataFrame(dict(zip(COLUMNS, (*about, *values), strict=True))))
    return pd.concat(pieces, ignore_index=True)


def read_verdict(path: Path | str) -> Verdict:
    """Read verdict.json. Raises InputError: it is none, or of another version."""
    return Verdict.from_json(read_json(path, "verdict.json of a diagnosis"), path)


def write_verdict(verdict: Diagnosis, folder: Path | str) -> None:
    """Write everything that `armscope diagnose` leaves behind, but the report page.

    verdict.json, model.yaml, predicted.csv (measured and predicted points), suspects.csv, and, where they exist,
    next_poses.csv, curves.csv, atlas.csv.
    """
    folder = Path(folder)
    write_json(folder / VERDICT, verdict.to_json())
    save_model(folder / "model.yaml", verdict.model)
    write_table(folder / "predicted.csv", predicted_table(verdict))
    suspects = pd.DataFrame(
        [vars(row) for row in verdict.suspects], columns=["id", "run", "residual_mm", "weight", "reads_as"]
    )
    write_table(folder / "suspects.csv", suspects)
    if verdict.next_poses is not None:
        write_table(folder / "next_poses.csv", next_poses_table(verdict))
    if (curves := curves_table(verdict)) is not None:
        write_table(folder / CURVES, curves)
    if verdict.atlas is not None:
        write_table(folder / "atlas.csv", atlas_table(verdict.atlas))


def predicted_table(verdict: Diagnosis) -> pd.DataFrame:
    """Per row: predicted tool point in the measurement frame and the residuals before and after, mm."""
    rows = verdict.residuals
    points = rows.points - rows.after
    predicted = verdict.model.to_measurement(points * 1e-3, rows.run) * 1e3
    table = pd.DataFrame({"id": rows.id, "run": rows.run})
    for n, axis in enumerate("xyz"):
        table[f"{axis}_mm"] = predicted[:, n]
    for name, values in (("before", rows.before), ("after", rows.after)):
        for n, axis in enumerate("xyz"):
            table[f"{name}_{axis}_mm"] = values[:, n]
    table["weight"] = rows.weight
    return table


def next_poses_table(verdict: Diagnosis) -> pd.DataFrame:
    """Poses to measure next, ready to be commanded, the most telling first."""
    poses = verdict.next_poses
    assert poses is not None
    table = pd.DataFrame(angle_columns(poses.motor_angles))
    if not np.all(np.isnan(poses.payload_kg)):
        table["payload_kg"] = poses.payload_kg
    table["separation_mm"] = poses.separation_mm
    table["note"] = [poses.checked, *[""] * (len(table) - 1)]  # once: it is long
    return table


def atlas_table(atlas: Atlas) -> pd.DataFrame:
    """The atlas, one row per cell that exists."""
    shape = atlas.share.shape
    at = np.indices(shape).reshape(3, -1)
    table = pd.DataFrame(
        {
            "location": np.array(atlas.locations)[at[0]],
            "direction": np.array(atlas.directions)[at[1]],
            "driver": np.array(atlas.drivers)[at[2]],
            "share": atlas.share.reshape(-1),
            "share_left": atlas.left.reshape(-1),
        }
    )
    return table.dropna(subset=["share"]).reset_index(drop=True)
