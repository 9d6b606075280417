"""What others reached on public recordings, and how they split them: config/recordings/<set>/reference.yaml."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from pydantic import Field

from armscope.core.config import Count, Positive
from armscope.core.inputs import Strict, load
from armscope.real.constants import PROTOCOL


class Best(Strict):
    """The best figure known for a run, or what was aimed at, and by what it was reached."""

    mm: Positive
    what: str


class ReferenceRun(Strict):
    """One run in the protocol: which rows, how many random splits, and the figures reached on it."""

    name: str  # how tables call it
    run: str
    first_id: int | None = None
    # random splits (seeds 0, 1, ...) into 70 % to train on and 30 % to test on, by configuration
    splits: Count = PROTOCOL.splits
    most_rows: Count | None = None  # of the training rows for the plain calibrations, where the reference used no more
    # test RMS of the 3D distance by level, (mean, standard deviation) over the splits
    figures_mm: dict[Literal["nominal", "offsets", "geometric", "compliance"], tuple[Positive, Positive]]
    best: Best | None = None  # further fits; None where those by level are all there is

    def figure(self, model: str) -> tuple[float, float] | None:
        """What others reached by a model, mm: mean and standard deviation; None where there is none."""
        return next((figure for level, figure in self.figures_mm.items() if level == model), None)

    @property
    def lowest(self) -> Best:
        """The figure to be reached: the best one known."""
        level = min(self.figures_mm, key=lambda name: self.figures_mm[name][0])
        return self.best or Best(mm=self.figures_mm[level][0], what=level)


class ReferenceTransfer(Strict):
    """A model learned on all rows of one run and applied to another, where only frames are fitted again."""

    learned: str
    applied: str
    # which frames are fitted again on the other run; the rest is carried over
    refitted: tuple[Literal["base", "tool"], ...]
    # RMS of the 3D distance there by model; "compliances": these alone carried over
    figures_mm: dict[str, Positive] = Field(default_factory=dict)

    @property
    def lowest(self) -> float | None:
        """The figure to be reached, mm."""
        return min(self.figures_mm.values(), default=None)


class ReferenceCompliances(Strict):
    """Runs of one arm with recorded torques, whose drives must give way alike."""

    runs: tuple[str, ...] = Field(min_length=2)
    # runs that are also fitted together, with a base and a tool each, by what to call them
    together: dict[str, tuple[str, ...]] = Field(default_factory=dict)
    learned_on: str  # the run of the figures
    # compliance of the drive by joint, as others found it there
    microrad_per_nm: dict[int, Positive] = Field(min_length=1)


class Reference(Strict):
    """reference.yaml."""

    source: str
    runs: tuple[ReferenceRun, ...] = Field(min_length=1)
    transfers: tuple[ReferenceTransfer, ...] = ()
    compliances: ReferenceCompliances | None = None


def load_reference(path: Path | str) -> Reference:
    """Read reference.yaml. Raises InputError: it says something that can't be."""
    return load(Reference, path)
