"""From a step's settings to what is measured, varied and audited, in SI units."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from armscope.cli.paper_settings import (
    AuditSettings,
    MeasureSettings,
    ReachSettings,
    ScenarioSettings,
    specs_of,
    swarm_settings_of,
)
from armscope.cli.studies import parsed
from armscope.core.config import Sensitivity, Tracker
from armscope.paper.audit_scope import AuditScope
from armscope.paper.scenarios import Scenario, Varied, check_reach, scenarios
from armscope.paper.sensitivity import Fitting
from armscope.paper.virtual import PlannedPaths, PlannedPoses, Sizes, StudyPlan
from armscope.robot import Arm, load_arm
from armscope.world.of_the_paper import Tracker as VirtualTracker


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
    """`armscope.paper.scenarios.check_reach` of a study and of all its scenarios. Raises InputError: a point that can't
    be reached; it names scenario, arm, path, point and reason."""
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
