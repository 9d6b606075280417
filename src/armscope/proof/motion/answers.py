"""What the diagnosis answered about a moving world: verdict.json and the predicted torques of the test path."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from armscope.core.files import read_json, read_table
from armscope.proof.answers import FAILURE, NamedEffect
from armscope.proof.definitions import Name
from armscope.proof.matching import UNKNOWN

VERDICT, PREDICTED = "verdict.json", "test_predicted.csv"
KEPT = (VERDICT, "model.yaml", PREDICTED)
Numbers = dict[str, tuple[float, float, str]]


@dataclass(frozen=True, eq=False)
class MotionAnswer:
    """A verdict on a motion; ``failed`` holds the reason where there is none.

    Attributes:
        world: whose.
        claims: its causes, one per name, and what it calls unknown.
        mismatch, answer: as in verdict.json.
        background: ordinary friction and rotors by joint: (value, standard error, unit) by name.
        predicted: torques of the test path.
    """

    world: str
    claims: tuple[NamedEffect, ...] = ()
    mismatch: bool | None = None
    answer: str = "failed"
    background: tuple[tuple[str, Numbers], ...] = ()
    predicted: pd.DataFrame | None = None
    failed: str = ""


def read_answer(folder: Path) -> MotionAnswer:
    """The answer in a world's folder of the diagnosing job."""
    if (folder / FAILURE).is_file():
        return MotionAnswer(folder.name, failed=(folder / FAILURE).read_text(encoding="utf-8").strip())
    verdict = read_json(folder / VERDICT, "the verdict of a moving world")
    return MotionAnswer(
        world=folder.name,
        claims=tuple(_claims(verdict)),
        mismatch=verdict["mismatch"],
        answer=verdict["answer"],
        background=tuple((joint["joint"], _numbers(joint["parameters"])) for joint in verdict.get("background", [])),
        predicted=read_table(folder / PREDICTED),
    )


def _claims(verdict: dict[str, Any]) -> list[NamedEffect]:
    """One per name, minor only if all of that name are; structure without a cause counts as `unknown`."""
    by_name: dict[Name, NamedEffect] = {}
    for effect in sorted(verdict["effects"], key=lambda effect: bool(effect.get("minor"))):
        by_name.setdefault((effect["effect"], effect["location"]), _claim(effect))
    left = verdict["unexplained"]
    if left["present"] and left.get("location"):
        unknown = {"effect": UNKNOWN, "location": left["location"], "driver": left.get("driver")}
        by_name.setdefault((UNKNOWN, left["location"]), _claim(unknown))
    return list(by_name.values())


def _claim(effect: dict[str, Any]) -> NamedEffect:
    return NamedEffect(
        effect=effect["effect"],
        location=effect["location"],
        driver=effect.get("driver") or "",
        minor=bool(effect.get("minor")),
        named_as=effect.get("named_as", "effect"),
        rms_mm=float("nan"),  # of positions only
        evidence_nats=effect.get("evidence_nats", float("nan")),
        parameters=_numbers(effect.get("parameters", [])),
        alternatives=tuple((other["effect"], other["location"]) for other in effect.get("alternatives", [])),
    )


def _numbers(parameters: list[dict[str, Any]]) -> Numbers:
    return {each["name"]: (each["value"], each["stderr"], each["unit"]) for each in parameters}
