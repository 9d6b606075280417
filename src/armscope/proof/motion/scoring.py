"""Answers about moving worlds against truths: tables of cases, rates with exact intervals, aims.

Names are right, acceptable or wrong, and worlds exact, as `armscope.proof.definitions` has them for positions. Beyond
that: a cause that the name of another concealed one says as well need not be named, and is no wrong name; a clean
world is silent if nothing is named and nothing called unknown; ordinary friction and rotors, which every arm has, and
zeros of links' encoders are no names, but their intervals count where nothing is concealed at their joint;
the held-out ratio is the RMS of measured minus predicted torque on a path nobody has seen, each joint in units of what
the truth itself leaves there (noise, and what the drives' filter rounds off). Where a joint stands its friction is
whatever holds it, within a band, and no motion predicts it: `held_out_moving` is the same ratio without those
readings, as verdicts count their own errors.

**Rough arms** have small errors of every kind, all of them true names (masses of every link, friction of every joint),
and break what a diagnosis assumes; upon that, no to two causes stand out, each twice or more as large as noise and all
of those together. The answer is right if every cause is named, the first name is a cause's or of something as large,
and nothing is named that isn't there; an `unknown` is never wrong. The truth that the held-out ratio divides by knows
all small errors; nobody else can.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from armscope.core.location import Location
from armscope.proof.answers import NamedEffect
from armscope.proof.definitions import AS_LARGE, Aim, category, clear, place
from armscope.proof.matching import Match, effect_row, match, name_row, outside_outcome
from armscope.proof.motion.answers import MotionAnswer
from armscope.proof.motion.truth import MotionTruth
from armscope.verdict.effects import INTERVAL, UNKNOWN


def rough_scores(
    truth: MotionTruth, answer: MotionAnswer, matches: Sequence[Match], left: Sequence[NamedEffect]
) -> dict[str, object]:
    """How a verdict fares on an arm that has small errors everywhere; of other arms it says nothing.

    Args:
        truth: of the arm.
        answer: the verdict.
        matches: concealed causes and what is rough, with the claims that stand for them.
        left: claims that stand for nothing there is.

    Returns:
        first (None without a cause), nothing_false, major_names and right, all by the definitions.
    """
    if truth.category != "rough":
        return {}
    first = _first_is_true(answer, matches, truth) if truth.effects else None
    false = [claim for claim in left if claim.effect != UNKNOWN]
    asked = [found for found in matches if not found.truth.minor]
    return {
        "first": first,
        "nothing_false": not answer.failed and not false,
        "major_names": sum(not claim.minor and claim.effect != UNKNOWN for claim in answer.claims),
        "right": not answer.failed and not false and first is not False and all(found.right for found in asked),
    }


def _first_is_true(answer: MotionAnswer, matches: Sequence[Match], truth: MotionTruth) -> bool:
    """Whether the first name, which is the largest, is a cause's or of something as large."""
    names = [claim for claim in answer.claims if claim.effect != UNKNOWN]
    stands_for = [found.truth for found in matches if names and found.right and found.claim is names[0]]
    largest = max(cause.strength for cause in truth.effects)
    return any(not each.minor or each.strength >= AS_LARGE * largest for each in stands_for)


Row = dict[str, object]
COMMON = ("world", "category", "arm", "fresh", "weakest")
COLUMNS = {
    "worlds": (*COMMON, "stated", "rows", "concealed", "said", "answer", "mismatch", "silent", "exact", "missed",
               "wrong_names", "outside", "outside_right", "held_out_ratio", "held_out_moving",
               "first", "nothing_false", "major_names", "right", "failed", "not_predicted"),
    "effects": (*COMMON, "effect", "location", "shape", "strength", "outcome", "right", "ambiguous", "among_all",
                "said_effect", "said_location"),
    "names": (*COMMON, "effect", "location", "minor", "evidence_nats", "right", "effect_right"),
    "intervals": (*COMMON, "effect", "location", "parameter", "unit", "true", "fitted", "stderr", "covered"),
}  # fmt: skip
ENOUGH_PREDICTED = 0.8  # Share of the test path that must have a prediction: filters lose the ends
ORDINARY = "ordinary"


@dataclass(frozen=True, eq=False)
class MotionWorld:
    """A world unsealed beside the answer it got."""

    truth: MotionTruth
    answer: MotionAnswer


def score(worlds: Iterable[MotionWorld]) -> dict[str, pd.DataFrame]:
    """Tables of cases by name, with `COLUMNS`."""
    rows: dict[str, list[Row]] = {name: [] for name in COLUMNS}
    for world in worlds:
        truth, claims = world.truth, world.answer.claims
        both, left = match((*truth.effects, *truth.rough), claims)
        matches, left = both[: len(truth.effects)], [each for each in left if each.name not in truth.also_allowed]
        common: Row = {"world": truth.world, "category": truth.category, "arm": truth.arm, "fresh": truth.fresh}
        common["weakest"] = min((each.strength for each in truth.effects if not each.minor), default=float("nan"))
        rows["worlds"].append(common | _world(world, matches, left) | rough_scores(truth, world.answer, both, left))
        rows["effects"] += [common | effect_row(found, claims) for found in matches if _is_asked_for(found)]
        rows["names"] += [
            common | name_row((*truth.effects, *truth.rough), claim, claim not in left)
            for claim in claims
            if claim.effect != UNKNOWN
        ]
        rows["intervals"] += [common | number for number in [*_numbers(matches), *_ordinary(world), *_zeros(world)]]
    return {name: pd.DataFrame(found, columns=list(COLUMNS[name])) for name, found in rows.items()}


def _world(world: MotionWorld, matches: list[Match], left: list[NamedEffect]) -> Row:
    truth, answer = world.truth, world.answer
    missed = [found for found in matches if not found.right and _is_asked_for(found)]
    outside = ""
    if truth.outside:
        outside = "failed" if answer.failed else outside_outcome(matches, left, bool(answer.claims))
    return {
        "stated": truth.stated,
        "rows": truth.rows,
        "concealed": "; ".join(f"{each.shape or each.effect} {each.location}" for each in truth.effects),
        "said": "; ".join(f"{claim.effect} {claim.location}" for claim in answer.claims),
        "answer": answer.answer,
        "mismatch": answer.mismatch,
        "silent": not answer.failed and not answer.claims,
        "exact": not answer.failed and not left and not missed,
        "missed": len(missed),
        "wrong_names": sum(claim.effect != UNKNOWN for claim in left),
        "outside": outside,
        "outside_right": outside in ("located", "acceptable") if truth.outside else None,
        "held_out_ratio": held_out_ratio(truth, answer),
        "held_out_moving": held_out_ratio(truth, answer, while_moving=True),
        "failed": answer.failed,
        "not_predicted": answer.not_predicted,
    }


def _is_asked_for(found: Match) -> bool:
    """Whether anybody could be asked to name a cause: it was named, or no other concealed one's name says it, too."""
    return found.right or not found.truth.minor


def held_out_ratio(truth: MotionTruth, answer: MotionAnswer, while_moving: bool = False) -> float:
    """See the module.

    Args:
        truth: what the truth itself leaves, N m.
        answer: the predicted torques.
        while_moving: leave readings out at which a joint stands.

    Returns:
        The ratio; infinite if it failed or too little of the path was predicted.
    """
    if answer.predicted is None:
        return float("inf")
    names = [f"tau{j + 1}_nm" for j in range(len(truth.left_nm))]
    if not set(names) <= set(answer.predicted) or len(answer.predicted) != len(truth.test):
        return float("inf")
    left = truth.left_moving_nm if while_moving else truth.left_nm
    off = (answer.predicted[names].to_numpy() - truth.test[names].to_numpy()) / left
    there = np.isfinite(off).all(axis=1)
    counted = np.ones(off.shape, dtype=np.bool_)
    if while_moving:
        counted = truth.test[[f"moves{j + 1}" for j in range(len(left))]].to_numpy() > 0
    enough = there.mean() >= ENOUGH_PREDICTED
    return float(np.sqrt(np.mean(off[there][counted[there]] ** 2))) if enough else float("inf")


def _numbers(matches: list[Match]) -> Iterator[Row]:
    """The numbers of causes found under their own name."""
    for found in matches:
        if found.outcome == "named" and found.claim is not None and found.truth.comparable:
            about: Row = {"effect": found.truth.effect, "location": found.truth.location}
            for name, (true, unit) in found.truth.parameters.items():
                if name in found.claim.parameters:
                    yield about | _covered(name, unit, true, found.claim.parameters[name])


def _ordinary(world: MotionWorld) -> Iterator[Row]:
    """Friction and rotors of joints at which nothing is concealed; where robot.yaml states them they are no finding."""
    truth = world.truth
    if truth.stated or truth.outside or any(Location.of(each.location).kind != "joint" for each in truth.effects):
        return  # wrong masses pull at every joint
    busy = {place(each.location) for each in truth.effects}
    for joint, numbers in world.answer.background:
        if joint in truth.background and place(joint) not in busy:
            for name, true in truth.background[joint].items():
                if name in numbers:
                    about: Row = {"effect": ORDINARY, "location": joint}
                    yield about | _covered(name, numbers[name][2], true, numbers[name])


def _zeros(world: MotionWorld) -> Iterator[Row]:
    """The zeros of links' encoders where nothing lays the link elsewhere."""
    busy = {place(each.location) for each in world.truth.effects}
    for j, zero in enumerate(world.truth.zeros):
        joint = f"joint {j + 1}"
        if joint in world.answer.zeros and place(joint) not in busy:
            about: Row = {"effect": ORDINARY, "location": joint}
            yield about | _covered("zero", world.answer.zeros[joint][2], float(zero), world.answer.zeros[joint])


def _covered(name: str, unit: str, true: float, fitted: tuple[float, float, str]) -> Row:
    value, stderr, _ = fitted
    covered = bool(abs(value - true) <= INTERVAL * stderr)
    return {
        "parameter": name, "unit": unit, "true": true, "fitted": value, "stderr": stderr, "covered": covered,
    }  # fmt: skip


AIMS: tuple[Aim, ...] = (
    Aim("no name on clean arms", "worlds", "silent", (0.99, 1.0), category("clean")),
    Aim("exact set of names, single causes at 3x the noise and above", "worlds", "exact", (0.95, 1.0),
        clear("single")),
    Aim("exact set of names, several causes", "worlds", "exact", (0.90, 1.0), category("multiple")),
    Aim("location right whenever the name is", "names", "right", (0.98, 1.0),
        lambda rows: rows["effect_right"].astype(bool) & (rows["category"] != "rough")),
    Aim("95 % intervals of causes hold the true number", "intervals", "covered", (0.90, 0.97),
        lambda rows: (rows["effect"] != ORDINARY) & (rows["category"] != "rough")),
    Aim("95 % intervals of ordinary friction and rotors hold the true number", "intervals", "covered",
        (0.90, 0.97), lambda rows: (rows["effect"] == ORDINARY) & (rows["category"] != "rough")),
    Aim("outside the library: located and not misnamed", "worlds", "outside_right", (0.90, 1.0), category("outside")),
    Aim("rough arms: every cause named, a largest one first, nothing false", "worlds", "right", (0.90, 1.0),
        category("rough")),
    Aim("rough arms: nothing false", "worlds", "nothing_false", (0.90, 1.0), category("rough")),
    Aim("causes that stand out of rough arms: named", "effects", "right", (0.95, 1.0), category("rough")),
    Aim("95 % intervals of causes of rough arms hold the true number", "intervals", "covered", (0.90, 0.97),
        lambda rows: (rows["effect"] != ORDINARY) & (rows["category"] == "rough")),
    Aim("ambiguous: the truth among causes or alternatives", "effects", "among_all", (0.95, 1.0),
        lambda rows: rows["ambiguous"].astype(bool)),
)  # fmt: skip
