"""A virtual arm with what it conceals, ready to be measured in its own session."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.robot.description_file import load_description
from armscope.world.constants import ROUGH
from armscope.world.effect_placement import choose, visibilities, visibilities_in_runs
from armscope.world.judge import Judge, Visibility
from armscope.world.kinds import Scene
from armscope.world.rough import blemishes, rough_description, rough_noise
from armscope.world.session import random_session
from armscope.world.spec import LARGEST_PAYLOAD_KG, WorldSpec
from armscope.world.statics import Hidden, balance
from armscope.world.strength import Frames, Sized, make_scene

TEST_ROWS = 100
BAD_SHARE = 0.02
TO_TEN_NANOMETRES = 7


@dataclass(frozen=True, eq=False)
class VirtualArm:
    """An arm, the session it was recorded in, and what it conceals."""

    spec: WorldSpec  # what it was made from
    scene: Scene  # the nominal arm in the whole session, recorded and held-out rows, in order of time
    nominal: Array  # (N, 3) tool points of the nominal arm, m
    # recorded, held_out: rows for the diagnosis and rows that test
    recorded: Indices
    held_out: Indices
    chosen: tuple[Sized, ...]
    # how well those of the story (not `minor`) can be found, in their order, if nobody says what a run is
    seen: tuple[Visibility, ...]
    judge: Judge
    frames: Frames  # registration and tool error
    noise: np.random.Generator  # generator of the measurement noise, fresh


def conceal(spec: WorldSpec, robots: Path) -> VirtualArm:
    """The virtual arm of a specification; the same one gives the same arm."""
    poses, effects, noise, rough = (np.random.default_rng(seed) for seed in np.random.SeedSequence(spec.seed).spawn(4))
    description = rough_description(load_description(robots / f"{spec.arm}.yaml"), spec.rough, rough)
    # thermal growth needs a hall that warms up
    grows = any(asked.kind == "thermal_expansion" for asked in spec.effects)
    warming = 8.0 if grows else ROUGH.day_k if "day" in spec.rough else 2.0
    warming *= float(poses.uniform(1, 2))
    payload = LARGEST_PAYLOAD_KG[spec.arm]
    session = random_session(description, poses, spec.rows + TEST_ROWS, spec.poses, payload, warming)
    scene, nominal = make_scene(description, session)
    order = poses.permutation(spec.rows + TEST_ROWS)
    recorded, held_out = np.sort(order[: spec.rows]), np.sort(order[spec.rows :])
    seen_by_all = scene.rows(recorded)
    judge = Judge(seen_by_all, nominal[recorded])
    sigma = spec.sigma_mm * 1e-3
    chosen = choose(seen_by_all, judge, spec, blemishes(seen_by_all, spec.rough, rough), effects)
    story = [size for size in chosen if not size.minor]
    seen = visibilities(judge, story, chosen if spec.rough else story, sigma)
    return VirtualArm(
        spec, scene, nominal, recorded, held_out, tuple(chosen), tuple(seen), judge, _random_frames(effects), noise
    )


def seen_in_runs(arm: VirtualArm) -> tuple[Visibility, ...]:
    """How well the story's effects can be found where the table says the runs: each has a base frame of its own."""
    story = [size for size in arm.chosen if not size.minor]
    run = arm.scene.session.run[arm.recorded]
    return tuple(visibilities_in_runs(arm.judge, story, arm.seen, arm.spec.sigma_mm * 1e-3, run))


def _random_frames(rng: np.random.Generator) -> Frames:
    """Instrument set up to a few mm and mrad, tool point known to about 1 mm."""
    return Frames(rng.uniform(-5e-3, 5e-3, 3), rng.uniform(-1.2e-3, 1.2e-3, 3), rng.uniform(-1e-3, 1e-3, 3))


def true_points(arm: VirtualArm, scene: Scene) -> tuple[Array, Array]:
    """Where the tool truly is in the measurement frame (N, 3), m, and the motors' gravity torques there (N, m), N m."""
    hidden = Hidden.nothing(scene.geometry, scene.session)
    for size in arm.chosen:
        size.effect.hide(hidden, scene)
    hidden.layout = replace(hidden.layout, tool_error=arm.frames.tool_error)
    balanced = balance(scene.geometry, scene.session, hidden)
    # the tool's error is part of the mechanism already
    points = replace(arm.frames, tool_error=np.zeros(3)).place(balanced.tool, scene.tool_turn)
    return points, balanced.motor_torque if np.any(balanced.motor_torque) else scene.torque


@dataclass(frozen=True, eq=False)
class Measured:
    """All rows of a virtual arm's own session as measured; m and N m."""

    points: Array  # (N, 3) true places in the measurement frame
    noise: Array  # (N, 3), bad shots included
    bad: NDArray[np.bool_]  # (N,) rows that are bad shots
    torque: Array  # (N, m) gravity's torque on the motors

    @property
    def readings(self) -> Array:
        """(N, 3) what the instrument says, m."""
        return (self.points + self.noise).round(TO_TEN_NANOMETRES)


def measure_session(arm: VirtualArm) -> Measured:
    """The arm measured in the session it was made for; bad shots only among the recorded rows."""
    points, torque = true_points(arm, arm.scene)
    rng, sigma = arm.noise, arm.spec.sigma_mm * 1e-3
    if arm.spec.noise == "heavy_tails":
        noise = sigma * rng.standard_t(3, points.shape)
    else:
        noise = sigma * (rough_noise(points, rng) if arm.spec.noise == "rough" else rng.normal(size=points.shape))
    bad = np.zeros(len(points), dtype=bool)
    if arm.spec.noise == "outliers":
        struck = rng.choice(arm.recorded, max(1, round(BAD_SHARE * len(arm.recorded))), replace=False)
        bad[struck] = True
        direction = rng.normal(size=(len(struck), 3))
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        noise[struck] += direction * rng.uniform(1e-3, 10e-3, (len(struck), 1))
    return Measured(points, noise, bad, torque)
