"""All claims judged: by method, on the robots drawn from the ensemble, and under varied assumptions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.paper.anchoring import ANCHORED
from armscope.paper.claims.catalogue import BY_SWARM, CLAIMS, Claim
from armscope.paper.claims.evidence import AS_PRINTED, IMPROVED, LEAST_SQUARES, Evidence, Judged
from armscope.paper.claims.verdicts import interval, under_assumptions, verdict

Array = NDArray[np.float64]

SKIPPED = "skipped"


def judge(evidence: Mapping[str, Evidence]) -> tuple[pd.DataFrame, pd.DataFrame]:
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
    rows, per_robot = [], []
    for claim in CLAIMS:
        for method, of_method in _methods(claim, evidence):
            reason = _missing(claim, of_method)
            judged = None if reason else claim.judge(of_method)
            if judged is None:
                rows.append({"key": claim.key, "method": method, "verdict": SKIPPED, "why_skipped": reason or "not run"})
                continue
            rows.append({"key": claim.key, "method": method, **_row(of_method.robots, judged), "why_skipped": ""})
            outcome = {"key": claim.key, "method": method, "robot": of_method.robots}
            per_robot.append(pd.DataFrame({**outcome, "true": judged.per_robot, "number": judged.numbers}))
    return pd.DataFrame(rows), pd.concat(per_robot, ignore_index=True)


def _methods(claim: Claim, evidence: Mapping[str, Evidence]) -> list[tuple[str, Evidence]]:
    if claim.fitted == BY_SWARM:
        return [(method, evidence[method]) for method in (AS_PRINTED, IMPROVED)]
    return [(LEAST_SQUARES, evidence[IMPROVED])]


def _missing(claim: Claim, evidence: Evidence) -> str:
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
        return {"verdict": SKIPPED}
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
    """The table of claims: what `judge` found, the words of each claim, and its verdict under varied assumptions.

    Args:
        judged: the claims of the configured study.
        sensitivity: see `armscope.paper.sensitivity`; may be empty.

    Returns:
        Columns key, group, claim, source, wording, criterion, then those of `judge`, unit, number_is, scenarios (how
        many others the claim was judged in), share_least, share_most (over all scenarios), under_assumptions ("holds
        under all", "fails under all", "depends on the robot", "depends on the assumption", "too few robots to tell",
        "not varied"), depends_on (which assumptions).
    """
    by_key = {claim.key: claim for claim in CLAIMS}
    words = pd.DataFrame(
        [
            {
                "key": key,
                "group": by_key[key].group,
                "claim": by_key[key].claim,
                "source": by_key[key].source,
                "wording": by_key[key].wording,
                "criterion": by_key[key].criterion,
                "unit": by_key[key].unit,
                "number_is": by_key[key].number_is,
            }
            for key in dict.fromkeys(judged["key"])
        ]
    )
    varied = [_varied(row, sensitivity) for row in judged.to_dict("records")]
    return words.merge(pd.concat([judged, pd.DataFrame(varied)], axis=1), on="key")


def _varied(row: Mapping[str, object], sensitivity: pd.DataFrame) -> dict[str, object]:
    nothing = {"scenarios": 0, "share_least": row.get("share"), "share_most": row.get("share")}
    if sensitivity.empty or row["verdict"] == SKIPPED:
        return {**nothing, "under_assumptions": "not varied", "depends_on": ""}
    mine = sensitivity[(sensitivity["key"] == row["key"]) & (sensitivity["method"] == row["method"])]
    mine = mine[mine["verdict"] != SKIPPED]
    if mine.empty:
        return {**nothing, "under_assumptions": "not varied", "depends_on": ""}
    found, factors = under_assumptions(str(row["verdict"]), zip(mine["factor"], mine["verdict"], strict=True))
    shares = [*mine["share"], row["share"]]
    return {
        "scenarios": len(mine),
        "share_least": min(shares),
        "share_most": max(shares),
        "under_assumptions": found,
        "depends_on": ", ".join(factors),
    }
