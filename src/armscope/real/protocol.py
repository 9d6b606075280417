"""Held-out numbers of real runs in the reference protocol: plain calibrations, the paper's models, and the diagnosis.

Every figure is the test RMS of the 3D distance in mm. The diagnosis is repeated from the beginning on the training
rows of every split, and like the reference it sees points alone; where orientations were measured, it is repeated once
more with them, in a row of its own. The paper's models see 85 identification rows chosen by their observability, as in
the paper, and all other rows test them; they are fitted by least squares, which their swarms approach to a fraction of
a per cent.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd

from armscope.calibration.constants import CALIBRATING
from armscope.calibration.held_out import foretold, held_out_levels, random_split, residuals_on
from armscope.calibration.model import LEVELS, Level, set_up
from armscope.core.averages import rms_distance
from armscope.core.grouping import named_configuration
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array, Indices, unheard
from armscope.diagnosis import Diagnosis, Settings, diagnose
from armscope.errormodels.features import PAPER_MODELS, fit_least_squares
from armscope.measurement.channel import ORIENTATIONS
from armscope.paper.enough_poses import PRINTED_COUNT
from armscope.paper.printed import IDENTIFICATION
from armscope.paper.real import real_measurements
from armscope.physics.model import predict
from armscope.real.reference import ReferenceRun
from armscope.recordings import Recordings
from armscope.robot import Arm, chain

ARMSCOPE, ORIENTED, UNCORRECTED = "armscope", "armscope, orientations too", "frames only"


@dataclass(frozen=True, eq=False)
class Measured:
    """What was found on a run."""

    # one row per model and split: run, model, split, train, test (rows), rms_mm, turn_mrad (RMS of the angle between
    # predicted and measured orientation, where orientations were learned, too)
    splits: pd.DataFrame
    # one row per effect that a split's verdict names: run, model, split, effect, location, named_as, minor,
    # rms_at_tool_mm, title, row (of a jump of base or tool: the first id after it)
    names: pd.DataFrame


def measure_run(
    arm: Arm,
    recordings: Recordings,
    reference: ReferenceRun,
    diagnosed_splits: int | None = None,
    oriented_splits: int | None = None,
    tell: Callable[[str], None] = unheard,
) -> Measured:
    """A run in the reference protocol.

    Args:
        arm: the nominal arm.
        recordings: all runs of a set.
        reference: which rows, and how they are split.
        diagnosed_splits: on how many of the splits the diagnosis is repeated; None takes all.
        oriented_splits: on how many of these it is repeated with orientations, too; None takes all.
        tell: hears what is being done.

    Returns:
        Held-out errors by model and split, mm, and what was named on each split.
    """
    table = recordings.of_runs([reference.run], reference.first_id)
    seeds = range(reference.splits)
    tell(f"{reference.name}: {len(table)} rows, {len(seeds)} splits")
    rows = [
        {"run": reference.name, "model": level.level, "split": seed, "rms_mm": 1e3 * value}
        for level in held_out_levels(arm, table, seeds=seeds, most_rows=reference.most_rows)
        for seed, value in zip(seeds, level.per_split, strict=True)
    ]
    names: list[dict[str, object]] = []
    diagnosed = list(seeds)[:diagnosed_splits]
    models = {ARMSCOPE: diagnosed} | ({} if not table.oriented.any() else {ORIENTED: diagnosed[:oriented_splits]})
    for model, seed in ((model, seed) for model, chosen in models.items() for seed in chosen):
        train, test = random_split(table, seed)
        settings = Settings(seed=seed, resamples=0, cross_validation=False, orientation=model == ORIENTED)
        verdict = diagnose(arm, table.rows(train), settings)
        left = {
            "rms_mm": rms_distance_mm(verdict, table.rows(test)),
            "turn_mrad": rms_turn_mrad(verdict, table.rows(test)),
        }
        tell(f"{reference.name}: split {seed}, {model} {left['rms_mm']:.3f} mm in {verdict.seconds:.0f} s")
        sizes = {"train": len(train), "test": len(test)}
        rows.append({"run": reference.name, "model": model, "split": seed, **left, **sizes})
        names += [{"run": reference.name, "model": model, "split": seed, **effect} for effect in effects_named(verdict)]
    rows += [{"run": reference.name, **row} for row in paper_models(arm, table)]
    columns = ["run", "model", "split", "effect", "location", "named_as", "minor", "rms_at_tool_mm", "title", "row"]
    return Measured(pd.DataFrame(rows), pd.DataFrame(names, columns=columns))


def rms_distance_mm(verdict: Diagnosis, recordings: Recordings) -> float:
    """RMS of the 3D distance between what a diagnosis predicts and what was measured, mm."""
    missed = predict(verdict.model, recordings) - recordings.positions
    return 1e3 * rms_distance(missed)


def rms_turn_mrad(verdict: Diagnosis, recordings: Recordings) -> float:
    """RMS of the angle between predicted and measured orientations, mrad; NaN where the diagnosis learned none."""
    if not verdict.model.tool_turns:
        return float("nan")
    turns = ORIENTATIONS.residual(verdict.model, verdict.model.posture(verdict.model.scene(recordings)))
    return 1e3 * float(np.sqrt(np.nanmean(np.sum(turns**2, axis=1))))


def effects_named(verdict: Diagnosis) -> list[dict[str, object]]:
    """The effects of a verdict as rows."""
    return [
        {
            "effect": effect.effect,
            "location": effect.location,
            "named_as": effect.named_as,
            "minor": effect.minor,
            "rms_at_tool_mm": effect.rms_at_tool_mm,
            "title": effect.title,
            "row": next((p.value for p in effect.parameters if p.name == "row"), np.nan),
        }
        for effect in verdict.effects
    ]


def paper_models(arm: Arm, table: Recordings) -> list[dict[str, object]]:
    """The paper's models at 85 identification rows, by least squares: rows of model, split, train, test, rms_mm."""
    sets = {each.name: each for each in real_measurements(arm, table, 0, PRINTED_COUNT).measurements.sets}
    train, test = sets.pop(IDENTIFICATION), next(iter(sets.values()))
    found: list[tuple[str, Array]] = [(UNCORRECTED, test.errors_mm[0])]
    for spec in PAPER_MODELS:
        inputs = train.inputs(spec)
        features = spec.features(inputs)
        if len(inputs) > len(features.term_names):
            coefficients, _ = fit_least_squares(features, inputs, train.errors_mm[0])
            left = test.errors_mm[0] - features.matrix(test.inputs(spec)) @ coefficients.T
            found.append((spec.name, left))
    sizes = {"split": 0, "train": len(train.motor_angles), "test": len(test.motor_angles)}
    return [{"model": name, "rms_mm": rms_distance(left), **sizes} for name, left in found]


def protocol_table(splits: pd.DataFrame, reference: ReferenceRun) -> pd.DataFrame:
    """One row per model of a run: mean, standard deviation and median over its splits beside the reference figures."""
    mine = splits[splits["run"] == reference.name]
    rows = []
    for model, group in mine.groupby("model", sort=False):
        figure = reference.figure(str(model))
        rows.append(
            {
                "run": reference.name,
                "model": model,
                "splits": len(group),
                "mean_mm": group["rms_mm"].mean(),
                "std_mm": group["rms_mm"].std(ddof=0),
                "median_mm": group["rms_mm"].median(),
                "turn_mrad": group["turn_mrad"].mean(),
                "reference_mm": figure[0] if figure else np.nan,
                "reference_std_mm": figure[1] if figure else np.nan,
                "best_mm": reference.lowest.mm if model == ARMSCOPE else np.nan,
                "best_by": reference.lowest.what if model == ARMSCOPE else "",
            }
        )
    return pd.DataFrame(rows)


COLUMNS = ("run", "region", "model", "train", "test", "rms_mm", "median_mm")


def regions(arm: Arm, recordings: Recordings) -> Iterator[tuple[str, Indices, Indices]]:
    """Parts of a table that are left out, each 30 % of the configurations: name, rows to learn from, rows left out.

    Args:
        arm: the nominal arm, by which points lie far out or high up.

    Returns:
        The last rows, the farthest from the base's axis, the highest, and those at the largest angles of joint 1.
    """
    tool = chain(arm, recordings.motor_angles).tool
    along = {
        "the last": np.arange(len(recordings), dtype=np.float64),
        "the farthest out": np.linalg.norm(tool[:, :2], axis=1),
        "the highest": tool[:, 2],
        "one side (joint 1)": recordings.motor_angles[:, 0],
    }
    configuration = named_configuration(recordings.run, recordings.id)
    for name, values in along.items():
        mean = np.bincount(configuration, values) / np.bincount(configuration)
        near = np.argsort(mean, kind="stable")[: int(CALIBRATING.train_share * len(mean))]
        inside = np.isin(configuration, near)
        yield name, np.flatnonzero(inside), np.flatnonzero(~inside)


def measure_regions(
    arm: Arm, recordings: Recordings, reference: ReferenceRun, tell: Callable[[str], None] = unheard
) -> pd.DataFrame:
    """How well plain calibrations and the diagnosis foretell regions that took no part; all see points alone.

    Args:
        arm: the nominal arm.
        recordings: all runs of a set.
        reference: which rows.
        tell: hears what is being done.

    Returns:
        A row per region and model: run, region, model, train, test (rows), rms_mm and median_mm of the 3D distance.
    """
    table = recordings.of_runs([reference.run], reference.first_id)
    rows = set_up(arm, table, one_base=False, tool_per_run=False)
    levels: list[Level] = [level for level in LEVELS if level != "compliance" or rows.loads is not None]
    found = []
    for region, train, outside in regions(arm, table):
        test = foretold(rows, train, outside)
        few = train[spread_evenly(len(train), reference.most_rows or len(train))]
        left: dict[str, Array] = {str(level): each for level, each in residuals_on(rows, levels, few, test).items()}
        verdict = diagnose(arm, table.rows(train), Settings(resamples=0, cross_validation=False, orientation=False))
        others = table.rows(test)
        left[ARMSCOPE] = predict(verdict.model, others) - others.positions
        for model, missed in left.items():
            distance = 1e3 * np.linalg.norm(missed, axis=1)
            sizes = (len(train), len(test), 1e3 * rms_distance(missed), float(np.median(distance)))
            found.append((reference.name, region, model, *sizes))
        tell(f"{reference.name}: without {region}, {ARMSCOPE} {found[-1][-2]:.3f} mm in {verdict.seconds:.0f} s")
    return pd.DataFrame(found, columns=list(COLUMNS))
