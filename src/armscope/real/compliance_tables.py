"""Compliances of runs side by side, as tables: each run's values and intervals, and which runs agree."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from itertools import combinations

import numpy as np
import pandas as pd
from scipy.stats import t as t_distribution

from armscope.core.location import Location
from armscope.core.types import Array, unheard
from armscope.real.compliances import Agreement, Give, compare_compliances, fit_give
from armscope.real.constants import COMPLIANCE
from armscope.real.reference import ReferenceCompliances
from armscope.recordings import Recordings
from armscope.robot import Arm

POINTS, ORIENTATIONS = "points alone", "points and orientations"


def half_width(stderr: float) -> float:
    """Of a 95 % interval from a standard error by a jackknife over the blocks."""
    return stderr * float(t_distribution.ppf((1 + COMPLIANCE.sure) / 2, COMPLIANCE.blocks - 1))


def agreement_in_words(direction: Array, n_motors: int) -> str:
    """A combination as "bearing 1 + 0.9 drive 2 + ...", its largest weight 1; what hardly counts is left out."""
    weights = direction / direction[np.argmax(np.abs(direction))]
    order = np.argsort(-np.abs(weights), kind="stable")
    told = []
    for number in order[np.abs(weights[order]) >= COMPLIANCE.told]:
        name = f"drive {number + 1}" if number < n_motors else f"bearing {number - n_motors + 1}"
        sign = "-" if weights[number] < 0 else "+"
        size = f"{abs(weights[number]):.1f} " if abs(weights[number]) < 0.95 else ""
        told.append(f"{sign} {size}{name}")
    return " ".join(told).removeprefix("+ ")


def compare_runs(
    arm: Arm, recordings: Recordings, reference: ReferenceCompliances, tell: Callable[[str], None] = unheard
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """What every run says of the joints asked for, and which runs agree: from points alone, and from orientations, too.

    Args:
        arm: the nominal arm, with masses.
        recordings: all runs of a set.
        reference: which runs and joints are asked for.
        tell: hears what is being done.

    Returns:
        Compliances: learned, run, of (joint, or the combination that all runs tell best), value, stderr, low, high,
        reference, all in microrad/(N m); noise_mm, masses. And agreement, a row per pair of runs and combination that
        both determine: learned, one, other, of, one_value, other_value, difference, stderr (microrad/(N m)); directions
        (how many), statistic and probability of all of them together.
    """
    best: Array | None = None
    values: list[dict[str, object]] = []
    pairs: list[dict[str, object]] = []
    for learned in (POINTS, ORIENTATIONS):
        rows = replace(recordings, orientation=None) if learned == POINTS else recordings
        if learned == ORIENTATIONS and not recordings.oriented.any():
            continue
        found = {run: fit_give(arm, rows.of_runs([run]), run) for run in reference.runs}
        for name, runs in reference.together.items():
            found[name] = fit_give(arm, rows.rows(np.isin(rows.run, runs)), name)
        tell(
            f"compliances from {learned}: "
            + ", ".join(f"{name} {each.noise_mm:.3f} mm" for name, each in found.items())
        )
        agreed = [compare_compliances(found[a], found[b]) for a, b in _pairs(reference)]
        best = agreed[-1].directions[0] if best is None else best
        values += [{"learned": learned, **row} for row in _value_rows(found, best, reference, arm.n_motors)]
        pairs += [{"learned": learned, **row} for each in agreed for row in _agreement_rows(each, found, arm.n_motors)]
    return pd.DataFrame(values), pd.DataFrame(pairs)


def _pairs(reference: ReferenceCompliances) -> list[tuple[str, str]]:
    """Every two runs, and those fitted together beside the runs that are not among them."""
    pairs = list(combinations(reference.runs, 2))
    return pairs + [
        (run, name) for name, runs in reference.together.items() for run in reference.runs if run not in runs
    ]


def _value_rows(
    found: Mapping[str, Give], best: Array, reference: ReferenceCompliances, n_motors: int
) -> Iterator[dict[str, object]]:
    """Each joint's drive in each run, and a combination that they tell well."""
    unit = np.eye(len(best))
    of: dict[str, Array] = {f"joint {joint}": unit[joint - 1] for joint in reference.microrad_per_nm}
    best = best / best[np.argmax(np.abs(best))]
    for name, direction in (of | {agreement_in_words(best, n_motors): best}).items():
        for run, each in found.items():
            value, stderr = _along(each, direction)
            known = reference.microrad_per_nm.get(Location.of(name).number) if name in of else None
            yield {
                "run": run,
                "of": name,
                "value": value,
                "stderr": stderr,
                "low": value - half_width(stderr),
                "high": value + half_width(stderr),
                "reference": known if run == reference.learned_on else None,
                "noise_mm": each.noise_mm,
                "masses": each.masses,
            }


def _along(give: Give, direction: Array) -> tuple[float, float]:
    """A combination of compliances and its standard error, microrad/(N m)."""
    return 1e6 * float(direction @ give.mean), 1e6 * float(np.sqrt(direction @ give.covariance @ direction))


def _agreement_rows(each: Agreement, found: Mapping[str, Give], n_motors: int) -> Iterator[dict[str, object]]:
    whole = {"directions": len(each.directions), "statistic": each.statistic, "probability": each.probability}
    for direction, difference, stderr in zip(each.directions, each.difference, each.stderr, strict=True):
        largest = direction[np.argmax(np.abs(direction))]
        yield {
            "one": each.one,
            "other": each.other,
            "of": agreement_in_words(direction, n_motors),
            "one_value": _along(found[each.one], direction / largest)[0],
            "other_value": _along(found[each.other], direction / largest)[0],
            "difference": 1e6 * difference / largest,
            "stderr": 1e6 * stderr / abs(largest),
            **whole,
        }
