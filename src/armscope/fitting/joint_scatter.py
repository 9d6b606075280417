"""Scatter that follows nothing in the table, but has a place: errors along one joint's turning that differ row by row.

Backlash without a record of the side of approach, a slipping coupling, a loose encoder: their size can't be predicted,
but their direction in space is that of one joint's Jacobian. The residual's covariance is then
noise^2 (I + sum over joints of (rho L)(rho L)') with the joint's lever L, and evidence for rho > 0 names the joint.

Bad shots have no place, but a Gaussian alone would rather give them one than call them unlikely. So a share of the rows
may be strays, whose density is wide, has heavy tails, and is the same whether a joint scatters or not.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.types import Array, Indices
from armscope.fitting.constants import SCATTER
from armscope.fitting.linearisation import Chunks, Measured, linearised
from armscope.physics.effect import motor
from armscope.physics.model import FittedModel


@dataclass(frozen=True)
class Scattered:
    """Scatter at one motor."""

    motor: int  # counted from 1
    size: float  # rad, 1-sigma
    evidence: float  # for it, nats
    rounded: bool = False  # whether it is that of angles that were rounded before they were written down


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
    found: dict[int, float] = {}
    told: list[Scattered] = []
    for _ in range(min(SCATTER.most_places, len(moved))):
        before, noise = _likelihood(residuals, moved, found, least_noise)
        tried = [
            (_likelihood(residuals, moved, {**found, j: rho}, least_noise)[0] - before, j, rho)
            for j, rho in _trials(moved, found, noise)
        ]
        gain, j, rho = max(tried, default=(0.0, 0, 0.0))
        if gain < SCATTER.price_nats:
            break
        found[j] = rho
        noise = _likelihood(residuals, moved, found, least_noise)[1]
        told.append(Scattered(j + 1, rho * noise, gain - SCATTER.price_nats))
    return told


def find_rounding(residuals: Array, moved: Array, steps: Array, least_noise: float) -> list[Scattered]:
    """Where rows scatter, as `find_scatter`, if the angles in the table may have been rounded.

    Poses may have been commanded in round numbers, without any error: so it is believed where the residuals show it.

    Args:
        residuals: (N, 3) mm, base axes.
        moved: (m, N, 3) from `motor_jacobians`.
        steps: (m,) rad, in which each motor's angles stand, 0 where in none.
        least_noise: mm.

    Returns:
        Rounding at all motors, where it is believed, and what scatters beside it.
    """
    alone = find_scatter(residuals, moved, least_noise)
    rounded = [Scattered(int(j) + 1, float(steps[j]) / np.sqrt(12), 0.0, True) for j in np.flatnonzero(steps)]
    if not rounded:
        return alone
    noise = noise_between(residuals, moved, rounded, least_noise)
    gain = (
        _likelihood(residuals, moved, _in_units_of(noise, rounded), least_noise)[0]
        - _likelihood(residuals, moved, {}, least_noise)[0]
    )
    white = whitening(rounded, moved, noise)
    assert white is not None
    beside = find_scatter(
        np.einsum("nij,nj->ni", white, residuals), np.einsum("nij,mnj->mni", white, moved), least_noise
    )
    if gain + _evidence(beside) < _evidence(alone) + SCATTER.price_of_rounding_nats:
        return alone
    return [*(replace(each, evidence=gain / len(rounded)) for each in rounded), *beside]


def log_likelihood(residuals: Array, moved: Array, found: Sequence[Scattered], least_noise: float) -> float:
    """How probable residuals are with some scatter, nats: of two models of the same rows the better one has more.

    Every row counts: those that fit nothing are strays, which are improbable.

    Args:
        residuals: (N, 3) mm, base axes.
        moved: (m, N, 3) from `motor_jacobians`.
        found: what scatters.
        least_noise: mm.

    Returns:
        Nats.
    """
    rho = _in_units_of(noise_between(residuals, moved, found, least_noise), found)
    return _likelihood(residuals, moved, rho, least_noise)[0]


def gain_of_law(
    residuals: Array, moved: Array, found: Sequence[Scattered], motor: int, along: Array, least_noise: float
) -> tuple[float, float]:
    """How much better rows scatter along something else than along a joint's turning alike in every row.

    Args:
        residuals: (N, 3) mm, base axes.
        moved: (m, N, 3) from `motor_jacobians`.
        found: what scatters.
        motor: whose scatter it would be in place of, from 1.
        along: (N, 3) mm by which one unit of it moves the tool.
        least_noise: mm.

    Returns:
        Nats, each at its best size, and that size in those units, 1 sigma.
    """
    reach = [float(np.sqrt(np.mean(each**2))) for each in (moved[motor - 1], along)]
    if not reach[1] > 0:
        return -np.inf, 0.0
    by_law = moved.copy()
    by_law[motor - 1] = along * (reach[0] / reach[1])

    def best(columns: Array) -> tuple[float, float]:
        tried = [
            [replace(each, size=each.size * (share if each.motor == motor else 1.0)) for each in found]
            for share in SCATTER.shares_of_size
        ]
        fits = [log_likelihood(residuals, columns, each, least_noise) for each in tried]
        at = int(np.argmax(fits))
        return fits[at], next(each.size for each in tried[at] if each.motor == motor)

    (alike, _), (otherwise, size) = best(moved), best(by_law)
    return otherwise - alike, size * reach[0] / reach[1]


def _evidence(found: Sequence[Scattered]) -> float:
    return sum(each.evidence for each in found)


def _in_units_of(noise: float, found: Sequence[Scattered]) -> dict[int, float]:
    """Sizes by motor (from 0), rad per mm of noise; rounding and scatter of one motor add up as variances."""
    rho: dict[int, float] = {}
    for each in found:
        rho[each.motor - 1] = float(np.hypot(rho.get(each.motor - 1, 0.0), each.size / noise))
    return rho


def _trials(moved: Array, found: Mapping[int, float], noise: float) -> Iterator[tuple[int, float]]:
    """Motors and sizes (rad per mm of noise) to try."""
    for j, lever in enumerate(moved):
        reach = float(np.sqrt(np.mean(lever**2)))
        if j not in found and reach > 0:
            yield from ((j, ratio / reach) for ratio in SCATTER.ratios if ratio * noise / reach < SCATTER.largest_rad)


def _likelihood(residuals: Array, moved: Array, rho: Mapping[int, float], least: float) -> tuple[float, float]:
    """Log likelihood with the noise and the share of strays at their best, and that noise, mm."""
    V = _covariance(moved, rho)
    _, logdet = np.linalg.slogdet(V)
    squares = np.einsum("ni,ni->n", residuals, np.linalg.solve(V, residuals[:, :, None])[:, :, 0])
    wide = _density_of_strays(residuals, max(least, 1e-9))
    return max(_with_strays(squares, logdet, wide, share, max(least, 1e-9)) for share in SCATTER.strays)


def _density_of_strays(residuals: Array, least: float) -> Array:
    """(N,) log density of each row if it were a stray: Cauchy's in three dimensions, some times as wide as the rows."""
    squares = np.einsum("ni,ni->n", residuals, residuals)
    width2 = SCATTER.width_of_strays**2 * max(float(np.median(squares)) / 3, least**2)
    return np.asarray(-2 * np.log(np.pi) - 1.5 * np.log(width2) - 2 * np.log1p(squares / width2))


def _with_strays(squares: Array, logdet: Array, wide: Array, share: float, least: float) -> tuple[float, float]:
    """Log likelihood where such a share are strays, and the noise of the others, by expectation and maximisation."""
    noise2 = max(float(np.median(squares)) / 3, least**2)
    for step in range(SCATTER.steps_of_noise + 1):
        own = np.log1p(-share) - 0.5 * (3 * np.log(2 * np.pi * noise2) + logdet + squares / noise2)
        together = np.logaddexp(own, np.log(share) + wide)
        if step < SCATTER.steps_of_noise:
            belongs = np.exp(own - together)
            noise2 = max(float(belongs @ squares / max(3 * belongs.sum(), 1.0)), least**2)
    return float(together.sum()), float(np.sqrt(noise2))


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
        noise = _likelihood(residuals, moved, _in_units_of(noise, found), least)[1]
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
    values, vectors = np.linalg.eigh(_covariance(moved, _in_units_of(noise, found)))
    return np.asarray((vectors / np.sqrt(values)[:, None, :]) @ np.swapaxes(vectors, 1, 2))
