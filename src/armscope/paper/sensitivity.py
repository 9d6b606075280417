"""The same claims under other assumptions: each scenario draws, measures, fits and judges robots of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from armscope.errormodels.features import FDP_CI, ModelSpec
from armscope.errormodels.fitted import SwarmFit
from armscope.errormodels.swarm_fit import FitProblem, fit_random_search, fit_swarms
from armscope.paper.anchoring import ANCHORED
from armscope.paper.claims import AS_PRINTED, IMPROVED, Evidence, judge_claims
from armscope.paper.enough_poses import enough_poses
from armscope.paper.method import PRINTED_BASIS, PRINTED_LAYOUT, as_printed
from armscope.paper.outlook import outlook, sub_volumes
from armscope.paper.printed import IDENTIFICATION
from armscope.paper.residuals import SPATIAL
from armscope.paper.scenarios import Scenario
from armscope.paper.virtual import measured
from armscope.swarm.settings import SwarmSettings

COLUMNS = ["scenario", "factor", "level", "key", "method", "verdict", "true", "robots", "share"]
"""What every table of scenarios has at least."""


@dataclass(frozen=True)
class Fitting:
    """How a scenario's robots are fitted."""

    specs: tuple[ModelSpec, ...]
    # settings, basis, layout: of the improved method
    settings: SwarmSettings
    basis: str
    layout: str
    seeds: Sequence[int]  # of the swarms, of either method
    everything: bool = False  # also random search and cross-validated extensions, which take most of the time


def judge_scenario(scenario: Scenario, fitting: Fitting) -> pd.DataFrame:
    """Every claim under one set of assumptions.

    Returns:
        Columns scenario, factor, level, those of `armscope.paper.claims.judge_claims`, and anchored_rank (place of the
        anchored robot's FDP(CI) residual on the identification poses among all, 1 the smallest) and robots_drawn.
    """
    plan = scenario.plan
    study, _ = measured(plan)
    measurements = study.measurements
    problems = measurements.fit_problems(fitting.specs, list(measurements.robots))
    printed = as_printed(fitting.settings)
    by_print = fit_swarms(problems, fitting.seeds, printed, PRINTED_BASIS, layout=PRINTED_LAYOUT)
    by_choice = fit_swarms(problems, fitting.seeds, fitting.settings, fitting.basis, layout=fitting.layout)
    evidence = {
        AS_PRINTED: Evidence.of(measurements, by_print, _blind(problems, fitting, PRINTED_BASIS, PRINTED_LAYOUT)),
        IMPROVED: Evidence.of(measurements, by_choice, _blind(problems, fitting, fitting.basis, fitting.layout)),
    }
    evidence[IMPROVED] = replace(
        evidence[IMPROVED],
        sub_volumes=sub_volumes(measurements),
        poses=enough_poses(plan, study),
        outlook=outlook(measurements, seed=plan.seed) if fitting.everything else pd.DataFrame(),
    )
    table, _ = judge_claims(evidence)
    where = {"scenario": scenario.name, "factor": scenario.factor, "level": scenario.level}
    rank, count = rank_of_anchored(evidence[IMPROVED].by_least_squares)
    return table.assign(**where, anchored_rank=rank, robots_drawn=count)[
        [*where, *table.columns, "anchored_rank", "robots_drawn"]
    ]


def _blind(problems: list[FitProblem], fitting: Fitting, basis: str, layout: str) -> list[SwarmFit]:
    if not fitting.everything:
        return []
    return fit_random_search(problems, fitting.seeds, fitting.settings, basis, layout)


def rank_of_anchored(cells: pd.DataFrame) -> tuple[int, int]:
    """(place of the anchored robot's 3D residual on the identification poses, robots in all); 0 where it is unknown."""
    place = (FDP_CI.name, IDENTIFICATION, SPATIAL)
    if place not in cells.columns or ANCHORED not in cells.index:
        return 0, len(cells)
    left = cells[place]
    return int(np.sum(left < left[ANCHORED])) + 1, len(cells)
