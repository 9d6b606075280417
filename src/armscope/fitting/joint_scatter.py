"""Scatter that follows nothing in the table, but has a place: errors along one joint's turning that differ row by row.

Backlash without a record of the side of approach, a slipping coupling, a loose encoder: their size can't be predicted,
but their direction in space is that of one joint's Jacobian. The residual's covariance is then
noise^2 (I + sum over joints of (rho L)(rho L)') with the joint's lever L, and evidence for rho > 0 names the joint.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array, Indices
from armscope.fitting.constants import SCATTER
from armscope.fitting.linearisation import Chunks, Measured, linearised
from armscope.physics.effect import motor
from armscope.physics.model import FittedModel


@dataclass(frozen=True)
class Scattered:
    """Scatter at one motor: its size (rad, 1-sigma) and the evidence for it, nats."""

    motor: int
    size: float
    evidence: float


def motor_jacobians(model: FittedModel, table: Measured) -> Array:
    """(m, N, 3) displacement of the tool by each motor, base axes, mm/rad."""

    motors = [motor(j + 1) for j in range(model.arm.n_motors)]

    def of_part(chunks: Chunks) -> list[tuple[Indices, list[Array | None]]]:
        return [(rows, [posture.displacement(each) for each in motors]) for rows, posture in chunks]

    moved = np.empty((model.arm.n_motors, len(table), 3))
    for part in linearised(table).each_part(model, of_part):
        for rows, displacements in part:
            for j, displacement in enumerate(displacements):
                moved[j, rows] = displacement
    moved *= 1e3
    return moved


def find_scatter(residuals: Array, moved: Array, least_noise: float) -> list[Scattered]:
    """The joints at which the residual scatters more than elsewhere, one after the other while the evidence pays.

    Args:
        residuals: (N, 3) mm, base axes.
        moved: (m, N, 3) from `motor_jacobians`.
        least_noise: mm.

    Returns:
        Joint, size at it and evidence of each.
    """
    size = np.linalg.norm(residuals, axis=1)
    near = size <= np.quantile(size, 1 - SCATTER.trimmed)
    found: dict[int, float] = {}
    told: list[Scattered] = []
    for _ in range(min(SCATTER.most_places, len(moved))):
        start = [_likelihood(residuals[rows], moved[:, rows], found, least_noise) for rows in (slice(None), near)]
        best: tuple[float, int, float] | None = None
        for j, rho in _trials(moved, found, start[0][1]):
            tried = {**found, j: rho}
            gain = min(
                _likelihood(residuals[rows], moved[:, rows], tried, least_noise)[0] - before[0]
                for rows, before in zip((slice(None), near), start, strict=True)
            )
            if best is None or gain > best[0]:
                best = gain, j, rho
        if best is None or best[0] < SCATTER.price_nats:
            break
        found[best[1]] = best[2]
        noise = _likelihood(residuals, moved, found, least_noise)[1]
        told.append(Scattered(best[1] + 1, best[2] * noise, best[0] - SCATTER.price_nats))
    return told


def _trials(moved: Array, found: Mapping[int, float], noise: float) -> Iterator[tuple[int, float]]:
    """Motors and sizes (rad per mm of noise) to try."""
    for j, lever in enumerate(moved):
        reach = float(np.sqrt(np.mean(lever**2)))
        if j not in found and reach > 0:
            yield from ((j, ratio / reach) for ratio in SCATTER.ratios if ratio * noise / reach < SCATTER.largest_rad)


def _likelihood(residuals: Array, moved: Array, rho: Mapping[int, float], least: float) -> tuple[float, float]:
    """Log likelihood with the noise at its best, and that noise, mm."""
    V = _covariance(moved, rho)
    _, logdet = np.linalg.slogdet(V)
    squares = np.einsum("ni,ni->n", residuals, np.linalg.solve(V, residuals[:, :, None])[:, :, 0])
    n = residuals.size
    noise = max(float(np.sqrt(squares.sum() / n)), least, 1e-9)
    return float(-n * np.log(noise) - 0.5 * logdet.sum() - 0.5 * squares.sum() / noise**2), noise


def _covariance(moved: Array, rho: Mapping[int, float]) -> Array:
    """(N, 3, 3) covariance in units of the noise."""
    V = np.tile(np.eye(3), (moved.shape[1], 1, 1))
    for j, size in rho.items():
        V += size**2 * moved[j][:, :, None] * moved[j][:, None, :]
    return V


def noise_between(residuals: Array, moved: Array, found: Sequence[Scattered], least: float) -> float:
    """The noise that is left once scatter of the sizes found is taken out, mm.

    Args:
        residuals: (N, 3) mm, base axes.
        moved: (m, N, 3) from `motor_jacobians`.
        found: where it scatters.
        least: mm; the noise is never taken to be below.

    Returns:
        mm per axis.
    """
    noise = max(least, float(np.sqrt(np.mean(residuals**2))))
    for _ in range(20):
        noise = _likelihood(residuals, moved, {s.motor - 1: s.size / noise for s in found}, least)[1]
    return noise


def whitening(found: Sequence[Scattered], moved: Array, noise: float) -> Array | None:
    """(N, 3, 3) symmetric V^-1/2 per row; None without scatter.

    Args:
        found: where it scatters.
        moved: (m, N, 3) from `motor_jacobians`.
        noise: elsewhere, mm per axis.

    Returns:
        (N, 3, 3); rows that do not scatter keep their scale.
    """
    if not found:
        return None
    values, vectors = np.linalg.eigh(_covariance(moved, {s.motor - 1: s.size / noise for s in found}))
    return np.asarray((vectors / np.sqrt(values)[:, None, :]) @ np.swapaxes(vectors, 1, 2))
