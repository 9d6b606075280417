"""Which parts of the configuration each step of the paper follows, and their form inside the package."""

from __future__ import annotations

from armscope.core.config import Audit, Count, Identification, Model, Paper, Swarm, Tolerances, Tracker, Trajectories
from armscope.core.inputs import Strict
from armscope.core.variants import Variant
from armscope.errormodels import ModelSpec
from armscope.paper.audit import AuditScope
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


class AuditSettings(Strict):
    """`armscope paper audit`."""

    seed: int
    trajectories: Trajectories
    audit: Audit


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
