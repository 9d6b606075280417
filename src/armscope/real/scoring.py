"""Concealment on real recordings, unsealed and scored: what was found beyond what the original's verdict says already.

**Changed.** A real arm has errors of its own, so a name counts only for what is new in it: a name of the altered
recordings' verdict is changed if the original's verdict does not have it (for waves and jumps: not that number of
waves, not that row), or if what it does at the tool differs by at least half of what was planted (its number, where
the effect has only one).

**Outcome** of a planted effect: `named` (its own name, changed), `acceptable` (a sealed alternative, changed: as good
in these poses within 5 nats of evidence), `listed` (its name among the alternatives of a changed one), `located`
(another changed name, or `unknown`, at its place), `missed`. Found are the first two.

**Size.** The altered verdict's number is held against the planted one plus what the original's verdict gives under that
name (nothing where it does not name it, though the arm may have some: coverage then falls short of 95 %).

**New names** are names that neither the original's verdict has nor the planted effect explains: false alarms that the
planted effect caused. **Unheard of** are those of them that the original's verdict does not list as an alternative of
its own names either: the others are one of two answers that it said cannot be told apart.

**Twins.** Where both halves draw the same place and numbers, the recordings are the same: they count once in both
halves together.

**Held out.** RMS of the 3D distance on the 30 % of the configurations that nobody saw: `floor`, what the original's
model leaves of the original readings; `without`, the same with what the planted effect adds there beyond the frames;
`with`, what the altered verdict's model leaves of the altered readings. Recovered = (without^2 - with^2) / planted^2,
where planted is what the effect alone adds there beyond the frames.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from armscope.core.averages import rms_distance
from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.physics.elastic import JOINT_COMPLIANCE
from armscope.proof.answers import Answer, NamedEffect, read_answer
from armscope.proof.definitions import place
from armscope.proof.intervals import Compared, compare_numbers
from armscope.proof.reading import sealed_batches
from armscope.proof.scoring import names_in_a_cell
from armscope.proof.truth import Concealed, unsealed
from armscope.real.constants import CONCEALING
from armscope.real.making import LEFT_MM
from armscope.recordings.columns import AXES_MM
from armscope.verdict.effects import UNKNOWN

JUMP, ROW = "jump_between_ids", "row"
LOAD_WORDS = ("load", "gravity", "moment", "torque")


@dataclass(frozen=True, eq=False)
class Sealed:
    """A world as sealed and as answered."""

    set: str
    part: str
    truth: dict[str, Any]
    readings: pd.DataFrame
    answer: Answer


@dataclass(frozen=True, eq=False)
class Scores:
    """Tables of cases: planted effects, their numbers, withheld columns, and what could not be planted."""

    cases: pd.DataFrame
    numbers: pd.DataFrame
    withheld: pd.DataFrame
    skipped: pd.DataFrame


def read_sealed(folder: Path) -> Iterator[Sealed]:
    """Every world of the concealment with its answer. Raises InputError: a diagnosing job could see more than it
    may."""
    for batch, archive in sealed_batches(folder):
        name, _, part = batch.rpartition("-")
        for world, (truth, readings) in sorted(unsealed(archive).items()):
            yield Sealed(name, part, truth, readings, read_answer(folder / "verdicts" / batch / world))


def score(worlds: Sequence[Sealed]) -> Scores:
    """Score every world against its arm's original. Raises InputError: an arm without its original."""
    originals = {world.set: world for world in worlds if world.truth["kind"] == "original"}
    cases, numbers, skipped = [], [], {}
    drawn: set[tuple[str, str]] = set()
    for world in worlds:
        if world.truth["kind"] != "altered":
            continue
        if world.set not in originals:
            raise InputError("sealed", world.set, "no original", "altered recordings are compared with the original's")
        case, compared = _case(world, originals[world.set])
        planted = world.set, str([world.truth[key] for key in ("effect", "location", "parameters")])
        case["twin"] = planted in drawn
        drawn.add(planted)
        cases.append(case)
        numbers += [
            {key: case[key] for key in ("set", "half", "effect", "location", "size", "twin")} | vars(c)
            for c in compared
        ]
        for each in world.truth["skipped"]:
            skipped[world.set, each["effect"], each["size"], world.part] = each["reason"]
    gone = [(*key, reason) for key, reason in sorted(skipped.items())]
    loads = [_withheld(world) for world in worlds if world.truth["kind"] == "withheld"]
    return Scores(
        pd.DataFrame(cases),
        pd.DataFrame(numbers),
        pd.DataFrame(loads),
        pd.DataFrame(gone, columns=["set", "effect", "size", "half", "reason"]),
    )


def _case(world: Sealed, original: Sealed) -> tuple[dict[str, Any], list[Compared]]:
    truth = _concealed(world.truth)
    before, now = original.answer.claims, world.answer.claims
    outcome, claim = _outcome(truth, world.truth, now, before)
    explained = {truth.name, *truth.alternatives}
    had = {each.name for each in before}
    new = [c for c in now if c.effect != UNKNOWN and c.name not in explained and c.name not in had]
    heard_of = had.union(*(each.alternatives for each in before))
    compared = _numbers(truth, world.truth, now, before) if outcome == "named" else []
    case = {
        "set": world.set,
        "half": world.part,
        "world": world.answer.world,
        "effect": truth.effect,
        "location": truth.location,
        "size": truth.strength,
        "planted_mm": world.truth["rms_mm"],
        "level_mm": world.truth["level_mm"],
        "alternatives": names_in_a_cell(truth.alternatives),
        "outcome": outcome,
        "found": outcome in ("named", "acceptable"),
        "right_place": outcome != "missed",
        "said": "" if claim is None else f"{claim.effect} {claim.location}",
        "size_ratio": _size_ratio(compared),
        "row_right": any(_in_jump(world.truth, claim) for claim in now if claim.name == truth.name)
        if JUMP in world.truth and outcome == "named"
        else None,
        "had_it_before": truth.name in had,
        "new_names": len({each.name for each in new}),
        "new": names_in_a_cell(sorted({each.name for each in new})),
        "unheard_of": len({each.name for each in new} - heard_of),
        "lost": names_in_a_cell(sorted(had - {each.name for each in now})),
        "failed": world.answer.failed,
    }
    return case | _held_out(world, original), compared


def _concealed(content: dict[str, Any]) -> Concealed:
    return Concealed(
        effect=content["effect"],
        location=content["location"],
        driver=content["driver"],
        minor=False,
        strength=content["size"],
        parameters={p["name"]: (p["value"], p["unit"]) for p in content["parameters"]},
        comparable=True,
        noncentrality=content["noncentrality"],
        columns=0,
        frame_numbers=0,
        alternatives=tuple((effect, location) for effect, location in content["alternatives"]),
    )


def _outcome(
    truth: Concealed, content: dict[str, Any], now: Sequence[NamedEffect], before: Sequence[NamedEffect]
) -> tuple[str, NamedEffect | None]:
    changed = [claim for claim in now if _changed(claim, truth, content, before)]
    for outcome, fits in (
        ("named", lambda claim: claim.name == truth.name),
        ("acceptable", lambda claim: claim.name in truth.alternatives),
        ("listed", lambda claim: truth.name in claim.alternatives),
        ("located", lambda claim: place(claim.location) == place(truth.location)),
    ):
        found = [claim for claim in changed if fits(claim)]
        if found:
            return outcome, max(found, key=lambda claim: claim.rms_mm)
    return "missed", None


def _changed(claim: NamedEffect, truth: Concealed, content: dict[str, Any], before: Sequence[NamedEffect]) -> bool:
    same = [each for each in before if each.name == claim.name and _scanned(each) == _scanned(claim)]
    if not same:
        return True
    if claim.name == truth.name and len(truth.parameters) == 1:
        ((name, (planted, _)),) = truth.parameters.items()
        # with masses unknown a drive's compliance is told as other numbers
        if name in claim.parameters and name in same[0].parameters:
            step = claim.parameters[name][0] - same[0].parameters[name][0]
            return step / planted >= CONCEALING.changed
    return bool(abs(claim.rms_mm**2 - same[0].rms_mm ** 2) >= (CONCEALING.changed * content["rms_mm"]) ** 2)


def _scanned(claim: NamedEffect) -> tuple[float, ...]:
    return tuple(claim.parameters[name][0] for name in ("per_turn", ROW, "time") if name in claim.parameters)


def _numbers(
    truth: Concealed, content: dict[str, Any], now: Sequence[NamedEffect], before: Sequence[NamedEffect]
) -> list[Compared]:
    """The planted numbers, on top of the original's under the same name, beside the altered verdict's."""
    claims = [claim for claim in now if claim.name == truth.name]
    if JUMP in content:
        claims = [claim for claim in claims if _in_jump(content, claim)] or claims
    same = [each for each in before if each.name == truth.name and _scanned(each) in map(_scanned, claims)]
    expected = dict(truth.parameters)
    if same and "phase" not in expected:
        for name, (value, unit) in expected.items():
            if name in same[0].parameters:
                expected[name] = (value + same[0].parameters[name][0], unit)
    elif same:
        expected = _waves_together(expected, same[0])
    return compare_numbers(replace(truth, parameters=expected), claims, None)


def _waves_together(planted: dict[str, tuple[float, str]], own: NamedEffect) -> dict[str, tuple[float, str]]:
    """Amplitude and phase of the planted wave and the arm's own of the same count."""
    wave = planted["amplitude"][0] * np.exp(1j * planted["phase"][0])
    wave += own.parameters["amplitude"][0] * np.exp(1j * own.parameters["phase"][0])
    return planted | {"amplitude": (float(abs(wave)), "rad"), "phase": (float(np.angle(wave)), "rad")}


def _in_jump(content: dict[str, Any], claim: NamedEffect) -> bool:
    low, high = content[JUMP]
    return ROW in claim.parameters and low < claim.parameters[ROW][0] <= high


def _size_ratio(compared: Sequence[Compared]) -> float:
    """Fitted over true size, of effects with several numbers along the true one (mm and mrad weigh alike)."""
    sized = [c for c in compared if c.covered is not None and c.parameter != "phase"]
    if not sized:
        return float("nan")
    weight = np.array([1e3 if c.unit.startswith("rad") else 1.0 for c in sized])
    true, fitted = (np.array([getattr(c, name) for c in sized]) * weight for name in ("true", "fitted"))
    return float(fitted @ true / (true @ true))


def _held_out(world: Sealed, original: Sealed) -> dict[str, float]:
    if world.answer.predicted is None or original.answer.predicted is None:
        return {}
    own, left = _missed(original), world.readings[LEFT_MM].to_numpy()
    floor, without, found = rms_distance(own), rms_distance(own + left), rms_distance(_missed(world))
    share = (without**2 - found**2) / rms_distance(left) ** 2
    return {"floor_mm": floor, "without_mm": without, "with_mm": found, "recovered": share}


def _missed(world: Sealed) -> Array:
    assert world.answer.predicted is not None
    return np.asarray(world.readings[AXES_MM].to_numpy() - world.answer.predicted[AXES_MM].to_numpy())


def _withheld(world: Sealed) -> dict[str, Any]:
    """What is still said about giving way under load where columns are missing."""
    loaded = [c for c in world.answer.claims if any(word in c.driver for word in LOAD_WORDS)]
    compliant = [c for c in loaded if c.effect == JOINT_COMPLIANCE.name]
    return {
        "set": world.set,
        "rows": world.truth["rows"],
        "withheld": world.truth["withheld"],
        "orientations": world.truth["orientations"],
        "load_found": bool(loaded),
        "compliance_found": bool(compliant),
        "follows_load": names_in_a_cell([c.name for c in loaded]),
        "all_names": names_in_a_cell([c.name for c in world.answer.claims]),
        "background_mm": world.answer.background_mm,
        "load_rms_mm": float(np.sqrt(sum(c.rms_mm**2 for c in loaded))),
        "held_out_mm": rms_distance(_missed(world)) if world.answer.predicted is not None else float("nan"),
        "failed": world.answer.failed,
    }
