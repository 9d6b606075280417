"""A diagnosis as a notebook shows it: one paragraph, a table of causes, figures, and the files of the command."""

from __future__ import annotations

import math
from pathlib import Path

import pandas as pd

from armscope.compensation.physical import FILE, Identified, identified_on, save_identified
from armscope.compensation.predicting import predict_rows
from armscope.core.inputs import DATA_FRAME
from armscope.core.outputs import Delivery
from armscope.core.told import paragraphs, table
from armscope.notebook.notes import with_notes
from armscope.recordings import Recordings, as_recordings, read_recordings
from armscope.report.pages.diagnosis import write_report
from armscope.report.sectioning import Subject, figure_named
from armscope.report.sections.registry import SECTIONS
from armscope.report.svg import Drawing
from armscope.verdict.diagnosis import Diagnosis, promised, rows_it_rests_on
from armscope.verdict.files import write_verdict
from armscope.verdict.wording import millimetres, percent


class Diagnosed(Diagnosis):
    """A `Diagnosis` with what a notebook asks of it; `to_json()` is the content of verdict.json."""

    def __repr__(self) -> str:
        told = [
            self.headline,
            f"{self.arm}, {self.rows} rows, noise {millimetres(self.noise_mm)} per axis;",
            f"{self._left()}.",
        ]
        causes = [f"{e.title} ({percent(e.share)}, {millimetres(e.rms_at_tool_mm)})" for e in self.effects]
        return " ".join([*told, *([f"Causes: {'; '.join(causes)}."] if causes else [])])

    def _left(self) -> str:
        """RMS without and with the model, on rows that took no part where that was tried."""
        held, tried = promised(self), math.isfinite(self.held_out.after)
        before, after = (held.before, held.after) if tried else (self.residual_before_mm, self.residual_after_mm)
        return (
            f"{'held out' if tried else 'on the fitted rows'} {millimetres(before)} before, {millimetres(after)} after"
        )

    def _repr_html_(self) -> str:
        cells = [(e.title, percent(e.share), millimetres(e.rms_at_tool_mm), e.cure) for e in self.effects]
        about = f"{self.arm}, {self.rows} rows; {self._left()}; noise {millimetres(self.noise_mm)} per axis"
        return paragraphs(self.headline, about) + table(("cause", "share", "RMS per axis", "cure"), cells)

    def identified(self) -> Identified:
        """Where the model holds, and how well it foretells there."""
        return identified_on(self.model.arm, rows_it_rests_on(self), *promised(self).foretold)

    def report(self, folder: Path | str = "armscope-report", force: bool = False) -> Path:
        """Write all that `armscope diagnose -o folder` writes.

        Returns:
            The page's path.

        Raises:
            InputError: the folder holds files of the same names that armscope did not write.
        """
        folder = Path(folder)
        delivery = Delivery("diagnose", [], [folder], force)
        with delivery.running():
            write_verdict(self, folder)
            save_identified(folder / FILE, self.identified())
            write_report(self, folder)
            delivery.put()
        return folder / "report.html"

    def plot(self, name: str = "arm") -> Drawing:
        """A figure of the report.

        Args:
            name: "arm", "waterfall", "along_joints", ...: a wrong one lists what there is.

        Returns:
            The figure, which a notebook shows; ``.svg()`` gives its content.

        Raises:
            InputError: this diagnosis has no figure of that name.
        """
        return figure_named(SECTIONS, Subject(self), name)

    def predict(self, poses: Recordings | pd.DataFrame | Path | str) -> pd.DataFrame:
        """Where the tool point will be at other poses, mm, in the measurement frame; notes are warnings.

        Raises:
            InputError: the poses can't be used, or lack what an effect of the model follows.
        """
        motors = self.model.arm.n_motors
        if isinstance(poses, pd.DataFrame):
            poses = as_recordings(poses, DATA_FRAME, motors, measured=False)
        rows = poses if isinstance(poses, Recordings) else read_recordings(poses, motors, measured=False)
        return with_notes(predict_rows(self.model, rows, self.identified()))
