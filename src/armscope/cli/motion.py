"""Arms in motion on the command line: what `diagnose` does with a table of torques."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

Tell = Callable[[str, float], None]


def diagnose_motions(
    table: Path,
    robot: Path,
    output: Path,
    settings: tuple[float | None, list[str], list[str]],
    as_json: bool,
    tell: Tell,
) -> bool | None:
    """Diagnose motions.csv and write what was found.

    Args:
        table: motions.csv.
        robot: robot.yaml.
        output: the folder for verdict and model.
        settings: cut-off in Hz or None, runs that are held out, runs that are used (none: all).
        as_json: whether verdict.json is printed in place of words.
        tell: hears what is being done.

    Returns:
        Whether there is a mismatch.

    Raises:
        InputError: a run that is asked for is not there, or the table can't be used.
    """
    import numpy as np

    from armscope.cli.robots import print_json
    from armscope.core.inputs import InputError, nearest
    from armscope.motion.model_file import save_motion_model
    from armscope.motion.pipeline import MotionSettings, diagnose_motion
    from armscope.motion.verdict import write_motion_verdict
    from armscope.recordings.motions import read_motions
    from armscope.robot.dynamics import load_moving_arm

    cutoff, held_out, runs = settings
    arm = load_moving_arm(robot)
    motions = read_motions(table, arm.n_motors)
    for run in runs:
        if run not in motions.runs:
            raise InputError("--run", "", run, f"{table} has no such run", nearest(run, motions.runs))
    if runs:
        motions = motions.rows(np.isin(motions.run, [*runs, *held_out]))
    found = diagnose_motion(arm, motions, MotionSettings(cutoff, tuple(held_out)), tell)
    write_motion_verdict(found.verdict, output)
    save_motion_model(output / "model.yaml", found.model)
    for notice in found.verdict.notices:
        print(f"note: {notice.text}", file=sys.stderr)
    if as_json:
        print_json(found.verdict.to_json())
    else:
        print(found.verdict.headline)
        print(f"{output}/verdict.json")
    return found.verdict.mismatch


def predicted_motions(model: Path, motions: Path) -> tuple[pd.DataFrame, list[str]] | None:
    """Torques of a table of motions, and notes; None where the model is of another kind.

    Raises:
        InputError: the model is of a motion, and it or the table can't be used.
    """
    from armscope.core.inputs import read_yaml
    from armscope.robot.urdf_file import is_xml

    if model.suffix == ".json" or is_xml(model):
        return None
    from armscope.motion.model_file import is_motion_model
    from armscope.motion.predicting import predict_motions

    return predict_motions(model, motions) if is_motion_model(read_yaml(model)) else None
