"""How much rows count: each joint by its noise, and by how many of its rows are independent.

What a model leaves of neighbouring rows is correlated. A joint whose residual has the autocorrelation time tau (in
rows) counts as if every tau-th of its rows had been recorded (Sokal 1997): evidence, intervals and folds know it
through the sums.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.inference.linear_algebra import lower_cholesky, solve_lower
from armscope.inference.normal_equations import NormalEquations, total
from armscope.measurement.robust import huber_weights
from armscope.motion.constants import NOISE, PRIOR
from armscope.motion.layout import TorqueLayout
from armscope.motion.rows import MotionRows


@dataclass(frozen=True, eq=False)
class TorqueWeights:
    """Attributes:
    sigma: (m,) standard deviation of what the model leaves of each joint's torque, N m.
    row: (K, m) 1 for an ordinary row, less for one that lies far from the model, 0 where the joint stands.
    correlated: (m,) autocorrelation time, rows; at least 1.
    """

    sigma: Array
    correlated: Array
    row: Array


def estimate_weights(rows: MotionRows, residuals: Array) -> TorqueWeights:
    """Noise and autocorrelation time of each joint, from what a model leaves, and what lies far from it.

    Args:
        rows: K rows.
        residuals: (K, m) N m.

    Returns:
        The weights.
    """
    sigma, correlated, row = [], [], []
    for j in range(residuals.shape[1]):
        moving, left = ~rows.still[:, j], residuals[:, j]
        least = max(NOISE.least_share * float(np.std(rows.torque[:, j])), 1e-9)
        weights = np.zeros(len(left))
        if moving.any():
            weights[moving] = huber_weights(left[moving, None], np.ones(int(moving.sum())), least)
        scale = float(np.sqrt(np.sum(weights * left**2) / max(weights.sum(), 1.0)))
        sigma.append(max(scale, least))
        correlated.append(_autocorrelation_time(rows, np.sqrt(weights) * left))
        row.append(weights)
    return TorqueWeights(np.array(sigma), np.array(correlated), np.column_stack(row))


def _autocorrelation_time(rows: MotionRows, left: Array) -> float:
    """1 + 2 x sum of the autocorrelation, up to the first lag that is five times the sum so far."""
    longest = min(NOISE.longest_lag, len(left) // 4)
    total = np.zeros(longest + 1)
    for stretch in np.unique(rows.stretch):
        part = left[rows.stretch == stretch]
        size = 2 ** int(np.ceil(np.log2(2 * len(part))))
        spectrum = np.abs(np.fft.rfft(part, size)) ** 2
        covariance = np.fft.irfft(spectrum, size)[: min(longest + 1, len(part))]
        total[: len(covariance)] += covariance
    if total[0] <= 0:
        return 1.0
    times = 1 + 2 * np.cumsum(total[1:] / total[0])
    lags = np.arange(1, len(times) + 1)
    enough = np.flatnonzero(lags >= NOISE.window * np.maximum(times, 1.0))
    return float(max(times[enough[0]] if len(enough) else times[-1] if len(times) else 1.0, 1.0))


def sums_by_block(rows: MotionRows, weights: TorqueWeights, block: Indices) -> list[NormalEquations]:
    """Sums over the rows of each block; the response is the measured torque less the nominal one, in units of noise.

    Args:
        rows: K rows.
        weights: of each joint.
        block: (K,) number of each row's block, from 0.

    Returns:
        One sum for each block; a unit is `PRIOR.unit` of the noise.
    """
    sums: list[NormalEquations | None] = [None] * (int(block.max()) + 1)
    runs = np.unique(rows.run) if rows.layout.differs_by_run else rows.run[:1]
    for number in range(len(sums)):
        for run in runs:
            which = block == number
            if len(runs) > 1:
                which &= rows.run == run
            if which.any() or sums[number] is None:
                part, so_far = _with_masses(_sums(rows, weights, which), rows.layout, str(run)), sums[number]
                sums[number] = part if so_far is None else so_far + part
    return [each for each in sums if each is not None]


def _sums(rows: MotionRows, weights: TorqueWeights, among: NDArray[np.bool_]) -> NormalEquations:
    """Over some rows, of the columns that rows hold."""
    response = rows.torque - rows.nominal
    G = np.zeros((rows.layout.width,) * 2)
    b, yy, n = np.zeros(rows.layout.width), 0.0, 0.0
    for j, (columns, at) in enumerate(zip(rows.columns, rows.at, strict=True)):
        which = np.flatnonzero(among & (weights.row[:, j] > 0))
        unit = PRIOR.unit / weights.sigma[j] * np.sqrt(weights.row[:, j])
        counts = 1 / weights.correlated[j]
        for some in np.array_split(which, max(-(-len(which) // NOISE.rows_at_once), 1)):
            X, y = columns[some].astype(np.float64) * unit[some, None], response[some, j] * unit[some]
            G[np.ix_(at, at)] += counts * (X.T @ X)
            b[at] += counts * (X.T @ y)
            yy += counts * float(y @ y)
            n += counts * float(weights.row[some, j].sum())
    return NormalEquations(G, b, yy, n)


def _with_masses(sums: NormalEquations, layout: TorqueLayout, run: str) -> NormalEquations:
    """With the columns that are combinations of inertial ones, which rows need not hold."""
    made, _ = layout.made_of_masses
    shares, inertial = layout.shares_in(run), layout.inertial
    G, b = sums.G, sums.b
    G[:, made] = G[:, inertial] @ shares
    G[made] = shares.T @ G[inertial]
    b[made] = shares.T @ b[inertial]
    return sums


def fitted_together(rows: MotionRows, among: Indices) -> Array:
    """(p,) coefficients of some columns at once, each as free as the others, joints in units of their own torque."""
    sums = sums_by_block(rows, _plain(rows), np.zeros(len(rows), dtype=np.intp))[0]
    return _solved(sums, among)


def left_apart(rows: MotionRows, among: Indices) -> Array:
    """(K, m) what some columns, fitted to the rest of the motion, leave of each part of it, N m."""
    part = np.arange(len(rows)) * NOISE.parts // len(rows) % NOISE.blocks_of_time
    sums = sums_by_block(rows, _plain(rows), part)
    left = np.empty_like(rows.torque)
    for number in range(len(sums)):
        rest = total([other for k, other in enumerate(sums) if k != number])
        modelled = rows.nominal + rows.modelled(_solved(rest, among))
        left[part == number] = (rows.torque - modelled)[part == number]
    return left


def _plain(rows: MotionRows) -> TorqueWeights:
    spread = np.maximum(np.std(rows.torque, axis=0), 1e-9)
    return TorqueWeights(spread, np.ones(rows.torque.shape[1]), (~rows.still).astype(np.float64))


def _solved(sums: NormalEquations, among: Indices) -> Array:
    scale = np.sqrt(np.maximum(np.diag(sums.G), 1e-300))
    used = among[np.diag(sums.G)[among] > 0]
    G = sums.G[np.ix_(used, used)] / np.outer(scale[used], scale[used])
    factor = lower_cholesky(G, np.full(len(used), NOISE.ridge))
    coefficients = np.zeros(len(scale))
    whitened = solve_lower(factor, sums.b[used] / scale[used])
    coefficients[used] = np.linalg.solve(factor.T, whitened) / scale[used]
    return coefficients
