"""What is counted on rough arms, and its rates: causes that stand out among small errors (`definitions` has words)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import pandas as pd

from armscope.physics.registry import EFFECTS
from armscope.proof.answers import Answer, NamedEffect
from armscope.proof.binomial import RATE, Row, of_seeds, rate
from armscope.proof.definitions import (
    ABSURD_MM,
    ABSURD_RAD,
    ABSURD_TIMES,
    AS_LARGE,
    LARGEST_SMALL,
    MOST_MAJOR,
    ROUGH,
    SEEDS,
    Name,
    place,
)
from armscope.proof.matching import Match, distinct
from armscope.proof.truth import Concealed, Truth
from armscope.verdict.effects import UNKNOWN

CONSTANT = ("joint_offset", "link_geometry")
OWN_SIZE = ("compliance", "amplitude", "flexibility", "gap")


def rough_scores(
    truth: Truth, answer: Answer, matches: Sequence[Match], wrong: Sequence[NamedEffect]
) -> dict[str, object]:
    """How a verdict fares on an arm that has small errors everywhere.

    Args:
        truth: of the arm.
        answer: the verdict.
        matches: concealed effects with the claims that stand for them.
        wrong: claims that stand for nothing concealed.

    Returns:
        causes, first (None without a cause), overclaimed, major_names, absurd, tellable, and right, all by the
        definitions.
    """
    claims = distinct(answer.claims)
    found = {m.claim.name: m.truth for m in matches if m.right and m.claim}
    story = truth.story
    first = _largest_is_true(claims, found, story) if story else None
    overclaimed = 0 if story else sum(_overclaims(truth, claim) for claim in claims)
    all_found = all(m.right for m in matches if not m.truth.minor)
    return {
        "causes": len(story),
        "first": first,
        "overclaimed": overclaimed,
        "major_names": sum(not claim.minor for claim in claims),
        "tellable": all(cause.tellable for cause in story),
        "absurd": sum(_absurd(claim, found.get(claim.name)) for claim in claims),
        "right": not answer.failed and all_found and not wrong and (bool(first) if story else not overclaimed),
    }


def _largest_is_true(claims: Sequence[NamedEffect], found: dict[Name, Concealed], story: Sequence[Concealed]) -> bool:
    """Whether the largest name is a cause's, or of something as large; D-H values compete with their like only."""
    constant = any(cause.effect in CONSTANT for cause in story)
    ranked = [claim for claim in claims if constant or claim.effect not in CONSTANT]
    if not ranked:
        return False
    stands_for = found.get(max(ranked, key=lambda claim: claim.rms_mm).name)
    return stands_for is not None and (
        not stands_for.minor or stands_for.strength >= AS_LARGE * max(cause.strength for cause in story)
    )


def _overclaims(truth: Truth, claim: NamedEffect) -> bool:
    """Whether a name claims much of what is left after frames and D-H values where nothing stands out."""
    # a name may stand for all that is the same, an unknown for all that there is at its place
    alike = [e for e in truth.effects if claim.name in (e.name, *e.alternatives)]
    if claim.effect == UNKNOWN:
        alike = [e for e in truth.effects if place(e.location) == place(claim.location)]
    own = sum(effect.strength for effect in alike)
    most = max(LARGEST_SMALL * truth.left_mm**2, (1.5 * own * truth.sigma_mm) ** 2)
    exempt = claim.effect in CONSTANT or claim.name in truth.also_allowed
    return not exempt and claim.rms_mm**2 > most


def _absurd(claim: NamedEffect, stands_for: Concealed | None) -> bool:
    """Whether one of its numbers is none that an arm could have."""
    true = {name: abs(value) for name, (value, _) in stands_for.parameters.items()} if stands_for else {}
    for name, (value, _, unit) in claim.parameters.items():
        most = {"mm": ABSURD_MM, "rad": ABSURD_RAD}.get(unit, float("inf"))
        if claim.effect in CONSTANT and abs(value) > max(most, 2 * true.get(name, 0.0)):
            return True
        if name in OWN_SIZE and abs(value) > ABSURD_TIMES * true.get(name, float("inf")):
            return True
    return False


FAMILY_OF = {effect.name: effect.family for effect in EFFECTS}
BY_CAUSES: dict[str, Callable[[pd.DataFrame], pd.Series]] = {
    "rough": lambda worlds: worlds["category"] == "rough",
    "rough, no cause": lambda worlds: (worlds["category"] == "rough") & (worlds["causes"] == 0),
    "rough, one cause": lambda worlds: (worlds["category"] == "rough") & (worlds["causes"] == 1),
    "rough, several causes": lambda worlds: (worlds["category"] == "rough") & (worlds["causes"] > 1),
    "rough, and the session misleads": lambda worlds: worlds["category"] == "rough_misleading",
}


def rough_table(worlds: pd.DataFrame, effects: pd.DataFrame, intervals: pd.DataFrame) -> pd.DataFrame:
    """Rates of rough arms by number of causes, and of the causes by family.

    Args:
        worlds, effects, intervals: cases, as `armscope.proof.scoring.score` counts them.

    Returns:
        family, seeds, score, cases, right, estimate, low, high.
    """
    rows: list[Row] = []
    for seeds in SEEDS:
        chosen = [of_seeds(table, seeds) for table in (worlds, effects, intervals)]
        for family, score, right in (*_of_worlds(*chosen), *_of_causes(chosen[1])):
            if len(right):
                rows.append({"family": family, "seeds": seeds, "score": score, **vars(rate(right))})
    return pd.DataFrame(rows, columns=["family", "seeds", "score", *RATE])


def _of_worlds(
    worlds: pd.DataFrame, effects: pd.DataFrame, intervals: pd.DataFrame
) -> Iterator[tuple[str, str, pd.Series]]:
    for family, among in BY_CAUSES.items():
        group = worlds[among(worlds)]
        causes = effects[effects["world"].isin(group["world"]) & ~effects["minor"].astype(bool)]
        held = intervals[intervals["world"].isin(group["world"]) & intervals["covered"].notna()]
        scores = {
            "right": group["right"],
            "no wrong name": group["wrong_names"] == 0,
            f"at most {MOST_MAJOR} major names": group["major_names"] <= MOST_MAJOR,
            "no absurd value": group["absurd"] == 0,
            "held out within 10 % of the oracle": group["near_oracle"],
            "causes found": causes["right"],
            "a cause is the largest": group[group["causes"] > 0]["first"],
            "95 % intervals hold": held["covered"],
        }
        yield from ((family, score, right) for score, right in scores.items())


def _of_causes(effects: pd.DataFrame) -> Iterator[tuple[str, str, pd.Series]]:
    causes = effects[effects["category"].isin(ROUGH) & ~effects["minor"].astype(bool)]
    for family, group in causes.groupby(causes["effect"].map(FAMILY_OF).fillna(UNKNOWN)):
        yield f"causes: {family}", "causes found", group["right"]
