"""Which way is down: gravity's direction in the base frame, estimated from how everything that gives way does so.

An arm on a wedge whose description says it stands upright gives way in wrong directions. Where asked, gravity's
direction is free: the evidence for an arm that is elastic everywhere, as a function of it, has a maximum and a width.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from armscope.core.rotations import turned_by
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.diagnosis.constants import GRAVITY
from armscope.diagnosis.model_space import build_model_space
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.linearisation import point_residuals
from armscope.inference.constants import PRIORS
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.normal_equations import total
from armscope.inference.prices import half_line_gain
from armscope.inference.problem import Problem, build_problem
from armscope.measurement import robust
from armscope.measurement.noise import Noise
from armscope.measurement.row_weights import RowWeights
from armscope.physics.backgrounds import ELASTIC, FAMILIES, GEOMETRIC, TRANSMISSION, constants, gear_waves, springs
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.frames import free_frames
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.robot.arm import build_arm

HEMISPHERE = 2 * np.pi
"""Solid angle of the directions that compete."""


@dataclass(frozen=True, eq=False)
class GravityEstimate:
    """Gravity's direction where it is other than stated."""

    arm: Arm  # with gravity as estimated
    # angle, stderr: between stated and estimated direction, rad
    angle: float
    stderr: float
    evidence: float  # log odds for another direction than the stated one, nats


def estimate_gravity_direction(
    start: FittedModel, recordings: Recordings, noise: Noise, tool_per_run: bool
) -> GravityEstimate | None:
    """Gravity's direction, if the evidence is for another one than stated (odds of 20 to 1) and loads are known.

    Args:
        start: the arm with its frames fitted.
        recordings: the rows.
        noise: what is known of it.
        tool_per_run: whether the tool is free in every run.

    Returns:
        The arm with the direction found, its angle and interval, rad, and evidence, nats.
    """
    if not start.arm.has_masses:
        return None
    from scipy.optimize import minimize  # takes long to import, and is seldom needed

    rows = spread_evenly(len(recordings), GRAVITY.rows)
    objective = _NegativeLogEvidence(start, recordings.rows(rows), noise, tool_per_run)
    tried: list[Array] = [np.zeros(2)]
    for size in GRAVITY.leans_tried:
        sides = 2 * np.pi * np.arange(GRAVITY.azimuths) / GRAVITY.azimuths
        tried += list(size * np.column_stack([np.cos(sides), np.sin(sides)]))
    first = tried[int(np.argmin([objective(tilt) for tilt in tried]))]
    simplex = first + GRAVITY.first_step_rad * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    options: Any = {"xatol": GRAVITY.close_rad, "fatol": 0.05, "initial_simplex": simplex}
    best = np.asarray(minimize(objective, first, method="Nelder-Mead", options=options).x, dtype=np.float64)
    covariance = np.linalg.pinv(_curvature(objective, best), hermitian=True)
    width = 2 * float(np.pi * np.sqrt(max(float(np.linalg.det(covariance)), 1e-12)))
    gained = objective(np.zeros(2)) - objective(best) + min(float(np.log(width / HEMISPHERE)), 0.0)
    angle = float(np.linalg.norm(best))
    if gained < PRIORS.sure_nats or angle == 0:
        return None
    along = best / angle
    return GravityEstimate(
        turned(start.arm, best), angle, float(np.sqrt(max(float(along @ covariance @ along), 0.0))), gained
    )


def turned(arm: Arm, tilt: Array) -> Arm:
    """The arm with gravity turned by ``tilt`` (2,) rad about two axes across its stated direction."""
    across = np.linalg.svd(arm.gravity[None, :])[2][1:]
    gravity = turned_by(tilt @ across) @ arm.gravity
    return build_arm(arm.description.model_copy(update={"gravity_m_s2": tuple(float(g) for g in gravity)}))


class _NegativeLogEvidence:
    """Minus the evidence for an arm that is elastic everywhere, by gravity's direction."""

    def __init__(self, start: FittedModel, recordings: Recordings, noise: Noise, tool_per_run: bool) -> None:
        self.start, self.recordings, self.noise = start, recordings, noise
        self.frames = free_frames(recordings, tool_per_run)
        left = point_residuals(start, recordings)
        self.weights = RowWeights.of_positions(robust.huber_weights(left, np.ones(len(left)), noise.least_mm))
        self.known: dict[tuple[float, ...], float] = {}

    def __call__(self, tilt: Array) -> float:
        """Minus the evidence, nats, at the best sizes of geometric, elastic and gears' background."""
        key = tuple(float(t) for t in tilt)
        if key not in self.known:
            self.known[key] = self._evaluated(tilt)
        return self.known[key]

    def _evaluated(self, tilt: Array) -> float:
        arm = turned(self.start.arm, tilt)
        # columns of families that have no part in any of the sizes below would be formed a hundred times for nothing
        everywhere = {
            GEOMETRIC: constants(arm),
            ELASTIC: springs(arm, self.recordings),
            # a wave of a gear would be a load of another direction
            TRANSMISSION: gear_waves(self.recordings, PLAUSIBLE.waves),
        }
        space = build_model_space(self.frames, [everywhere.get(family, []) for family in FAMILIES], [])
        model = FittedModel(arm, self.start.bases, self.start.tools)
        blocks = np.zeros(len(self.recordings), dtype=np.intp)
        made = build_problem(
            space, total(normal_equations_by_block(space.layout, model, self.recordings, self.weights, blocks)), 0.0
        )
        start = max(made.mismatch, 1e-4)
        geometric, elastic, gears, *others = (range(family.sizes) for family in space.families)
        small = [0 for _ in others]
        sizes = [(g, e, w, *small) for g in (0, geometric[-1]) for e in elastic[1:] for w in gears]
        weighed = (evaluate(made, (), size, start) for size in sizes)
        return -max(each.log_posterior + _gives_along(made, each) for each in weighed)


def _gives_along(made: Problem, hypothesis: Hypothesis) -> float:
    """Nats for what gives way along its load, not against it: gravity turned round turns all of it round."""
    columns = made.space.families[FAMILIES.index(ELASTIC)].columns
    z_scores = hypothesis.means(columns) / np.sqrt(hypothesis.variances(columns))
    return half_line_gain(z_scores)


def _curvature(objective: _NegativeLogEvidence, at: Array) -> Array:
    """(2, 2) second derivatives by the tilt, nats per rad^2, by differences."""
    steps = GRAVITY.step_rad * np.eye(2)
    here = objective(at)
    H = np.empty((2, 2))
    for i in range(2):
        for j in range(2):
            if i == j:
                H[i, i] = (objective(at + steps[i]) - 2 * here + objective(at - steps[i])) / GRAVITY.step_rad**2
            else:
                mixed = sum(a * b * objective(at + a * steps[0] + b * steps[1]) for a in (1, -1) for b in (1, -1))
                H[i, j] = mixed / (4 * GRAVITY.step_rad**2)
    return H
