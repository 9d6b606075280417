"""All claims judged: by method, on the robots drawn from the ensemble, and under varied assumptions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from armscope.paper.anchoring import ANCHORED
from armscope.paper.claims.catalogue import CLAIMS
from armscope.paper.claims.claim import BY_SWARM, Claim
from armscope.paper.claims.evidence import AS_PRINTED, IMPROVED, LEAST_SQUARES, Evidence, Judged
from armscope.paper.claims.verdicts import interval, under_assumptions, verdict

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
