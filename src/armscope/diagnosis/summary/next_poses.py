"""Which poses to measure next: those where two readings that fit equally well predict the tool farthest apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from armscope.design.separation import separating
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.constants import NEXT_POSES
from armscope.diagnosis.summary.reachable import checked_in_words, free_space, reachable
from armscope.diagnosis.summary.rivals import Rival, discriminability
from armscope.diagnosis.summary.settling import OpenQuestion
from armscope.fitting.design_matrix import point_columns
from armscope.inference.constants import PRIORS
from armscope.physics.drift import six_terms
from armscope.physics.drivers import follows
from armscope.physics.effect import ONE, Term
from armscope.physics.scene import Scene
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
        (discriminability(best, rival.hypothesis, candidates[c], rival.candidate), candidates[c], rival)
        for c, found in rivals.items()
        for rival in found
    ]
    if not pairs:
        return None
    nats, effect, rival = min(pairs, key=lambda pair: pair[0])
    other = rival.hypothesis
    if nats > INDISTINGUISHABLE_NATS:
        return None
    arm = state.fit.model.arm
    terms = [state.space.layout.terms[column] for column in (*effect.columns, *rival.candidate.columns)]
    around = free_space(arm, state.recordings, state.floor)
    table = reachable(arm, state.recordings, around, _follow_load(terms), rng)
    if not len(table):
        nowhere = checked_in_words(arm, around, state.floor is None, 0)
        return NextPoses(
            table.motor_angles, np.empty(0), np.empty(0), effect.label, rival.candidate.label, np.inf, nowhere
        )
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
    question = OpenQuestion(
        state.problem, best, effect, rival, X[chosen], new_base[chosen], with_base.diagonal()[k:].copy()
    )
    repeats = question.times(rng)
    payload = np.full(len(chosen), np.nan) if table.payload is None else table.payload[chosen]
    checked = checked_in_words(arm, around, state.floor is None, len(chosen))
    return NextPoses(
        table.motor_angles[chosen], payload, separation, effect.label, rival.candidate.label, repeats, checked
    )


def _follow_load(terms: Sequence[Term]) -> bool:
    """Whether any of the two readings depends on what is carried: else a payload tells nothing."""
    products = [product for each in terms for product in each.products]
    return any(follows(what, product.driver) for product in products for what in ("load", "payload"))
