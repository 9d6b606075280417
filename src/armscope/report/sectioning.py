"""Sections of a page: what each shows, and how it becomes HTML; the page of a diagnosis of positions or of a motion."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar

from markupsafe import Markup

from armscope.core.files import write_text
from armscope.core.inputs import InputError, nearest
from armscope.errormodels.reference_models import held_out_rms
from armscope.recordings import Recordings
from armscope.report.html import render_page
from armscope.report.svg import Drawing
from armscope.robot import Arm
from armscope.verdict.contributions import Contributions, contributions
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.importance import expected
from armscope.verdict.work_order import WorkOrder, work_order


class HasVerdict(Protocol):
    """What a page is about."""

    @property
    def verdict(self) -> Any:
        """What was found."""


S = TypeVar("S", bound=HasVerdict)


@dataclass(frozen=True, eq=False)
class Drawn:
    """A figure and the name of its file."""

    name: str
    figure: Drawing


@dataclass(frozen=True)
class Section(Generic[S]):
    """A section of a page; its template is <name>.html.j2 in the page's folder of templates."""

    name: str
    link: str  # what leads to it from the top of the page
    title: str
    # what its template is filled with, beside ``verdict`` and ``figures`` (the saved ones by name)
    context: Callable[[S], dict[str, Any]] = lambda subject: {}
    figures: tuple[Callable[[S], Iterable[Drawn]], ...] = ()  # each draws what this subject has something for
    applies: Callable[[Any], bool] = lambda verdict: True  # whether the page of this verdict has it at all
    folded: bool = False  # whether it opens only when it is asked for


@dataclass(frozen=True)
class Written:
    """A section as the page takes it."""

    name: str
    link: str
    title: str
    folded: bool
    html: Markup


def write_sections(sections: Sequence[Section[S]], subject: S, templates: str, folder: Path) -> list[Written]:
    """Draw and save the figures of those sections that apply, and fill the sections' templates.

    Args:
        sections: in their order.
        subject: what the page is about.
        templates: the folder of their templates.
        folder: figures go into its folder ``figures``.

    Returns:
        The sections as HTML.
    """
    shown = [section for section in sections if section.applies(subject.verdict)]
    figures = {
        drawn.name: _saved(drawn, folder / "figures")
        for section in shown
        for figure in section.figures
        for drawn in figure(subject)
    }
    written = []
    for section in shown:
        context = {"verdict": subject.verdict, "figures": figures, **section.context(subject)}
        # its own template escaped what it was filled with
        html = Markup(render_page(f"{templates}/{section.name}.html.j2", **context))
        written.append(Written(section.name, section.link, section.title, section.folded, html))
    return written


def _saved(drawn: Drawn, folder: Path) -> Markup:
    write_text(folder / f"{drawn.name}.svg", drawn.figure.svg(paper=True))
    return Markup(drawn.figure.svg())  # its words were escaped when they were drawn


def figure_named(sections: Sequence[Section[S]], subject: S, name: str) -> Drawing:
    """One figure of a page, drawn as it is asked for.

    Args:
        sections: of the page.
        subject: what the page is about.
        name: of the figure.

    Returns:
        The figure.

    Raises:
        InputError: there is none of that name; it lists those that there are.
    """
    names = []
    for section in (section for section in sections if section.applies(subject.verdict)):
        for figure in section.figures:
            for drawn in figure(subject):
                if drawn.name == name:
                    return drawn.figure
                names.append(drawn.name)
    raise InputError("plot", "", name, f"one of {', '.join(names)}", nearest(name, names))


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
