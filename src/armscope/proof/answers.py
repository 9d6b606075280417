"""What the diagnosis answered, as scoring reads it: verdict.json and the predicted test rows of a world."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from armscope.core.files import read_table
from armscope.motion.verdict import FoundCause
from armscope.proof.definitions import Name
from armscope.verdict.effects import FoundEffect, Parameter
from armscope.verdict.filenames import VERDICT
from armscope.verdict.files import read_verdict

PREDICTED, FAILURE = "test_predicted.csv", "failed.txt"
Numbers = dict[str, tuple[float, float, str]]  # Value, standard error and unit by name


def numbers_of(parameters: Iterable[Parameter]) -> Numbers:
    """Fitted numbers by name."""
    return {each.name: (each.value, each.stderr, each.unit) for each in parameters}


@dataclass(frozen=True)
class NamedEffect:
    """An effect of a verdict; ``parameters`` are (value, standard error, unit) by name, file units."""

    effect: str
    location: str
    driver: str
    minor: bool
    named_as: str
    rms_mm: float
    evidence_nats: float
    parameters: Numbers
    alternatives: tuple[Name, ...]

    @staticmethod
    def of(effect: FoundEffect | FoundCause) -> NamedEffect:
        """An effect of a verdict on positions, or on a motion (which has no size at the tool), as scoring reads it."""
        known, rms = (
            (effect.named_as, effect.rms_at_tool_mm) if isinstance(effect, FoundEffect) else ("effect", math.nan)
        )
        return NamedEffect(
            effect=effect.effect,
            location=effect.location,
            driver=effect.driver,
            minor=effect.minor,
            named_as=known,
            rms_mm=rms,
            evidence_nats=effect.evidence_nats,
            parameters=numbers_of(effect.parameters),
            alternatives=tuple((other.effect, other.location) for other in effect.alternatives),
        )

    @property
    def name(self) -> Name:
        """(effect, location)."""
        return self.effect, self.location


@dataclass(frozen=True, eq=False)
class Answer:
    """A verdict; ``failed`` holds the reason where there is none.

    ``background_mm``: what the small errors everywhere, which have no name, do at the tool.
    """

    world: str
    claims: tuple[NamedEffect, ...] = ()
    mismatch: bool | None = None
    answer: str = "failed"
    noise_mm: float = float("nan")
    headline: str = ""
    predicted: pd.DataFrame | None = None
    failed: str = ""
    background_mm: float = 0.0


def read_answer(folder: Path) -> Answer:
    """The answer in a world's folder of the diagnosing job."""
    failure = folder / FAILURE
    if failure.is_file():
        return Answer(folder.name, failed=failure.read_text(encoding="utf-8").strip())
    verdict = read_verdict(folder / VERDICT)
    return Answer(
        world=folder.name,
        claims=tuple(map(NamedEffect.of, verdict.effects)),
        mismatch=verdict.mismatch,
        answer=verdict.answer,
        noise_mm=verdict.noise_mm,
        headline=verdict.headline,
        background_mm=verdict.background.rms_at_tool_mm,
        predicted=read_table(folder / PREDICTED),
    )
