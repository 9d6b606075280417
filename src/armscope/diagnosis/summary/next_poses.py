"""Which poses to measure next: those where two readings that fit equally well predict the tool farthest apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from armscope.design.separation import nats_apart, separating
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.alternatives import Rival, discriminability
from armscope.diagnosis.summary.constants import NEXT_POSES
from armscope.fitting.design_matrix import point_columns
from armscope.inference.constants import PRIORS
from armscope.physics.drift import six_terms
from armscope.physics.effect import ONE
from armscope.physics.scene import Scene
from armscope.poses.obstacles import Surroundings, refusals
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.verdict.diagnosis import NextPoses
from armscope.verdict.effects import INDISTINGUISHABLE_NATS


def next_poses(
    state: DiagnosisState, rivals: Mapping[int, Sequence[Rival]], rng: np.random.Generator
) -> NextPoses | None:
    """Poses that separate the closest pair of readings; None where no two are close.

    Greedy: each next pose is the one where the two predictions differ most, measured against what the rival could still
    adapt to (its posterior covariance, updated after each choice) and the noise.

    Args:
        state: the finished selection.
        rivals: other readings by effect.
        rng: draws the poses that compete.

    Returns:
        Poses, payloads and how far the two predictions lie apart there, mm.
    """
    best, candidates = state.best, state.space.candidates
    pairs = [
        (discriminability(best, other, candidates[c], rival), candidates[c], rival, other)
        for c, found in rivals.items()
        for _, rival, other, *_ in found
    ]
    if not pairs:
        return None
    nats, effect, rival, other = min(pairs, key=lambda pair: pair[0])
    if nats > INDISTINGUISHABLE_NATS:
        return None
    arm = state.fit.model.arm
    table = _reachable(arm, state.recordings, rng)
    scene = Scene(arm, table)
    posture = scene.posture()
    X = point_columns(posture, state.space.layout.terms).reshape(len(table), 3, -1) / state.problem.scale
    # the poses will be a run of their own, with a base that is fitted anew
    new_base = point_columns(posture, six_terms("base", ONE)).reshape(len(table), 3, 6)
    p = X.shape[2]
    between = X @ (best.coefficients(p) - other.coefficients(p))
    covariance = other.noise**2 * other.inverse.T @ other.inverse
    k = len(covariance)
    with_base = np.zeros((k + 6, k + 6))
    with_base[:k, :k] = covariance
    with_base[k:, k:] = np.eye(6) * (PRIORS.frame_mm * 1e-3) ** 2
    adapting = np.concatenate([X[:, :, other.columns], new_base], axis=2)
    chosen, separation = separating(adapting, between, with_base, other.noise, NEXT_POSES.asked)
    repeats = next(
        (
            float(k)
            for k in range(1, NEXT_POSES.most_repeats + 1)
            if nats_apart(adapting[chosen], between[chosen], with_base, other.noise / np.sqrt(k))
            >= NEXT_POSES.decisive_nats
        ),
        float("inf"),
    )
    payload = np.zeros(len(chosen)) if table.payload is None else table.payload[chosen]
    return NextPoses(table.motor_angles[chosen], payload, separation, effect.label, rival.label, repeats)


def _reachable(arm: Arm, recordings: Recordings, rng: np.random.Generator) -> Recordings:
    """Random poses within the joint limits (where none are stated: the recorded range), with and without payload.

    Poses in which the arm would hit itself are left out, as far as its body is known (`armscope.poses.obstacles`).
    """
    low, high = recordings.motor_angles.min(axis=0), recordings.motor_angles.max(axis=0)
    stated = np.isfinite(arm.limits).all(axis=1)
    low, high = np.where(stated, arm.limits[:, 0], low), np.where(stated, arm.limits[:, 1], high)
    angles = rng.uniform(low, high, (NEXT_POSES.tried, arm.n_motors))
    heaviest = np.nanmax(recordings.payload) if recordings.payload is not None else 0.0
    run = np.full(NEXT_POSES.tried, "next")
    shape = (NEXT_POSES.tried, arm.n_motors)
    table = replace(
        recordings,
        motor_angles=angles,
        positions=np.full((NEXT_POSES.tried, 3), np.nan),
        run=run,
        target=np.full(NEXT_POSES.tried, recordings.target[-1]),
        id=np.arange(1, NEXT_POSES.tried + 1).astype(str),
        orientation=None,
        sigma=None,
        extra=None,
        torque=None,
        payload=rng.choice([0.0, heaviest or NEXT_POSES.payload_kg], NEXT_POSES.tried),
        approach=None if recordings.approach is None else rng.choice([-1.0, 1.0], shape),
        speed=None if recordings.speed is None else np.zeros(shape),
        time=None if recordings.time is None else np.full(NEXT_POSES.tried, np.nanmax(recordings.time)),
        temperature=None
        if recordings.temperature is None
        else np.full(NEXT_POSES.tried, np.nanmedian(recordings.temperature)),
    )
    possible = refusals(arm, angles, Surroundings()) == ""
    return table.rows(possible) if np.sum(possible) >= NEXT_POSES.asked else table
