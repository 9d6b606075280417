"""Identification poses: well spaced within joint ranges, chosen by how well they show an arm's geometric errors.

The criterion is the observability index of Borm & Menq (1991), O1 = (s_1 s_2 ... s_p)^(1/p) / sqrt(n): the volume of
the ellipsoid that the identification Jacobian makes of the unit sphere of parameter errors, for p identifiable
parameters and n poses. It is the D-optimality of the design of experiments. Driels & Pathre (1990) add that poses
should fill the joints' ranges: candidates come from a low-discrepancy sequence over them, and each is used once.

The study's poses stay those that this exchange finds: `armscope.design.exchange`, which tries every chosen pose against
every candidate from several starts, finds other optima, and would make another study of it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from armscope.core.types import Array, Indices

IDENTIFIABLE = 1e-6  # A combination of parameters counts as identifiable above this share of the largest singular value

EXCHANGES = 200
RANDOM_DRAWS = 50  # Choices at random that the index is compared with


@dataclass(frozen=True)
class ChosenPoses:
    """Rows chosen from candidates, and what the choice is worth."""

    rows: Indices  # (n,) indices of the chosen candidates, ascending
    index: float  # observability index O1 of the chosen
    random_index: float  # median O1 of as many candidates taken at random
    n_parameters: int  # p, identifiable combinations of parameters


def candidate_poses(low: ArrayLike, high: ArrayLike, count: int, seed: int) -> Array:
    """(count, m) motor angles spread evenly between ``low`` and ``high`` (m,) rad; held motors have low = high.

    A scrambled Halton sequence over the motors that move.

    Args:
        low, high: (m,) rad.
        count: how many.
        seed: of the scrambling.

    Returns:
        (count, m) rad.
    """
    from scipy.stats import qmc  # takes half a second: seldom needed

    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    moving = np.flatnonzero(high > low)
    poses = np.tile(low, (count, 1))
    spread = qmc.Halton(len(moving), rng=np.random.default_rng(seed)).random(count)
    poses[:, moving] = low[moving] + spread * (high - low)[moving]
    return poses


def joint_ranges(motor_angles: ArrayLike, margin: float) -> tuple[Array, Array]:
    """(low, high) of ``motor_angles`` (N, m), widened by ``margin`` rad for the motors that move."""
    angles = np.asarray(motor_angles, dtype=float)
    low, high = angles.min(axis=0), angles.max(axis=0)
    moves = high - low > 1e-9
    return low - margin * moves, high + margin * moves


def choose_identification_poses(jacobian: Array, count: int, rng: np.random.Generator) -> ChosenPoses:
    """The ``count`` candidates with the largest observability index, by greedy growth and then exchanges.

    Args:
        jacobian: (N, 3, K) identification Jacobian of N candidates: displacement of the tool per parameter, each in
            units of its tolerance, so that metres and radians compare.
        count: how many to choose, at most N.
        rng: draws the random choices that the index is compared with.

    Returns:
        The chosen rows, their index, and the median index of random choices.

    Raises:
        ValueError: fewer candidates than poses, or too few poses for the parameters.
    """
    n_candidates = len(jacobian)
    if count > n_candidates:
        raise ValueError(f"{count} poses from {n_candidates} candidates: there must be at least as many candidates")
    reduced = _identifiable(jacobian)
    n_parameters = reduced.shape[2]
    if 3 * count < n_parameters:
        raise ValueError(f"{count} poses for {n_parameters} parameters: a pose gives 3 numbers, so more are needed")
    chosen = _exchanged(reduced, _grown(reduced, count))
    random = [_index(reduced, rng.choice(n_candidates, count, replace=False)) for _ in range(RANDOM_DRAWS)]
    return ChosenPoses(np.sort(chosen), _index(reduced, chosen), float(np.median(random)), n_parameters)


def _identifiable(jacobian: Array) -> Array:
    """The Jacobian by the combinations of parameters that the candidates can show at all."""
    _, singular, directions = np.linalg.svd(jacobian.reshape(-1, jacobian.shape[2]), full_matrices=False)
    kept = directions[singular > IDENTIFIABLE * singular[0]]
    return np.asarray(jacobian @ kept.T)


def _index(reduced: Array, rows: Indices) -> float:
    """O1 of some rows."""
    stacked = reduced[rows].reshape(-1, reduced.shape[2])
    sign, log_determinant = np.linalg.slogdet(stacked.T @ stacked)
    if sign <= 0:
        return 0.0
    return float(np.exp(0.5 * log_determinant / reduced.shape[2]) / np.sqrt(len(rows)))


def _gains(reduced: Array, information: Array) -> Array:
    """(N,) by what factor each candidate multiplies the information's determinant: det(1 + J M^-1 J')."""
    gram: Array = np.eye(3) + (reduced @ np.linalg.inv(information)) @ np.swapaxes(reduced, 1, 2)
    return np.asarray(np.linalg.det(gram))


def _grown(reduced: Array, count: int) -> Indices:
    """Greedy: at each step the candidate that multiplies the determinant most."""
    scale = np.einsum("nij,nij->", reduced, reduced) / len(reduced) / reduced.shape[2]
    information = 1e-6 * scale * np.eye(reduced.shape[2])  # lets the first poses be compared; without weight later
    free = np.ones(len(reduced), dtype=bool)
    chosen = []
    for _ in range(count):
        gains = np.where(free, _gains(reduced, information), -np.inf)
        best = int(np.argmax(gains))
        chosen.append(best)
        free[best] = False
        information = information + reduced[best].T @ reduced[best]
    return np.array(chosen)


def _exchanged(reduced: Array, chosen: Indices) -> Indices:
    """Fedorov's exchange, one pose at a time: the pose that is missed least makes room for the one that adds most."""
    chosen = chosen.copy()
    for _ in range(EXCHANGES):
        stacked = reduced[chosen].reshape(-1, reduced.shape[2])
        inverse = np.linalg.inv(stacked.T @ stacked)
        mine = reduced[chosen]
        losses = np.linalg.det(np.eye(3) - (mine @ inverse) @ np.swapaxes(mine, 1, 2))
        out = int(np.argmax(losses))
        without = np.delete(chosen, out)
        stacked = reduced[without].reshape(-1, reduced.shape[2])
        gains = _gains(reduced, stacked.T @ stacked)
        gains[without] = -np.inf
        best = int(np.argmax(gains))
        if best == chosen[out] or gains[best] <= gains[chosen[out]] * (1 + 1e-9):
            break
        chosen[out] = best
    return chosen
