"""What a fleet shows: causes by arm and date, the outliers of each type, what repeats, and how likely that makes it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from armscope.core.averages import robust_scale
from armscope.fleet.constants import FLEET
from armscope.fleet.members import FAILURE, Member
from armscope.verdict.filenames import VERDICT
from armscope.verdict.files import read_verdict
from armscope.verdict.schema import Verdict

NO_VERDICT = "no verdict"  # What stands as the answer of a diagnosis that was not made


def verdicts(members: Sequence[Member], folders: Sequence[Path]) -> tuple[dict[str, Verdict], dict[str, str]]:
    """Verdicts by member's name, and why others have none."""
    found, failed = {}, {}
    for member in members:
        for folder in folders:
            if (folder / member.name / VERDICT).is_file():
                found[member.name] = read_verdict(folder / member.name / VERDICT)
            elif (folder / member.name / FAILURE).is_file():
                failed[member.name] = (folder / member.name / FAILURE).read_text(encoding="utf-8").strip()
        if member.name not in found:
            failed.setdefault(member.name, "not diagnosed")
    return found, failed


def causes_of_arms(members: Sequence[Member], found: Mapping[str, Verdict]) -> pd.DataFrame:
    """One row per named effect: arm, type, date, run, cause, words, size at the tool (mm), share, parameters."""
    rows: list[dict[str, Any]] = [
        {
            "arm": member.arm, "type": member.type, "date": member.date, "run": member.run,
            "cause": effect.as_member, "title": effect.title,
            "rms_at_tool_mm": effect.rms_at_tool_mm, "share": effect.share, "minor": effect.minor,
        }
        for member in members if member.name in found
        for effect in found[member.name].effects
    ]  # fmt: skip
    columns = ["arm", "type", "date", "run", "cause", "title", "rms_at_tool_mm", "share", "minor"]
    return pd.DataFrame(rows, columns=columns)


def without_verdict(members: Sequence[Member], failed: Mapping[str, str]) -> pd.DataFrame:
    """One row per diagnosis that was not made, with the columns of `arms`: why stands in the headline's place."""
    rows = [
        {
            "arm": member.arm, "type": member.type, "date": member.date, "run": member.run,
            "answer": NO_VERDICT, "headline": " ".join(failed[member.name].split()),
        }
        for member in members if member.name in failed
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=["arm", "type", "date", "run", "answer", "headline"])


def arms(members: Sequence[Member], found: Mapping[str, Verdict]) -> pd.DataFrame:
    """One row per diagnosis: what is left before and after, mm, and how far each lies from its type (robust z)."""
    rows = [
        {
            "arm": member.arm, "type": member.type, "date": member.date, "run": member.run,
            "answer": verdict.answer, "before_mm": verdict.residual_before_mm,
            "after_mm": verdict.residual_after_mm, "headline": verdict.headline,
        }
        for member in members if (verdict := found.get(member.name)) is not None
    ]  # fmt: skip
    columns = ["arm", "type", "date", "run", "answer", "before_mm", "after_mm", "headline"]
    table = pd.DataFrame(rows, columns=columns)
    for name in ("before", "after"):
        table[f"{name}_apart"] = table.groupby("type")[f"{name}_mm"].transform(_apart) if len(table) else []
    return table


def _apart(values: pd.Series[float]) -> pd.Series[float]:
    """How far each value's logarithm lies from the median, in robust standard deviations; NaN of too few."""
    if len(values) < FLEET.fewest_arms:
        return values * np.nan
    logs = np.log(np.maximum(values.to_numpy(dtype=float), FLEET.least_mm))
    away = logs - np.median(logs)
    return pd.Series(away / max(robust_scale(away), FLEET.least_spread), index=values.index)


def outliers(table: pd.DataFrame) -> pd.DataFrame:
    """The diagnoses that lie far from others of their type, farthest first."""
    far = table[["before_apart", "after_apart"]].abs().max(axis=1)
    return table[far > FLEET.outlier].assign(apart=far[far > FLEET.outlier]).sort_values("apart", ascending=False)


def repeated(table: pd.DataFrame, of_arms: pd.DataFrame) -> pd.DataFrame:
    """By type and cause: in how many of the arms it was named, and how large; what is minor does not count."""
    count = of_arms.groupby("type")["arm"].nunique()
    groups = table[~table["minor"].astype(bool)].groupby(["type", "cause"])
    size = "rms_at_tool_mm"
    found = groups.agg(arms=("arm", "nunique"), median_mm=(size, "median"), most_mm=(size, "max")).reset_index()
    found["of"] = found["type"].map(count)
    # Laplace's rule: one arm more with it, one more without
    found["expected_share"] = (found["arms"] + 1) / (found["of"] + 2)
    return found.sort_values(["type", "arms"], ascending=[True, False], ignore_index=True)


def learned_sizes(members: Sequence[Member], found: Mapping[str, Verdict]) -> pd.DataFrame:
    """By type, cause and parameter: its unit, and its root mean square over the arms in which it was named.

    An arm that was diagnosed several times counts once.
    """
    keys = ["type", "cause", "parameter", "unit"]
    rows = [
        (member.type, effect.as_member, each.name, each.unit, member.arm, each.value**2)
        for member in members if member.name in found
        for effect in found[member.name].effects
        for each in effect.parameters if np.isfinite(each.value)
    ]  # fmt: skip
    of_arms = pd.DataFrame(rows, columns=[*keys, "arm", "square"]).groupby([*keys, "arm"])["square"].mean()
    sizes = of_arms.groupby(keys).agg(["mean", "size"]).reset_index()
    return sizes.assign(rms=np.sqrt(sizes["mean"])).rename(columns={"size": "arms"})[[*keys, "rms", "arms"]]


def priors(table: pd.DataFrame, sizes: pd.DataFrame) -> dict[str, Any]:
    """What the next arm of a type may be expected to have, as written to priors.yaml (`armscope.robot.arm_type`)."""
    content: dict[str, Any] = {}
    for row in table.to_dict("records"):
        of_type = content.setdefault(str(row["type"]), {"arms": int(row["of"]), "causes": {}})
        of_type["causes"][str(row["cause"])] = {
            "share": round(float(row["expected_share"]), 4),
            "rms_at_tool_mm": round(float(row["median_mm"]), 4),
        }
    for row in sizes.to_dict("records"):
        if (of_type := content.get(str(row["type"]))) is not None:
            of_cause = of_type.setdefault("sizes", {}).setdefault(str(row["cause"]), {})
            size = {"unit": str(row["unit"]), "rms": float(f"{row['rms']:.4g}"), "arms": int(row["arms"])}
            of_cause[str(row["parameter"])] = size
    return {"format": "armscope fleet priors 2", "types": content}
