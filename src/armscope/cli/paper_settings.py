"""Which parts of the configuration each step of the paper follows, and their form inside the package."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from armscope.cli.studies import parsed
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
from armscope.errormodels import ModelSpec
from armscope.paper.audit import AuditScope
from armscope.paper.scenarios import Scenario, Varied, check_reach, scenarios
from armscope.paper.sensitivity import Fitting
from armscope.paper.study import PlannedPaths, PlannedPoses, Sizes, StudyPlan
from armscope.robot import Arm, load_arm
from armscope.swarm import SwarmSettings
from armscope.world.tracker import Tracker as VirtualTracker


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


def plan_of(settings: MeasureSettings, arm: Arm, robots: int | None = None) -> StudyPlan:
    """What a study assumes, in SI units.

    Args:
        settings: of the measurement: tolerances, trajectories, poses, tracker, size of the ensemble, seed.
        arm: the nominal arm.
        robots: drawn instead of the configured number, where given.

    Returns:
        The plan; lengths in m, angles in rad.
    """
    sizes, paths, poses = settings.tolerances, settings.trajectories, settings.identification
    links = (sizes.link_mm, sizes.link_mrad, sizes.base_mm, sizes.base_mrad)
    return StudyPlan(
        arm=arm,
        sizes=Sizes(*(size.value * 1e-3 for size in links)),
        paths=PlannedPaths(
            paths.corners_mm.value,
            paths.points_per_side.value,
            paths.spiral_starts_mm.value,
            paths.spiral_enlargement.value,
            paths.spiral_turns_pi.value,
            paths.spiral_points.value,
            paths.third_coordinate_rise_mm.value,
        ),
        poses=PlannedPoses(poses.poses.value, poses.candidates.value, poses.margin_rad.value, poses.motor_6_rad.value),
        tracker=tracker_of(settings.tracker),
        repeat_m=0.0,
        ensemble=settings.ensemble_robots if robots is None else robots,
        seed=settings.seed,
    )


def varied_of(chosen: Sensitivity, seed: int) -> Varied:
    """What the sensitivity study varies."""
    return Varied(
        arms=tuple(load_arm(path) for path in chosen.geometry.value),
        tolerances=chosen.tolerance_factors.value,
        margins_rad=chosen.margins_rad.value,
        motor_6_rad=chosen.motor_6_rad.value,
        corners_mm=chosen.corners_mm.value,
        rises_mm=chosen.rises_mm.value,
        repeats_mm=chosen.repeats_mm.value,
        together=chosen.together,
        seed=seed,
    )


def scenarios_of(settings: ReachSettings, arm: Arm) -> list[Scenario]:
    """Every scenario of the sensitivity study."""
    base = plan_of(settings, arm, settings.sensitivity.robots)
    return scenarios(base, varied_of(settings.sensitivity, settings.seed))


def follow_all(robot: Path | str, settings: Path | str) -> pd.DataFrame:
    """Follow the test paths of a study and of all its scenarios.

    Args:
        robot: robot.yaml.
        settings: file of `ReachSettings`.

    Returns:
        See `armscope.paper.scenarios.check_reach`.

    Raises:
        InputError: a point that can't be reached; it names scenario, arm, path, point and reason.
    """
    chosen, arm = parsed(ReachSettings, str(settings)), load_arm(robot)
    varied = [(f"{each.factor}: {each.level}", each.plan) for each in scenarios_of(chosen, arm)]
    return check_reach([("configured study", plan_of(chosen, arm)), *varied])


def fitting_of(settings: ScenarioSettings) -> Fitting:
    """How the scenarios' robots are fitted."""
    swarm, chosen = settings.swarm, settings.sensitivity
    seeds = range(settings.seed, settings.seed + chosen.seeds)
    improved = swarm_settings_of(swarm)
    return Fitting(specs_of(settings.models), improved, swarm.basis, swarm.layout, seeds, chosen.everything)


def tracker_of(tracker: Tracker) -> VirtualTracker:
    """The virtual tracker, in SI units."""
    x, y, z = (coordinate * 1e-3 for coordinate in tracker.position_mm.value)
    return VirtualTracker(
        position=(x, y, z),
        accuracy=tracker.accuracy_ppm.value * 1e-6,
        repeatability=tracker.repeatability_ppm.value * 1e-6,
        resolution=tracker.resolution_um.value * 1e-6,
        readings=tracker.readings.value,
    )


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


def audit_scope_of(settings: AuditSettings) -> AuditScope:
    """What the audit scans."""
    scanned, paths = settings.audit, settings.trajectories
    steps = round(scanned.largest_rise_mm.value / scanned.rise_step_mm.value)
    second, third = paths.spiral_starts_mm.value
    return AuditScope(
        rises=tuple(scanned.rise_step_mm.value * step for step in range(-steps, steps + 1)),
        low=scanned.box_low_mm.value,
        high=scanned.box_high_mm.value,
        corner_samples=scanned.corner_samples.value,
        first_corner=paths.corners_mm.value[0],
        spiral_starts=(second, third),
        seed=settings.seed,
    )
