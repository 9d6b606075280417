"""What the page of a diagnosis is about: the diagnosis, and what several sections and figures ask of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from armscope.errormodels.reference_models import held_out_rms
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.verdict.contributions import Contributions, contributions
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.importance import expected
from armscope.verdict.work_order import WorkOrder, work_order


@dataclass(frozen=True, eq=False)
class Subject:
    """A diagnosis with the table as it was used; what takes long is done once."""

    verdict: Diagnosis

    @property
    def arm(self) -> Arm:
        """The nominal arm."""
        return self.verdict.model.arm

    @property
    def recordings(self) -> Recordings:
        """The rows that the diagnosis used."""
        return self.verdict.recordings

    @cached_property
    def worth(self) -> Contributions:
        """What each cause moves, and what curing it would leave."""
        return contributions(self.verdict)

    @cached_property
    def order(self) -> WorkOrder:
        """The work order."""
        return work_order(self.verdict, self.worth)

    def expected(self, mm: float) -> float:
        """RMS per axis, mm, to expect on poses that took no part, where one on the recorded rows is known."""
        return expected(self.verdict, self.worth, mm)

    @cached_property
    def references(self) -> list[tuple[str, float]]:
        """(model, RMS per axis in mm on held-out rows) of the paper's models."""
        return held_out_rms(self.arm, self.recordings, self.verdict.residuals.before)
