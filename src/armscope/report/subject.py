"""What the page of a diagnosis is about: the diagnosis, and what several sections and figures ask of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from armscope.errormodels.reference_models import held_out_rms
from armscope.recordings import Recordings
from armscope.report.svg import Drawing
from armscope.robot import Arm
from armscope.verdict.contributions import Contributions, contributions
from armscope.verdict.schema import Diagnosis
from armscope.verdict.work_order import Task, tasks


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
    def tasks(self) -> list[Task]:
        """The work order."""
        return tasks(self.verdict, self.worth)

    @cached_property
    def references(self) -> list[tuple[str, float]]:
        """(model, RMS per axis in mm on held-out rows) of the paper's models."""
        return held_out_rms(self.arm, self.recordings, self.verdict.residuals.before)


@dataclass(frozen=True, eq=False)
class Drawn:
    """A figure and the name of its file."""

    name: str
    figure: Drawing


@dataclass(frozen=True)
class Section:
    """A section of the page; its template is templates/diagnosis/<name>.html.j2.

    Attributes:
        name: its anchor.
        link: what leads to it from the top of the page.
        title: its heading.
        context: what its template is filled with, beside ``verdict`` and ``figures`` (the saved ones by name).
        figures: each draws what this verdict has something for.
        applies: whether the page has it at all.
        folded: whether it opens only when it is asked for.
    """

    name: str
    link: str
    title: str
    context: Callable[[Subject], dict[str, Any]] = lambda subject: {}
    figures: tuple[Callable[[Subject], Iterable[Drawn]], ...] = ()
    applies: Callable[[Diagnosis], bool] = lambda verdict: True
    folded: bool = False
