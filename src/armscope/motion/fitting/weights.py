"""How much rows count: each joint by its noise, and by how many of its rows are independent.

What a model leaves of neighbouring rows is correlated. A joint whose residual has the autocorrelation time tau (in
rows) counts as if every tau-th of its rows had been recorded (Sokal 1997): evidence, intervals and folds know it
through the sums.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.linear_algebra import lower_cholesky, solve_lower
from armscope.inference.normal_equations import NormalEquations, total
from armscope.inference.problem import Problem
from armscope.measurement.robust import huber_weights
from armscope.motion.constants import NOISE, PRIOR
from armscope.motion.fitting.rows import MotionRows
from armscope.motion.fitting.sums import JointSums, sums_by_joint
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.samples.constants import FILTER


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

    @property
    def lasting(self) -> Array:
        """(m,) its power times its autocorrelation time: the density of its spectrum at rest."""
        return np.asarray(self.sigma**2 * self.correlated)

    def where_better(self, other: TorqueWeights) -> TorqueWeights:
        """At each joint those of which less lasts."""
        return self._where(self.lasting <= other.lasting, other)

    def not_far_above(self, calm: TorqueWeights | None) -> TorqueWeights:
        """At each joint those of an earlier model where that left less, and much less that lasts.

        A name that is barely not worth its price goes, what it explained counts as noise, and then nothing is worth a
        price any more. But what another model explains, on other motion, too, is no noise.
        """
        if calm is None:
            return self
        own = (self.lasting <= NOISE.grown * calm.lasting) | (self.sigma <= calm.sigma)
        return self._where(own, calm)

    def _where(self, own: NDArray[np.bool_], other: TorqueWeights) -> TorqueWeights:
        pairs = ((self.sigma, other.sigma), (self.correlated, other.correlated), (self.row, other.row))
        return TorqueWeights(*(np.where(own, one, two) for one, two in pairs))


def estimate_weights(rows: MotionRows, residuals: Array, elsewhere: Array | None = None) -> TorqueWeights:
    """Noise and autocorrelation time of each joint, from what a model leaves, and what lies far from it.

    Args:
        rows: K rows.
        residuals: (K, m) N m.
        elsewhere: (K, m) N m, as `noise_of` has it.

    Returns:
        The weights.
    """
    row = np.zeros(residuals.shape)
    for j, least in enumerate(_least(rows)):
        moving, left = ~rows.still[:, j], residuals[:, j]
        if moving.any():
            row[moving, j] = huber_weights(left[moving, None], np.ones(int(moving.sum())), least)
    return noise_of(rows, residuals, row, elsewhere)


def noise_of(rows: MotionRows, residuals: Array, row: Array, elsewhere: Array | None = None) -> TorqueWeights:
    """Noise and autocorrelation time of each joint, from what a model leaves.

    A fit takes part of the noise up, and of noise that lasts most of all: it leaves (I - H) e of a block's noise e,
    while numbers from the other blocks leave (I - H)^-1 of that. So the product of both has the noise's own power,
    e' e, in the mean. It is never less than what the fit leaves: where the product is, the other blocks do not
    foretell this motion, and what the fit leaves counts alone.

    Args:
        rows: K rows.
        residuals: (K, m) N m.
        row: (K, m) how much each counts; none where 0.
        elsewhere: (K, m) N m, what numbers from the other blocks leave of each; the residuals where not given.

    Returns:
        The weights.
    """
    count, root = np.maximum(row.sum(axis=0), 1.0), np.sqrt(row)
    least = np.sum(row * residuals**2, axis=0) / count
    product = least if elsewhere is None else np.sum(row * residuals * elsewhere, axis=0) / count
    power = np.maximum(product, least)
    other = residuals if elsewhere is None else np.where(product > least, elsewhere, residuals)
    pairs = zip((root * residuals).T, (root * other).T, strict=True)
    correlated = [autocorrelation_time(rows.stretch, *pair) for pair in pairs]
    return TorqueWeights(np.maximum(np.sqrt(power), _least(rows)), np.array(correlated), row)


def left_elsewhere(
    rows: MotionRows, block: Indices, blocks: Mapping[int, NormalEquations], problem: Problem, best: Hypothesis
) -> Array:
    """What a hypothesis leaves of each block by numbers from the others.

    A number that no other block knows, such as a run's own load, stays as it is: without it the load would be noise.

    Args:
        rows: K rows.
        block: (K,) number of each row's block.
        blocks: sums by these numbers; rows of no such block are left as they are.
        problem: what competes.
        best: the hypothesis.

    Returns:
        (K, m) N m; what is measured beyond the nominal torque where there is no block or no other.
    """
    left, known = rows.torque - rows.nominal, best.coefficients(len(problem.scale))
    for number in blocks if len(blocks) > 1 else ():
        rest = total([own for other, own in blocks.items() if other != number])
        fitted = evaluate(problem.with_equations(rest), best.chosen, best.background, best.noise)
        told = np.diag(rest.G) > FILTER.rounding * np.diag(problem.equations.G) * problem.scale**2
        which = np.flatnonzero(block == number)
        found = np.where(told, fitted.coefficients(len(problem.scale)), known)
        left[which] -= rows.modelled(found / problem.scale, which)
    return rows.without_pauses(left)


def _least(rows: MotionRows) -> Array:
    return np.asarray(np.maximum(NOISE.least_share * np.std(rows.torque, axis=0), 1e-9))


def autocorrelation_time(stretches: Indices, left: Array, other: Array | None = None) -> float:
    """1 + 2 x sum of the autocorrelation, up to the first lag that is five times the sum so far.

    Args:
        stretches: (K,) number of the stretch that each row belongs to.
        left: (K,) what a model leaves of them.
        other: (K,) what else it leaves of them, with which ``left`` is multiplied; itself where not given.

    Returns:
        Rows, at least 1.
    """
    longest = min(NOISE.longest_lag, len(left) // 4)
    total = np.zeros(longest + 1)
    for stretch in np.unique(stretches):
        part = left[stretches == stretch]
        size = 2 ** int(np.ceil(np.log2(2 * len(part))))
        first = np.fft.rfft(part, size)
        second = first if other is None else np.fft.rfft(other[stretches == stretch], size)
        spectrum = (np.conj(first) * second).real
        covariance = np.fft.irfft(spectrum, size)[: min(longest + 1, len(part))]
        total[: len(covariance)] += covariance
    if total[0] <= 0:
        return 1.0
    times = 1 + 2 * np.cumsum(total[1:] / total[0])
    lags = np.arange(1, len(times) + 1)
    enough = np.flatnonzero(lags >= NOISE.window * np.maximum(times, 1.0))
    return float(max(times[enough[0]] if len(enough) else times[-1] if len(times) else 1.0, 1.0))


def weighed(rows: MotionRows, parts: Iterable[JointSums], weights: TorqueWeights) -> NormalEquations:
    """Sums of all joints together, in units of `PRIOR.unit` of the noise, as many rows as are independent.

    Args:
        rows: that they are sums over.
        parts: of the joints.
        weights: their noise.

    Returns:
        The sums, with the columns that are combinations of inertial ones.
    """
    layout = rows.layout
    by_run: dict[str, NormalEquations] = {}
    counts = 1 / weights.correlated
    unit = counts * (PRIOR.unit / weights.sigma) ** 2
    for part in parts:
        if part.run not in by_run:
            by_run[part.run] = NormalEquations(np.zeros((layout.width,) * 2), np.zeros(layout.width), 0.0, 0.0)
        so_far, own, j = by_run[part.run], part.sums, part.joint
        gain = rows.gain_of_columns(j)
        so_far.G[np.ix_(part.at, part.at)] += unit[j] * own.G * np.outer(gain, gain)
        so_far.b[part.at] += unit[j] * own.b * gain
        by_run[part.run] = NormalEquations(
            so_far.G, so_far.b, so_far.yy + unit[j] * own.yy, so_far.n + counts[j] * own.n
        )
    none = NormalEquations(np.zeros((layout.width,) * 2), np.zeros(layout.width), 0.0, 0.0)  # where no joint takes part
    return total([none, *(_with_masses(sums, layout, run) for run, sums in by_run.items())])


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
    plain = _plain(rows)
    parts = sums_by_joint(rows, plain.row, np.zeros(len(rows), dtype=np.intp))[0]
    return _solved(weighed(rows, parts, plain), among)


def left_inside_and_apart(rows: MotionRows, choices: Sequence[Indices]) -> Iterator[tuple[Array, Array]]:
    """What some columns leave of a motion that they are fitted to, and of each part of it, fitted to the rest.

    Args:
        rows: K rows.
        choices: which columns, more than once.

    Yields:
        Of each choice both, (K, m) N m.
    """
    part, plain = np.arange(len(rows)) * NOISE.parts // len(rows) % NOISE.blocks_of_time, _plain(rows)
    sums = [weighed(rows, parts, plain) for parts in sums_by_joint(rows, plain.row, part)]
    rests = [total([other for k, other in enumerate(sums) if k != number]) for number in range(len(sums))]
    whole, beyond = total(sums), rows.torque - rows.nominal
    for among in choices:
        apart = beyond.copy()
        for number, rest in enumerate(rests):
            which = np.flatnonzero(part == number)
            apart[which] -= rows.modelled(_solved(rest, among), which)
        inside = beyond - rows.modelled(_solved(whole, among))
        yield rows.without_pauses(inside), rows.without_pauses(apart)


def _plain(rows: MotionRows) -> TorqueWeights:
    spread = np.maximum(np.std(rows.torque, axis=0), 1e-9)
    return TorqueWeights(spread, np.ones(rows.torque.shape[1]), (~rows.still).astype(np.float64))


def _solved(sums: NormalEquations, among: Indices) -> Array:
    scale = np.sqrt(np.maximum(np.diag(sums.G), 1e-300))
    used = among[np.diag(sums.G)[among] > FILTER.rounding * sums.yy]  # of what moves nothing nothing is told
    G = sums.G[np.ix_(used, used)] / np.outer(scale[used], scale[used])
    factor = lower_cholesky(G, np.full(len(used), NOISE.ridge))
    coefficients = np.zeros(len(scale))
    whitened = solve_lower(factor, sums.b[used] / scale[used])
    coefficients[used] = np.linalg.solve(factor.T, whitened) / scale[used]
    return coefficients
