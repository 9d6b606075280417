"""Whether fitted numbers hold the true ones: 95 % intervals, and scanned numbers that have none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from armscope.proof.answers import NamedEffect
from armscope.proof.truth import Concealed
from armscope.verdict.effects import INTERVAL

SCANNED = ("per_turn", "time")


@dataclass(frozen=True)
class Compared:
    """One number of an effect: ``covered`` is None for a scanned number, ``right`` is None for one with an interval."""

    parameter: str
    unit: str
    true: float
    fitted: float
    stderr: float
    covered: bool | None
    right: bool | None


def compare_numbers(truth: Concealed, claims: Sequence[NamedEffect], times: pd.Series | None) -> list[Compared]:
    """The numbers of a concealed effect beside those of the claims under its own name.

    Args:
        truth: the concealed effect.
        claims: every claim of that name (several waves or jumps); the one whose scanned number is nearest is taken.
        times: recorded `time_s` (a jump is right if no recorded row lies between the true and the found time).

    Returns:
        One per number of the effect: true, claimed, standard error, and whether the interval holds it.
    """
    true = {name: value for name, (value, _) in truth.parameters.items()}
    claim = min(claims, key=lambda claim: _scanned_apart(true, claim))
    fitted = {name: value for name, (value, _, _) in claim.parameters.items()}
    true = _same_motion(true, fitted)
    found = []
    for name, (_, unit) in truth.parameters.items():
        if name not in claim.parameters:
            continue
        value, stderr, _ = claim.parameters[name]
        covered = right = None
        if name in SCANNED:
            right = _between(times, true[name], value) if name == "time" else value == true[name]
        else:
            covered = bool(abs(value - true[name]) <= INTERVAL * stderr)
        found.append(Compared(name, unit, true[name], value, stderr, covered, right))
    return found


def _scanned_apart(true: dict[str, float], claim: NamedEffect) -> float:
    return sum(
        abs(claim.parameters[name][0] - true[name]) for name in SCANNED if name in true and name in claim.parameters
    )


def _between(times: pd.Series | None, true: float, found: float) -> bool:
    """Whether the same recorded rows lie after both times; the found time may be a row's own."""
    if times is None:
        return False
    low, high = min(true, found), max(true, found)
    return not bool(((times > low) & (times < high)).any())


def _same_motion(true: dict[str, float], fitted: dict[str, float]) -> dict[str, float]:
    """The true numbers, written so that angles come as near as possible to the fitted ones.

    amplitude cos(k q - phase) about (cos direction, sin direction) stays the same if phase and direction both turn
    by pi, or either by 2 pi; a negative amplitude is a phase turned by pi.
    """
    if "phase" not in true or "phase" not in fitted:
        return true
    same = dict(true)
    if same["amplitude"] < 0:
        same["amplitude"], same["phase"] = -same["amplitude"], same["phase"] + np.pi
    if "direction" in same and "direction" in fitted:
        turns = round((fitted["direction"] - same["direction"]) / np.pi)
        same["direction"] += turns * np.pi
        same["phase"] += turns * np.pi
    same["phase"] += 2 * np.pi * round((fitted["phase"] - same["phase"]) / (2 * np.pi))
    return same
