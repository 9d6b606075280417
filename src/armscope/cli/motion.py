"""Arms in motion on the command line: what `diagnose` does with a table of torques."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

    from armscope.check.suspicion import Suspicion
    from armscope.recordings.motions import Motions
    from armscope.robot.dynamics import MovingArm
    from armscope.verdict.schema import Answer

Tell = Callable[[str, float], None]
FILES = ("verdict.json", "model.yaml", "corrected.urdf", "mujoco.xml", "parameters.csv", "atlas.csv", "curves.csv")
"""All that is written beside the page."""


PAGES = ("report.html", "work-order.html")


@dataclass(frozen=True)
class MotionOptions:
    """What a user asks of a diagnosis of a motion."""

    cutoff: float | None  # Hz, or None
    # held_out, runs: runs that are held out, and runs that are used (none: all)
    held_out: list[str]
    runs: list[str]
    as_json: bool  # whether verdict.json is printed in place of words
    report: bool  # whether the page is written
    anyway: bool  # go on though the check says that the table is unusable


def diagnose_motions(table: Path, robot: Path, output: Path, asked: MotionOptions, tell: Tell) -> Answer:
    """Diagnose motions.csv and write what was found.

    Args:
        table: motions.csv.
        robot: robot.yaml.
        output: the folder for verdict and model.
        asked: what the user asks for.
        tell: hears what is being done.

    Returns:
        The answer.

    Raises:
        InputError: a run that is asked for is not there, or the table can't be used.
    """
    arm, motions, problems = _read_and_checked(table, robot, asked)
    from armscope.cli.robots import print_json
    from armscope.core.files import writable
    from armscope.motion.export import write_motion
    from armscope.motion.pipeline import MotionSettings, diagnose_motion
    from armscope.verdict.schema import Notice

    writable(output, *FILES, *(PAGES if asked.report else ()))
    found = diagnose_motion(arm, motions, MotionSettings(asked.cutoff, tuple(asked.held_out)), tell)
    if problems:
        notices = (*found.verdict.notices, *(Notice("check", each.text()) for each in problems))
        found = replace(found, verdict=replace(found.verdict, notices=notices))
    write_motion(found, output)
    if asked.report:
        from armscope.report.pages.motion import write_motion_report

        tell("drawing the report", 0.98)
        write_motion_report(found, table.name, output, robot)
    for notice in found.verdict.notices:
        print(f"note: {notice.text}", file=sys.stderr)
    if asked.as_json:
        print_json(found.verdict.to_json())
    else:
        print(found.verdict.headline)
        print(f"{output}/{'report.html' if asked.report else 'verdict.json'}")
    return found.verdict.answer


def _read_and_checked(table: Path, robot: Path, asked: MotionOptions) -> tuple[MovingArm, Motions, list[Suspicion]]:
    """Arm, samples and what is wrong with them, before anything is imported that only a good table needs."""
    import numpy as np

    from armscope.core.inputs import InputError, nearest

    arm, motions = _arm_and_motions(robot, table)
    for run in (*asked.runs, *asked.held_out):
        if run not in motions.runs:
            option = "--run" if run in asked.runs else "--held-out"
            cure = nearest(run, motions.runs) or "The table names no runs (column run): leave this out."
            raise InputError(option, "", run, f"{table} has no such run", cure)
    if asked.runs:
        motions = motions.rows(np.isin(motions.run, [*asked.runs, *asked.held_out]))
    from armscope.check.motions import check_moving
    from armscope.check.suspicion import refuse_problems

    problems = [each for each in check_moving(motions, arm).suspicions if each.weight == "problem"]
    if not asked.anyway:
        refuse_problems(problems, table)
    return arm, motions, problems


def _arm_and_motions(robot: Path, table: Path) -> tuple[MovingArm, Motions]:
    """Both, with what was guessed of a URDF said. Raises InputError: one of them can't be used; where motors are too
    many or few for a tip that was guessed, it says so."""
    from armscope.cli.robots import tell_guesses
    from armscope.core.inputs import InputError
    from armscope.recordings.motions import OtherMotors, read_motions
    from armscope.robot.dynamics import load_moving_arm

    arm = load_moving_arm(robot)
    told = arm.description.source.get("tip", "")
    try:
        motions = read_motions(table, arm.n_motors)
    except OtherMotors as error:
        if not told.startswith("guessed"):
            raise
        urdf = Path(str(arm.description.urdf)).name
        content = f"{{name: {arm.description.name}, urdf: {urdf}, tip: NAME}}"
        cure = f"Where the arm ends was {told}. Name the link that carries the tool in a robot.yaml: `{content}`."
        raise InputError(error.file, error.place, error.found, error.rule, cure) from error
    tell_guesses(robot, arm.description)
    return arm, motions


def predicted_motions(model: Path, motions: Path) -> tuple[pd.DataFrame, list[str]] | None:
    """Torques of a table of motions, and notes; None where the model is of another kind. Raises InputError: the
    model is of a motion, and it or the table can't be used."""
    from armscope.core.inputs import read_yaml
    from armscope.robot.urdf_file import is_xml

    if model.suffix == ".json" or is_xml(model):
        return None
    content = read_yaml(model)
    if not (isinstance(content, dict) and "motion" in str(content.get("format"))):
        return None  # what reads models of motions is slow to import
    from armscope.motion.model.file import is_motion_model
    from armscope.motion.predicting import predict_motions

    return predict_motions(model, motions) if is_motion_model(content) else None


def check_motions_table(table: Path, robot: Path | None, as_json: bool) -> bool:
    """Say what a table of motions holds and what looks wrong in it.

    Args:
        table: motions.csv.
        robot: robot.yaml, to compare torques with its masses; None looks at the table alone.
        as_json: whether it is printed as JSON in place of words.

    Returns:
        Whether something makes results meaningless.

    Raises:
        InputError: the table can't be used.
    """
    from armscope.cli.robots import print_json
    from armscope.recordings.motions import read_motions

    arm, motions = (None, read_motions(table)) if robot is None else _arm_and_motions(robot, table)

    from armscope.check.motions import check_moving

    found = check_moving(motions, arm)
    if as_json:
        print_json(found.to_json())
    else:
        print(found.text())
    return found.has_problems
