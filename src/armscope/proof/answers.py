"""What the diagnosis answered, as scoring reads it: verdict.json and the predicted test rows of a world."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from armscope.core.files import read_json, read_table
from armscope.core.inputs import InputError, mapping
from armscope.proof.definitions import Name

VERDICT, PREDICTED, FAILURE, TIMES = "verdict.json", "test_predicted.csv", "failed.txt", "times.csv"
WHAT = "verdict.json of a diagnosis"


@dataclass(frozen=True)
class Claim:
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
    claims: tuple[Claim, ...] = ()
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
    path = folder / VERDICT
    content = mapping(read_json(path, WHAT), path, WHAT)
    try:
        return _answer(folder, content)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        missing = f"no {error}" if isinstance(error, KeyError) else str(error)
        raise InputError(path, "", missing, f"this is not {WHAT}", "Was the file edited?") from error


def _answer(folder: Path, content: dict[str, Any]) -> Answer:
    return Answer(
        world=folder.name,
        claims=tuple(_claim(effect) for effect in content["effects"]),
        mismatch=content["mismatch"],
        answer=content["answer"],
        noise_mm=float("nan") if content["noise_mm"] is None else content["noise_mm"],
        headline=content["headline"],
        background_mm=float(content.get("background", {}).get("rms_at_tool_mm") or 0.0),
        predicted=read_table(folder / PREDICTED),
    )


def _claim(content: dict[str, Any]) -> Claim:
    return Claim(
        effect=content["effect"],
        location=content["location"],
        driver=content["driver"],
        minor=content["minor"],
        named_as=content["named_as"],
        rms_mm=content["rms_at_tool_mm"],
        evidence_nats=content["evidence_nats"],
        parameters={
            p["name"]: (p["value"], float("nan") if p["stderr"] is None else p["stderr"], p["unit"])
            for p in content["parameters"]
        },
        alternatives=tuple((a["effect"], a["location"]) for a in content["alternatives"]),
    )
