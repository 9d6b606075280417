"""A diagnosis of an arm in motion as a notebook shows it, with the files of the command."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any, TypeGuard

import pandas as pd

from armscope.check.motions import MotionCheck, check_moving
from armscope.core.inputs import DATA_FRAME, InputError
from armscope.core.outputs import Delivery
from armscope.core.told import paragraphs, table
from armscope.motion.export import write_motion
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.predicting import torque_table
from armscope.notebook.notes import with_notes
from armscope.recordings.first_lines import is_motion, is_motion_table
from armscope.recordings.motions import Motions, as_motions, read_motions
from armscope.report.motion_subject import MotionSubject
from armscope.report.pages.motion import write_motion_report
from armscope.report.sectioning import figure_named
from armscope.report.sections.motion import MOTION_SECTIONS
from armscope.report.svg import Drawing
from armscope.robot.dynamics import load_moving_arm
from armscope.verdict.wording import percent

MotionTable = Motions | pd.DataFrame | Path | str


class MotionDiagnosed(MotionDiagnosis):
    """A `MotionDiagnosis` with what a notebook asks of it; `to_json()` is the content of verdict.json."""

    def __repr__(self) -> str:
        causes = [f"{each.title} ({percent(each.share)})" for each in self.verdict.effects]
        about = f"{self.arm.name}, {self.verdict.samples} samples."
        return " ".join([self.verdict.headline, about, *([f"Causes: {'; '.join(causes)}."] if causes else [])])

    def _repr_html_(self) -> str:
        cells = [
            (each.title, percent(each.share), f"{each.rms:.2g} {each.unit}", each.cure) for each in self.verdict.effects
        ]
        return paragraphs(self.verdict.headline) + table(("cause", "share", "torque, RMS", "cure"), cells)

    def to_json(self) -> dict[str, Any]:
        """The content of verdict.json."""
        return self.verdict.to_json()

    def report(self, folder: Path | str = "armscope-report", force: bool = False) -> Path:
        """Write all that `armscope diagnose motions.csv -o folder` writes.

        Returns:
            The page's path.

        Raises:
            InputError: the folder holds files of the same names that armscope did not write.
        """
        delivery = Delivery("diagnose", [], [Path(folder)], force)
        with delivery.running():
            write_motion(self, folder)
            page = write_motion_report(self, "motions", folder)
            delivery.put()
        return page

    def plot(self, name: str = "arm") -> Drawing:
        """A figure of the report: "arm", "waterfall", "trace_1", "friction_1", ...: a wrong name lists what there is.

        Raises:
            InputError: this diagnosis has no figure of that name.
        """
        return figure_named(MOTION_SECTIONS, MotionSubject(self, "motions"), name)

    def predict(self, motions: MotionTable) -> pd.DataFrame:
        """The torques of every sample of a motion, as `armscope predict` writes them; its notes are warnings.

        Raises:
            InputError: the motion can't be used.
        """
        return with_notes(torque_table(self.model, _read(motions, self.arm.n_motors, measured=False)))


def diagnose_moving(motions: MotionTable, robot: Path | str, **options: Any) -> MotionDiagnosed:
    """Diagnose a table of motions.

    Args:
        motions: the table.
        robot: robot.yaml with masses, or a URDF.
        options: of `armscope.motion.pipeline.MotionSettings` (``cutoff=8.0, held_out=("run 3",)``).

    Returns:
        The verdict.

    Raises:
        InputError: something that can't be used.
    """
    known = set(MotionSettings.__dataclass_fields__)
    if wrong := sorted(set(options) - known):
        raise InputError("diagnose", "", wrong[0], f"of a table of motions, one of {', '.join(sorted(known))}")
    arm = load_moving_arm(robot)
    found = diagnose_motion(arm, _read(motions, arm.n_motors), MotionSettings(**options))
    return MotionDiagnosed(**{each.name: getattr(found, each.name) for each in fields(found)})


def check_motions(motions: MotionTable, robot: Path | str | None = None) -> MotionCheck:
    """What a table of motions holds and what looks wrong in it.

    Returns:
        As `armscope check`.

    Raises:
        InputError: something that can't be used.
    """
    arm = None if robot is None else load_moving_arm(robot)
    return check_moving(_read(motions, None if arm is None else arm.n_motors), arm)


def of_motion(table: object) -> TypeGuard[MotionTable]:
    """Whether a table is of an arm in motion."""
    if isinstance(table, pd.DataFrame):
        return is_motion(list(table.columns))
    return isinstance(table, Motions) or (isinstance(table, str | Path) and is_motion_table(table))


def _read(motions: MotionTable, n_motors: int | None, measured: bool = True) -> Motions:
    if isinstance(motions, Motions):
        return motions
    if isinstance(motions, pd.DataFrame):
        return as_motions(motions, DATA_FRAME, n_motors, measured)
    return read_motions(motions, n_motors, measured)
