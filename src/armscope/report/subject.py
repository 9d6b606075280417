"""What the page of a diagnosis is about: the diagnosis, and what several sections and figures ask of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from matplotlib.figure import Figure

from armscope.errormodels.reference_models import held_out_rms
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.verdict.schema import Diagnosis


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
    def references(self) -> list[tuple[str, float]]:
        """(model, RMS per axis in mm on held-out rows) of the paper's models."""
        return held_out_rms(self.arm, self.recordings, self.verdict.residuals.before)


@dataclass(frozen=True, eq=False)
class Drawn:
    """A figure, the name of its file, and what it shows, for those who can't see it."""

    name: str
    figure: Figure
    alt: str


@dataclass(frozen=True)
class Section:
    """A section of the page; its template is templates/diagnosis/<name>.html.j2.

    Attributes:
        name: its anchor.
        link: what leads to it from the top of the page.
        context: what its template is filled with, beside ``verdict`` and ``figures`` (the saved ones by name).
        figures: each draws what this verdict has something for.
        applies: whether the page has it at all.
    """

    name: str
    link: str
    context: Callable[[Subject], dict[str, Any]] = lambda subject: {}
    figures: tuple[Callable[[Subject], Iterable[Drawn]], ...] = ()
    applies: Callable[[Diagnosis], bool] = lambda verdict: True
