"""Rates of rough arms: by how many causes stand out, and of the causes by family."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pandas as pd

from armscope.physics.registry import EFFECTS
from armscope.proof.binomial import RATE, Row, of_seeds, rate
from armscope.proof.definitions import MOST_MAJOR, ROUGH, SEEDS
from armscope.verdict.effects import UNKNOWN

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
