"""What the diagnosis answered, as scoring reads it: verdict.json and the predicted test rows of a world."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from armscope.core.files import read_table
from armscope.proof.definitions import Name
from armscope.verdict.effects import FoundEffect
from armscope.verdict.files import VERDICT, read_verdict

PREDICTED, FAILURE = "test_predicted.csv", "failed.txt"


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
    parameters: dict[str, tuple[float, float, str]]
    alternatives: tuple[Name, ...]

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
        claims=tuple(claim_of(effect) for effect in verdict.effects),
        mismatch=verdict.mismatch,
        answer=verdict.answer,
        noise_mm=verdict.noise_mm,
        headline=verdict.headline,
        background_mm=verdict.background.rms_at_tool_mm,
        predicted=read_table(folder / PREDICTED),
    )


def claim_of(effect: FoundEffect) -> NamedEffect:
    """An effect of a verdict as scoring reads it."""
    return NamedEffect(
        effect=effect.effect,
        location=effect.location,
        driver=effect.driver,
        minor=effect.minor,
        named_as=effect.named_as,
        rms_mm=effect.rms_at_tool_mm,
        evidence_nats=effect.evidence_nats,
        parameters={p.name: (p.value, p.stderr, p.unit) for p in effect.parameters},
        alternatives=tuple((other.effect, other.location) for other in effect.alternatives),
    )
