"""The commands as functions. Whatever a command reads may be a path, or what such a file holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pandas as pd
from threadpoolctl import threadpool_limits

from armscope.calibration.calibrate import calibrate as calibrate_arm
from armscope.calibration.result import Calibration
from armscope.check.motions import MotionCheck
from armscope.check.preconditions import check_table as usable_rows
from armscope.check.report import CheckReport
from armscope.check.report import check as check_table
from armscope.comparison import Comparison
from armscope.comparison import compare as compare_recordings
from armscope.compensation.black_box import ErrorModel, load_error_model
from armscope.compensation.compensate import compensate_black_box, compensate_physical
from armscope.compensation.path import WantedPath
from armscope.compensation.physical import Identified, identified_beside, identified_on
from armscope.compensation.predicting import predict_file, predict_rows
from armscope.compensation.result import Compensated
from armscope.compensation.task import Options
from armscope.core.inputs import DATA_FRAME, InputError
from armscope.diagnosis import Settings
from armscope.diagnosis import diagnose as diagnose_arm
from armscope.motion.predicting import predict_motions
from armscope.notebook.chosen import ChosenPoses, poses_by_options
from armscope.notebook.given import (
    Robot,
    Table,
    arm_for,
    arm_of,
    described_file,
    names_of,
    options_of,
    refuse_less_than_two,
    refuse_unknown,
    table_of,
    wanted_path,
)
from armscope.notebook.motion import MotionDiagnosed, check_motions, diagnose_moving, of_motion
from armscope.notebook.notes import PosesWarning, with_notes
from armscope.notebook.result import Diagnosed
from armscope.physics.model import FittedModel
from armscope.physics.model_file import load_model
from armscope.recordings import Recordings, as_recordings
from armscope.recordings import read_recordings as read_table
from armscope.recordings.first_lines import is_motion_table
from armscope.recordings.folders import table_in
from armscope.robot import Arm, load_arm

Model = Diagnosed | MotionDiagnosed | FittedModel | Path | str


def read_robot(robot: Robot) -> Arm:
    """The arm of a robot.yaml or of a URDF (its tip is then guessed: `description.source` says so).

    Raises:
        InputError: the file can't be used; it says what, where, and how to mend it.
    """
    if isinstance(robot, Arm):
        return robot
    if not isinstance(robot, str | Path):
        rule = "a robot.yaml, a URDF or an arm"
        raise InputError("robot", "", type(robot).__name__, rule, "The recordings come first, then the robot.")
    return load_arm(robot)


def read_recordings(recordings: Table, robot: Robot | None = None, measured: bool = True) -> Recordings:
    """A recordings table.

    Args:
        recordings: the path of a CSV or of a folder with recordings.csv, or a data frame with its columns.
        robot: whose motors must be there; None takes as many as the table has.
        measured: whether points must be there; False reads poses.

    Returns:
        The rows, SI units.

    Raises:
        InputError: the table can't be used.
    """
    n_motors = None if robot is None else read_robot(robot).n_motors
    if isinstance(recordings, Recordings):
        return recordings
    if isinstance(recordings, pd.DataFrame):
        return as_recordings(recordings, DATA_FRAME, n_motors, measured)
    if not isinstance(recordings, str | Path):
        cure = "The recordings come first, then the robot."
        raise InputError("recordings", "", type(recordings).__name__, "a table, or the path of one", cure)
    if Path(recordings).suffix in (".yaml", ".yml", ".urdf"):
        cure = "The recordings come first, then the robot, as on the command line."
        raise InputError(recordings, "", "no table", "a recordings table is needed here", cure)
    return read_table(table_in(Path(recordings)), n_motors, measured)


def check(recordings: Table, robot: Robot | None = None) -> CheckReport | MotionCheck:
    """What a table, of points or of motions, holds and what looks wrong in it: `armscope check`.

    Raises:
        InputError: a file can't be used.
    """
    robot, recordings = arm_of(robot, recordings), table_of(recordings)
    if of_motion(recordings):
        return check_motions(recordings, None if robot is None else described_file(robot))
    arm = None if robot is None else read_robot(robot)
    return check_table(read_recordings(recordings), arm)


def diagnose(
    recordings: Table, robot: Robot | None = None, settings: Settings | None = None, **options: Any
) -> Diagnosed | MotionDiagnosed:
    """Where simulation and recordings differ, and which physics was left out: `armscope diagnose`.

    Args:
        recordings: the table, of points or of motions, or a folder with it.
        robot: the nominal arm; robot.yaml of a folder if left out.
        settings: all settings at once, or
        options: some of them by name, see `armscope.diagnosis.Settings` (``seed=1, resamples=0``); of a table of
            motions `armscope.motion.pipeline.MotionSettings` (``cutoff=8.0``).

    Returns:
        The verdict.

    Raises:
        InputError: something that can't be used; it says what, where, and how to mend it.
    """
    if settings is not None and options:
        raise InputError("diagnose", "", sorted(options)[0], "settings, or single options: one of the two")
    robot, recordings = arm_for(robot, recordings), table_of(recordings)
    if of_motion(recordings):
        with threadpool_limits(1):
            return diagnose_moving(recordings, described_file(robot), **options)
    refuse_unknown("diagnose", options, [each.name for each in fields(Settings)])
    settings = settings or Settings(**options)
    table, arm = read_recordings(recordings), read_robot(robot)
    if not settings.orientation:  # what nobody uses is not judged either
        table = replace(table, orientation=None)
    with threadpool_limits(1):  # small matrices: threads of BLAS would only wait for each other
        return Diagnosed(**vars(diagnose_arm(arm, table, settings)))


def calibrate(recordings: Table, robot: Robot | None = None, **options: Any) -> Calibration:
    """Plain geometric calibration: `armscope calibrate`.

    Args:
        recordings: the table, or a folder with it.
        robot: the nominal arm; robot.yaml of a folder if left out.
        options: of `armscope.calibration.calibrate` (``level="offsets", robust=True``).

    Returns:
        Constants, frames and what could not be told apart.

    Raises:
        InputError: something that can't be used.
    """
    refuse_unknown("calibrate", options, options_of(calibrate_arm))
    robot = arm_for(robot, recordings)
    table, arm = read_recordings(recordings, robot), read_robot(robot)
    with threadpool_limits(1):
        return calibrate_arm(arm, table, **options)


def predict(model: Model, poses: Table, pose: bool = False) -> pd.DataFrame:
    """Where the tool point will be, mm: `armscope predict`, whose notes are warnings here.

    Args:
        model: a diagnosis, a fitted model, or the path of model.yaml, errormodel.json, robot.yaml or a URDF.
        poses: motor angles and whatever context the model follows.
        pose: whether orientations come, too; not of motions.

    Returns:
        id, run, x_mm, y_mm, z_mm; of a motion tau1_nm ....

    Raises:
        InputError: something that can't be used.
    """
    if isinstance(model, MotionDiagnosed):
        if isinstance(poses, Recordings):
            raise InputError("poses", "", "recorded points", "this model predicts torques of a table of motions")
        return model.predict(poses)
    if isinstance(model, str | Path) and isinstance(poses, str | Path):
        if is_motion_table(poses):
            return with_notes(predict_motions(Path(model), Path(poses)))
        return with_notes(predict_file(Path(model), Path(poses), pose))
    fitted = _fitted(model)
    rows = read_recordings(poses, fitted.arm, measured=False)
    return with_notes(predict_rows(fitted, rows, _identified(model), pose))


def compensate(
    model: Model, path: WantedPath | pd.DataFrame | Path | str, recordings: Table | None = None, **options: Any
) -> Compensated:
    """Commands under which the real arm reaches the wanted points: `armscope compensate`.

    Args:
        model: a diagnosis, a fitted model, or the path of model.yaml or errormodel.json.
        path: wanted points.
        recordings: on which the model was identified; of a diagnosis its own, beside a model.yaml its domain.json.
        options: those of the command line: frame, pose, start_rad, allowed_outside, separate_points.

    Returns:
        Commands, what they will reach, and which rows have none; `to_table()` is what the command writes. Notes, and
        why rows have no command, are warnings.

    Raises:
        InputError: something that can't be used.
    """
    refuse_unknown("compensate", options, [each.name for each in fields(Options)])
    found = _compensated(model, path, recordings, Options(**options))
    return with_notes((found, (*found.notes, *found.refusals)))


def _compensated(
    model: Model, path: WantedPath | pd.DataFrame | Path | str, recordings: Table | None, chosen: Options
) -> Compensated:
    if isinstance(model, str | Path) and str(model).endswith(".json"):
        error_model: ErrorModel = load_error_model(model)
        return compensate_black_box(error_model, wanted_path(path, error_model.arm), chosen)
    fitted = _fitted(model)
    identified = _identified(model)
    if recordings is not None:
        identified = identified_on(fitted.arm, usable_rows(fitted.arm, read_recordings(recordings)).recordings)
    if identified is None:
        cure = "Give the recordings of the diagnosis."
        raise InputError("recordings", "", "nothing", "the identified range must be known", cure)
    return compensate_physical(fitted, identified, wanted_path(path, fitted.arm), chosen)


def compare(
    *recordings: Table, robot: Robot | None = None, names: Sequence[str] = (), of_arms: bool = False
) -> Comparison:
    """What changed between two or more recordings of one arm: `armscope compare`.

    Args:
        recordings: in the order of time; tables, or folders with them.
        robot: the nominal arm; robot.yaml of the first folder if left out.
        names: of the recordings; else their files' or numbers.
        of_arms: they are of several arms of one type: which is unlike the others.

    Returns:
        The joint test that nothing changed, and every change with its interval.

    Raises:
        InputError: something that can't be used.
    """
    refuse_less_than_two(recordings)
    arm = read_robot(arm_for(robot, recordings[0]))
    named = names_of(recordings, names)
    tables = [read_recordings(each, arm) for each in recordings]
    with threadpool_limits(1):
        return compare_recordings(arm, dict(zip(named, tables, strict=True)), of_arms)


def _fitted(model: Model) -> FittedModel:
    if isinstance(model, str | Path):
        return load_model(model)
    fitted = model.model if isinstance(model, Diagnosed) else model
    if not isinstance(fitted, FittedModel):
        raise InputError("model", "", type(model).__name__, "a diagnosis, a fitted model or a path")
    return fitted


def _identified(model: Model) -> Identified | None:
    """What the recordings of a model held, where they are known."""
    if isinstance(model, str | Path):
        return identified_beside(Path(model))
    if not isinstance(model, Diagnosed):
        return None
    return model.identified()


def choose_poses(robot: Robot, count: int = 85, **options: Any) -> ChosenPoses:
    """The poses that show a set of effects best: `armscope poses`, whose notes are warnings here.

    Args:
        robot: the nominal arm.
        count: how many to measure.
        options: those of the command line: effects, criterion, tracker, floor_mm, radius_mm, payload_kg, candidates,
            starts, seed (``effects="joint_compliance", floor_mm=0, tracker=(4000, 0, 1500)``); seeds, noise_mm and
            all_criteria of the comparison with random poses and a grid (``seeds=40``; none is made without seeds).

    Returns:
        The chosen poses and what they are worth.

    Raises:
        InputError: something that can't be used.
    """
    return with_notes(poses_by_options(read_robot(robot), count, options), PosesWarning)
