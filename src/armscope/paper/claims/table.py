"""All claims judged: by method, on the robots drawn from the ensemble, and under varied assumptions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cache

import numpy as np
import pandas as pd

from armscope.paper.anchoring import ANCHORED
from armscope.paper.claims.catalogue import CLAIMS
from armscope.paper.claims.claim import BY_SWARM, Claim
from armscope.paper.claims.evidence import AS_PRINTED, IMPROVED, LEAST_SQUARES, Evidence, Judged

HOLDS_FROM, FAILS_TO = 0.95, 0.05
"""A claim holds if it is true of at least this share of the robots, fails if of at most that one."""

HOLDS, FAILS, DEPENDS, OPEN = "holds", "fails", "depends on the robot", "too few robots to tell"
DECISIVE = (HOLDS, FAILS, DEPENDS)


@cache
def interval(true: int, robots: int) -> tuple[float, float]:
    """Exact 95 % interval of a share (Clopper & Pearson 1934)."""
    from scipy.stats import binomtest  # takes half a second: seldom needed

    found = binomtest(true, robots).proportion_ci(0.95, "exact")
    return float(found.low), float(found.high)


def verdict(true: int, robots: int) -> str:
    """`HOLDS`, `FAILS` or `DEPENDS` where the 95 % interval lies on one side of both lines, else `OPEN`.

    So 100 of 100 robots hold a claim, and 96 of 101 say nothing: the share may be 90 % or 98 %.
    """
    low, high = interval(true, robots)
    if low >= HOLDS_FROM:
        return HOLDS
    if high <= FAILS_TO:
        return FAILS
    return DEPENDS if low > FAILS_TO and high < HOLDS_FROM else OPEN


def under_assumptions(base: str, varied: Iterable[tuple[str, str]]) -> tuple[str, tuple[str, ...]]:
    """What remains of a verdict when the assumptions are varied.

    Args:
        varied: (which assumption was varied, the verdict then), in the order of the scenarios.

    Returns:
        (verdict, assumptions that decide it): "holds under all", "fails under all", "depends on the robot", "depends on
        the assumption" with the assumptions whose change alone gives another decisive verdict ("several at once" if
        only changes together do), or `OPEN`. Scenarios with too few robots to tell contradict nothing.
    """
    rows = [("", base), *varied]
    decisive = [(factor, each) for factor, each in rows if each in DECISIVE]
    verdicts = {each for _, each in decisive}
    if not verdicts:
        return OPEN, ()
    if len(verdicts) == 1:
        only = verdicts.pop()
        return (only if only == DEPENDS else f"{only} under all"), ()
    reference = base if base in DECISIVE else decisive[0][1]
    return "depends on the assumption", tuple(dict.fromkeys(f for f, each in decisive if each != reference))


SKIPPED = "skipped"
SIGNIFICANT = 0.05
"""An assumption moves a share if Fisher's exact test says so at this level over all scenarios together (Bonferroni)."""


def judge_claims(evidence: Mapping[str, Evidence]) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Each claim judged by each method.

    Args:
        evidence: by method, `AS_PRINTED` and `IMPROVED`; what needs no swarm is judged on the latter.

    Returns:
        (claims, robots). Claims has columns key, method ("as printed", "improved"; "least squares" where no swarm is
        needed), verdict, true, robots (drawn from the ensemble: the anchored one is the most probable, not a draw),
        share, share_low, share_high (exact 95 % interval), anchored ("yes", "no"), number (median over the robots),
        number_anchored, number_low, number_high (5 and 95 % of the robots), number_printed (the same from the printed
        Table 2), why_skipped. Robots has columns key, method, robot, true, number: one row per robot.
    """
    rows: list[dict[str, object]] = []
    per_robot = [pd.DataFrame(columns=["key", "method", "robot", "true", "number"])]
    for claim in CLAIMS:
        for method, of_method in _methods(claim, evidence):
            place: dict[str, object] = {"key": claim.key, "method": method}
            reason = missing_models(claim, of_method)
            judged = None if reason else claim.judge(of_method)
            if judged is None:
                rows.append({**place, "verdict": SKIPPED, "why_skipped": reason or "not run"})
                continue
            rows.append({**place, **_row(of_method.robots, judged)})
            outcome = {"robot": of_method.robots, "true": judged.per_robot, "number": judged.numbers}
            per_robot.append(pd.DataFrame({**place, **outcome}))
    table = pd.DataFrame(rows)
    outcomes = pd.concat(per_robot[1:] or per_robot, ignore_index=True)
    return table.assign(why_skipped=table.get("why_skipped", "")), outcomes


def _methods(claim: Claim, evidence: Mapping[str, Evidence]) -> list[tuple[str, Evidence]]:
    if claim.fitted == BY_SWARM:
        return [(method, evidence[method]) for method in (AS_PRINTED, IMPROVED)]
    return [(LEAST_SQUARES, evidence[IMPROVED])]


def missing_models(claim: Claim, evidence: Evidence) -> str:
    """Why the configured models don't let a claim be judged; "" if they do."""
    absent = [name for name in claim.needs if name not in evidence.models]
    if absent:
        return f"{' and '.join(absent)} not among the configured models"
    if claim.any_of and not set(claim.any_of) & set(evidence.models):
        return "none of the paper's models is configured"
    return ""


def _row(robots: Sequence[str], judged: Judged) -> dict[str, object]:
    drawn = np.array([robot != ANCHORED for robot in robots])
    anchored = np.flatnonzero(~drawn)
    true, count = int(judged.per_robot[drawn].sum()), int(drawn.sum())
    if not count:
        return {"verdict": SKIPPED, "why_skipped": "no robots were drawn"}
    share_low, share_high = interval(true, count)
    # where some are infinite there is no interpolating between values
    low, median, high = np.quantile(judged.numbers[drawn], [0.05, 0.5, 0.95], method="nearest")
    return {
        "verdict": verdict(true, count),
        "true": true,
        "robots": count,
        "share": true / count,
        "share_low": share_low,
        "share_high": share_high,
        "anchored": ("yes" if judged.per_robot[anchored[0]] else "no") if len(anchored) else "",
        "number": float(median),
        "number_anchored": float(judged.numbers[anchored[0]]) if len(anchored) else np.nan,
        "number_low": float(low),
        "number_high": float(high),
        "number_printed": judged.printed,
    }


def summarise(judged: pd.DataFrame, sensitivity: pd.DataFrame) -> pd.DataFrame:
    """The table of claims: the words of each, what was judged of it, and its verdict under varied assumptions.

    Args:
        sensitivity: see `armscope.paper.sensitivity`; may be empty.

    Returns:
        Columns key, group, claim, source, wording, criterion, unit, number_is, those of `judge_claims`, and scenarios
        (how many others the claim was judged in), moved_by (assumptions that move the share significantly),
        share_least, share_most (over all scenarios), under_assumptions ("holds under all", "fails under all", "depends
        on the robot", "depends on the assumption", "too few robots to tell", "not varied"), depends_on (which
        assumptions).
    """
    words = [
        {
            "key": claim.key,
            "group": claim.group,
            "claim": claim.claim,
            "source": claim.source,
            "wording": claim.wording,
            "criterion": claim.criterion,
            "unit": claim.unit,
            "number_is": claim.number_is,
        }
        for claim in CLAIMS
    ]
    varied = pd.DataFrame([_varied(row, sensitivity) for _, row in judged.iterrows()])
    return pd.DataFrame(words).merge(pd.concat([judged, varied], axis=1), on="key")


def _varied(row: pd.Series, sensitivity: pd.DataFrame) -> dict[str, object]:
    """What the scenarios make of one claim by one method."""
    mine = sensitivity
    if len(mine):
        same = (mine["key"] == row["key"]) & (mine["method"] == row["method"])
        mine = mine[same & (mine["verdict"] != SKIPPED)]
    if mine.empty or row["verdict"] == SKIPPED:
        only = row.get("share", np.nan)
        nothing = {"under_assumptions": "not varied", "depends_on": ""}
        return {"scenarios": 0, "moved_by": "", "share_least": only, "share_most": only, **nothing}
    found, factors = under_assumptions(str(row["verdict"]), zip(mine["factor"], mine["verdict"], strict=True))
    level = SIGNIFICANT / len(mine)
    moved = [str(scenario["factor"]) for _, scenario in mine.iterrows() if _differs(row, scenario, level)]
    shares = [*mine["share"], row["share"]]
    return {
        "scenarios": len(mine),
        "moved_by": ", ".join(dict.fromkeys(moved)),
        "share_least": min(shares),
        "share_most": max(shares),
        "under_assumptions": found,
        "depends_on": ", ".join(factors),
    }


def _differs(base: pd.Series, other: pd.Series, level: float) -> bool:
    """Whether two shares of robots differ (Fisher's exact test)."""
    from scipy.stats import fisher_exact  # takes half a second: seldom needed

    counts = np.array([[each["true"], each["robots"] - each["true"]] for each in (base, other)], dtype=int)
    return bool(fisher_exact(counts).pvalue < level)
