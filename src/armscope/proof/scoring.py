"""Answers against truths: one table of cases each for worlds, concealed effects, names given and numbers fitted."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from armscope.proof.answers import Answer, NamedEffect
from armscope.proof.definitions import HELD_OUT_TOLERANCE, NEAR_ORACLE, ROUGH, Name, place
from armscope.proof.intervals import compare_numbers
from armscope.proof.matching import Match, distinct, effect_row, match, name_row, outside_outcome
from armscope.proof.oracle import power, size_in_thresholds
from armscope.proof.rough import rough_scores
from armscope.proof.truth import Concealed, Truth
from armscope.recordings.columns import AXES_MM
from armscope.verdict.effects import UNKNOWN

CANNOT_TELL, NOTHING = "cannot tell", "nothing"
_COMMON = ("world", "category", "fresh", "weakest")
COLUMNS: dict[str, tuple[str, ...]] = {
    "worlds": (
        *_COMMON, "arm", "rows", "sigma_mm", "masses", "noise", "left_out", "shape", "concealed", "said", "answer",
        "mismatch", "silent", "exact", "exact_story", "missed", "wrong_names", "outside", "outside_right",
        "held_out_ratio", "price_of_fitting", "held_out_close", "to_oracle", "near_oracle", "noise_ratio", "failed",
        "rough", "causes", "first", "overclaimed", "major_names", "absurd", "right", "tellable",
    ),
    "effects": (
        *_COMMON, "effect", "location", "shape", "driver", "minor", "strength", "noncentrality", "columns",
        "frame_numbers", "rows", "oracle_power", "size_in_thresholds", "seen", "outcome", "right", "ambiguous",
        "among_all", "said_effect", "said_location", "said_driver", "driver_right", "oracle_nats", "tellable",
    ),
    "names": (
        *_COMMON, "effect", "location", "minor", "named_as", "evidence_nats", "rms_mm", "right", "effect_right",
    ),
    "intervals": (
        *_COMMON, "effect", "location", "minor", "strength", "parameter", "unit", "true", "fitted", "stderr", "covered",
        "right",
    ),
    "pairs": (*_COMMON, "true", "said"),
}  # fmt: skip
"""What the tables of cases hold; `weakest` is the smallest strength of the world's story."""
REAL = "real"


@dataclass(frozen=True, eq=False)
class World:
    """A world unsealed beside the answer it got."""

    truth: Truth
    answer: Answer
    times: pd.Series | None = None  # the recorded `time_s`, where there are any
    runs: int = 1  # recorded runs, each with a base frame of its own

    @property
    def price_of_fitting(self) -> float:
        """Held-out ratio of one who knows every effect and fits its numbers and the frames; see `definitions`."""
        numbers = 6 * self.runs + 3 + sum(effect.columns for effect in self.truth.story)
        return float(np.sqrt(1 + numbers / (3 * self.truth.rows)))


@dataclass(frozen=True, eq=False)
class Cases:
    """What all rates are counted from; columns as in `COLUMNS`."""

    worlds: pd.DataFrame
    effects: pd.DataFrame
    names: pd.DataFrame
    intervals: pd.DataFrame
    pairs: pd.DataFrame

    def tables(self) -> dict[str, pd.DataFrame]:
        """By name."""
        return vars(self)


def score(worlds: Iterable[World]) -> Cases:
    """Score every world."""
    rows: dict[str, list[dict[str, object]]] = {name: [] for name in COLUMNS}
    for world in worlds:
        claims = distinct(world.answer.claims)
        matches, left = match(world.truth.effects, claims)
        common = {
            "world": world.truth.world,
            "category": world.truth.category,
            "fresh": world.truth.fresh,
            "weakest": min((effect.strength for effect in world.truth.story), default=float("nan")),
        }
        rows["worlds"].append(common | _world(world, claims, matches, left))
        rows["effects"] += [common | _effect(world, m, claims) for m in matches]
        rows["names"] += [common | name_row(world.truth.effects, claim, claim not in left) for claim in claims]
        rows["intervals"] += [common | number for m in matches for number in _numbers(world, m)]
        rows["pairs"] += [common | {"true": true, "said": said} for true, said in _pairs(matches, left)]
    return Cases(**{name: pd.DataFrame(found, columns=list(COLUMNS[name])) for name, found in rows.items()})


def _world(
    world: World, claims: Sequence[NamedEffect], matches: Sequence[Match], left: Sequence[NamedEffect]
) -> dict[str, object]:
    truth, answer = world.truth, world.answer
    story = [m for m in matches if not m.truth.minor]
    unmatched, left = left, [claim for claim in left if claim.name not in truth.also_allowed]
    wrong = [claim for claim in left if truth.category not in (REAL, *ROUGH) or claim.effect != UNKNOWN]
    all_right = not answer.failed and all(m.right for m in story)
    ratio = held_out_ratio(truth, answer)
    outside = _outside(answer, matches, unmatched) if truth.outside else ""
    return rough_scores(truth, answer, matches, wrong) | {
        "arm": truth.arm,
        "rows": truth.rows,
        "sigma_mm": truth.sigma_mm,
        "masses": truth.masses,
        "noise": truth.noise,
        "left_out": " ".join(truth.left_out),
        "shape": " ".join(effect.shape for effect in truth.story if effect.shape),
        "concealed": names_in_a_cell([(e.effect, e.location) for e in truth.story]),
        "said": names_in_a_cell([claim.name for claim in claims]),
        "answer": answer.answer,
        "mismatch": answer.mismatch,
        "silent": not answer.failed and not claims and not answer.mismatch,
        "exact": all_right and not wrong,
        "exact_story": all_right and not [claim for claim in wrong if not claim.minor],
        "missed": sum(not m.right for m in story),
        "wrong_names": sum(claim.effect != UNKNOWN for claim in left),
        "outside": outside,
        "outside_right": outside in ("located", "acceptable") if truth.outside else None,
        "held_out_ratio": ratio,
        "price_of_fitting": world.price_of_fitting,
        "held_out_close": bool(ratio <= HELD_OUT_TOLERANCE),
        "to_oracle": ratio * truth.true_rms_mm / truth.oracle_mm,
        "near_oracle": bool(ratio * truth.true_rms_mm <= NEAR_ORACLE * truth.oracle_mm),
        "noise_ratio": answer.noise_mm / truth.noise_rms_mm,
        "failed": answer.failed,
        "rough": " ".join(truth.rough),
    }


def names_in_a_cell(names: Sequence[Name]) -> str:
    """Names in one cell of a table."""
    return "; ".join(f"{effect} {location}" for effect, location in names)


def held_out_ratio(truth: Truth, answer: Answer) -> float:
    """RMS per axis of predicted minus measured test rows, in multiples of the true model's; infinite if failed."""
    if answer.predicted is None:
        return float("inf")
    off = answer.predicted[AXES_MM].to_numpy() - truth.test[AXES_MM].to_numpy()
    return float(np.sqrt(np.mean(off**2)) / truth.true_rms_mm)


def _outside(answer: Answer, matches: Sequence[Match], left: Sequence[NamedEffect]) -> str:
    """As `outside_outcome`, of a diagnosis that may have failed, or say that it cannot tell."""
    if answer.failed:
        return "failed"
    found = outside_outcome(matches, left, bool(answer.claims))
    return CANNOT_TELL if found == "missed" and answer.answer == CANNOT_TELL else found


def _effect(world: World, found: Match, claims: Sequence[NamedEffect]) -> dict[str, object]:
    truth, rows, claim = found.truth, world.truth.rows, found.claim
    tested = np.isfinite(truth.noncentrality) and truth.columns > 0
    test = truth.noncentrality, truth.columns, rows, truth.frame_numbers
    return effect_row(found, claims) | {
        "noncentrality": truth.noncentrality,
        "columns": truth.columns,
        "frame_numbers": truth.frame_numbers,
        "rows": rows,
        "oracle_power": power(*test) if tested else float("nan"),
        "size_in_thresholds": size_in_thresholds(*test) if tested else float("nan"),
        "seen": bool(world.answer.mismatch),
        "ambiguous": bool(truth.alternatives) or (world.truth.category == "inseparable" and not truth.minor),
        "driver_right": claim is not None and same_driver(truth, claim),
        "oracle_nats": truth.oracle_nats,
        "tellable": truth.tellable,
    }


def same_driver(truth: Concealed, claim: NamedEffect) -> bool:
    """Whether a claim follows what the concealed effect follows."""
    words = {
        "joint angle": ("angle",), "gravity load": ("load", "gravity", "moment"), "side of approach": ("approach",),
        "time": ("time", "row"), "temperature": ("temperature", "warm"), "speed": ("speed",), "payload": ("payload",),
        "constant": ("constant",),
    }  # fmt: skip
    return any(word in claim.driver for word in words[truth.driver])


def _numbers(world: World, found: Match) -> list[dict[str, object]]:
    if found.outcome != "named" or not found.truth.comparable or found.truth.effect == UNKNOWN:
        return []
    claims = [claim for claim in world.answer.claims if claim.name == found.truth.name]
    return [
        {"effect": found.truth.effect, "location": found.truth.location, "minor": found.truth.minor}
        | {"strength": found.truth.strength}
        | vars(number)
        for number in compare_numbers(found.truth, claims, world.times)
    ]


def _pairs(matches: Sequence[Match], left: Sequence[NamedEffect]) -> list[tuple[str, str]]:
    """(true effect, effect said) for the confusion matrix; what is left over on either side pairs with `nothing`."""
    waiting = list(left)
    pairs = []
    for found in matches:
        if found.truth.minor:
            continue
        if found.right:
            pairs.append((found.truth.effect, found.truth.effect))
            continue
        near = [claim for claim in waiting if place(claim.location) == place(found.truth.location)] or waiting
        pairs.append((found.truth.effect, near[0].effect if near else NOTHING))
        waiting = [claim for claim in waiting if not near or claim is not near[0]]
    pairs += [(NOTHING, claim.effect) for claim in waiting]
    return pairs or [(NOTHING, NOTHING)]
