"""Which parts of the configuration each step of the paper follows, and their form inside the package."""

from __future__ import annotations

from armscope.config import Count, Identification, Model, Swarm, Tolerances, Tracker, Trajectories
from armscope.errormodels import ModelSpec
from armscope.inputs import Strict
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


class FitSettings(Strict):
    """`armscope paper fit`."""

    seed: int
    models: tuple[Model, ...]
    swarm: Swarm
    ensemble_seeds: Count


class SwarmStudySettings(Strict):
    """`armscope paper convergence`."""

    seed: int
    models: tuple[Model, ...]
    swarm: Swarm


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
