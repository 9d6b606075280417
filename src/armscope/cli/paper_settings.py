"""Which parts of the configuration each step of the paper follows; and the swarm's, in the form of the package."""

from __future__ import annotations

from armscope.core.config import (
    Audit,
    Count,
    Identification,
    Method,
    Model,
    Paper,
    Sensitivity,
    Swarm,
    Tolerances,
    Tracker,
    Trajectories,
)
from armscope.core.inputs import Strict
from armscope.core.variants import Variant
from armscope.errormodels.features import ModelSpec
from armscope.swarm.settings import SwarmSettings


class MeasureSettings(Strict):
    """`armscope paper measure`."""

    seed: int
    tolerances: Tolerances
    ensemble_robots: int
    identification: Identification
    trajectories: Trajectories
    tracker: Tracker


class ReachSettings(MeasureSettings):
    """`armscope paper reach`: the study, and what is varied."""

    sensitivity: Sensitivity


class ScenarioSettings(ReachSettings):
    """`armscope paper scenario`: also how it is fitted."""

    models: tuple[Model, ...]
    swarm: Swarm


class MethodSettings(Strict):
    """`armscope paper method`."""

    seed: int
    models: tuple[Model, ...]
    swarm: Swarm
    method: Method


class SwarmStudySettings(Strict):
    """`armscope paper fit` and `armscope paper convergence`."""

    seed: int
    models: tuple[Model, ...]
    swarm: Swarm

    @property
    def seeds(self) -> range:
        """The swarms' seeds, counted from the study's."""
        return range(self.seed, self.seed + self.swarm.seeds)


class SweepSettings(Strict):
    """`armscope sweep run`."""

    seed: int
    basis: str
    layout: str
    engine: str
    variant: Variant


class RealSettings(Strict):
    """`armscope paper measure-real`."""

    seed: int
    poses: Count
    run: str | None
    first_id: int | None


class ReportedArm(Strict):
    """A real arm in the report: where its results are, or why there are none."""

    title: str
    folder: str | None = None
    reason: str | None = None


class ReportSettings(Strict):
    """`armscope paper report`."""

    seed: int
    paper: Paper
    real: tuple[ReportedArm, ...]


class FigureSettings(Strict):
    """`armscope paper figures`."""

    tracker: Tracker
    figures: tuple[str, ...]


class AuditSettings(Strict):
    """`armscope paper audit`."""

    seed: int
    trajectories: Trajectories
    audit: Audit


def specs_of(models: tuple[Model, ...]) -> tuple[ModelSpec, ...]:
    """The error models to fit."""
    return tuple(ModelSpec(model.family, model.order, model.space) for model in models)


def swarm_settings_of(swarm: Swarm) -> SwarmSettings:
    """The swarms' settings."""
    return SwarmSettings(
        particles=swarm.particles,
        iterations=swarm.iterations,
        update=swarm.update,
        neighbourhood=swarm.neighbourhood,
        velocity_clamp=swarm.velocity_clamp,
        threshold=swarm.threshold_mm,
    )
