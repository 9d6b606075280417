"""How far fitted values can be trusted when the model is wrong: standard errors that own up to what no effect explains.

The covariance of a fit, noise^2 * inverse normal matrix, holds if what is left is independent from row to row. On real
arms it is not: the set-up wanders, and every arm does things that no effect follows. A smooth error of that kind pulls
fitted values all the same way, however many rows there are. It is modelled as a Gaussian process of unknown size beside
the fit (Kennedy & O'Hagan 2001, "Bayesian calibration of computer models", sec. 4):

- the base moves, and it turns, at random in the order of recording: cosines along the rows whose size falls with their
  number, as the Karhunen-Loeve expansion of a centred random walk has it;
- each motor turns a little more or less from posture to posture: cosines of motor angles and products of two.

Each process' size is weighed by the evidence of the residuals, none at all among the sizes, beside those that showed
more clearly, and averaged over what the evidence leaves open: residuals that look like noise leave the covariance as it
is. Fitted values stay. They are linear in the readings, so an error Z u with u ~ N(0, s^2) moves them by A^-1 X'W Z u,
A being the penalised normal matrix, and their covariance gains s^2 (A^-1 X'WZ) (A^-1 X'WZ)'.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_triangular

from armscope.core.sampling import spread_evenly
from armscope.core.types import Array, Indices
from armscope.fitting.constants import DISCREPANCY
from armscope.fitting.design_matrix import component_rows, structured_design
from armscope.fitting.linearisation import linearised
from armscope.fitting.refit import Refit
from armscope.inference.constants import PRIORS
from armscope.inference.linear_algebra import lower_cholesky, quadratic_and_logdet, solve_lower
from armscope.measurement.whitening import WhitenedPosture
from armscope.physics.effect import AXES, ONE, Direction, motor, term
from armscope.physics.placing import moving_joints
from armscope.recordings import Recordings
from armscope.verdict.schema import Notice


@dataclass(frozen=True)
class Process:
    """One kind of error that no effect follows."""

    what: str  # in words
    rms_mm: float  # its RMS at the tool, per axis, in what the fit leaves
    evidence: float  # for it against none, its price as one of several paid, nats


@dataclass(frozen=True, eq=False)
class ModelError:
    """What no effect explains, and the covariance (p, p) of a fit's values with it, SI units; never below the fit's."""

    processes: tuple[Process, ...]
    covariance: Array

    def notices(self) -> list[Notice]:
        """What to say of it, where it is sure."""
        sure = [f"{p.what} ({p.rms_mm:.2g} mm)" for p in self.processes if p.evidence > PRIORS.sure_nats]
        if not sure:
            return []
        text = f"What is left is more than noise, and no effect explains it: {', '.join(sure)}. Intervals count it in."
        return [Notice("model error", text)]


def model_error(fit: Refit, recordings: Recordings, least_mm: float) -> ModelError:
    """The covariance of a fit's values with the errors that its residuals show beside noise.

    Args:
        fit: of the recordings.
        recordings: the rows.
        least_mm: the noise is never taken to be below.

    Returns:
        The covariance, SI, and the processes that it was widened by.
    """
    rows = spread_evenly(len(recordings), DISCREPANCY.most_rows)
    share = len(rows) / len(recordings)
    sums = _sums(fit, recordings, rows)
    factor = lower_cholesky(sums.normal / share, fit.noise**2 * fit.precision)
    taken_up = solve_lower(factor, sums.cross)
    moved = solve_triangular(factor, taken_up, lower=True, trans="T")
    # what residuals show of an error once the fit has taken up what it can; all in multiples of the noise
    noise = max(fit.noise, least_mm)
    own, pull = sums.own - taken_up.T @ taken_up, sums.pull / noise
    freedom = share * max(fit.equations.n - fit.effective_dof, 1.0)
    chi2 = freedom * (fit.noise / noise) ** 2
    odds = 1 / max(len(sums.of), 1)
    extra, processes, waiting = np.zeros_like(fit.covariance), [], dict(sums.of)
    while waiting:
        least = least_mm / noise
        weighed = {what: _weigh(own[at, at], pull[at], chi2, freedom, least, odds) for what, at in waiting.items()}
        clearest = max(weighed, key=lambda what: weighed[what].evidence)
        found = weighed[clearest]
        for what in [clearest] if found.evidence > 0 else list(waiting):
            at = waiting.pop(what)
            variance, left = noise**2 * weighed[what].variance, np.trace(own[at, at]) / sums.numbers
            processes.append(Process(what, float(np.sqrt(variance * left)), weighed[what].evidence))
            extra += variance / share**2 * moved[:, at] @ moved[:, at].T
        if found.evidence > 0:
            # the others are weighed beside it, and against the noise that it leaves
            at = sums.of[clearest]
            quieter = max(float(np.sqrt(found.chi2 / freedom)), least)
            noise, pull, chi2 = noise * quieter, pull / quieter, found.chi2 / quieter**2
            known = np.linalg.solve(own[at, at] + np.eye(len(pull[at])) * quieter**2 / found.likeliest, own[at])
            own, pull = own - own[:, at] @ known, pull - known.T @ pull[at]
    white = (noise / max(fit.noise, least_mm)) ** 2
    return ModelError(tuple(processes), _not_below(fit.covariance, white * fit.covariance + extra))


def _not_below(least: Array, covariance: Array) -> Array:
    """A covariance, each value's standard error raised to that of another one where it is less."""
    raised = np.sqrt(np.maximum(1.0, np.diag(least) / np.diag(covariance)))
    return np.asarray(covariance * np.outer(raised, raised))


class _Sums(NamedTuple):
    """Sums over rows of the columns Z of all processes, each process of 1 mm RMS at the tool."""

    normal: Array  # (p, p) X'WX of the fit's own columns
    own: Array  # (m, m) Z'WZ
    cross: Array  # (p, m) X'WZ
    pull: Array  # (m,) Z'Wr
    of: dict[str, slice]  # each process' columns
    numbers: int  # how many numbers the rows hold


def _sums(fit: Refit, recordings: Recordings, rows: Indices) -> _Sums:
    table = recordings if len(rows) == len(recordings) else recordings.rows(rows)
    motors = moving_joints(table)
    base = [term(axis, "m" if axis[0] == "t" else "rad", (Direction("base", axis), ONE)) for axis in AXES]
    turns = [term("turn", "rad", (motor(j), ONE)) for j in motors]
    slow, shapes = _slow(recordings, rows), _shapes(table.motor_angles[:, [j - 1 for j in motors]])
    order, p, wander = fit.layout.column_order, len(fit.layout.terms), 3 * slow.shape[1]
    starts = [0, wander, *(2 * wander + n * shapes.shape[1] for n in range(len(turns) + 1))]
    of = {what: slice(*at) for what, at in zip(_named(motors), pairwise(starts), strict=True) if at[0] < at[1]}
    count = starts[-1]
    normal, own, cross, pull = np.zeros((p, p)), np.zeros((count, count)), np.zeros((p, count)), np.zeros(count)
    for part, posture in linearised(table).chunks(fit.model):
        whitener = fit.weights.whitener(rows[part])
        seen = WhitenedPosture(posture, whitener)
        fitted, directions = structured_design(seen, order), component_rows(seen, (*base, *turns))
        moved = directions[:6, None] * slow[part].T[:, None], directions[6:, None] * shapes[part].T[:, None]
        Z = np.concatenate([each.reshape(-1, *directions.shape[1:]) for each in moved])
        flat = Z.reshape(count, -1)
        fitted.add_products(normal)
        own += flat @ flat.T
        cross += fitted.with_responses(Z)
        pull += flat @ whitener.response(fit.model, posture).T.reshape(-1)
    size, numbers = np.ones(count), fit.weights.whitener(rows).width * len(rows)
    for what, at in list(of.items()):
        size[at] = np.sqrt(np.trace(own[at, at]) / numbers)
        if size[at.start] < DISCREPANCY.tiny_mm:
            del of[what]
    size = np.maximum(size, DISCREPANCY.tiny_mm)
    cross = cross[order.back] / size
    return _Sums(order.whole(normal), own / np.outer(size, size), cross, pull / size, of, numbers)


def _named(motors: Sequence[int]) -> list[str]:
    """The processes in words."""
    base = ["the base moves in the order of rows", "the base turns in the order of rows"]
    return [*base, *(f"joint {j} errs from pose to pose" for j in motors)]


def _slow(recordings: Recordings, rows: Indices) -> Array:
    """(n, k) cosines along the table at some rows, in the order of time, or of the table where no time is recorded."""
    count = len(recordings)
    order = np.arange(count)
    if recordings.time is not None and np.isfinite(recordings.time).all():
        order[np.argsort(recordings.time, kind="stable")] = np.arange(count)
    waves = np.arange(1, min(DISCREPANCY.slow_waves, count // DISCREPANCY.rows_per_wave) + 1)
    return np.asarray(np.cos(np.pi * np.outer((order[rows] + 0.5) / count, waves)) / waves)


def _shapes(angles: Array) -> Array:
    """(N, k) a constant, cosines over the range of each of some motor angles (N, j), and products of two angles'."""
    low = angles.min(axis=0)
    along = (angles - low) / np.ptp(angles, axis=0)
    alone = [[np.sqrt(2) * np.cos(np.pi * k * x) / k for k in range(1, DISCREPANCY.waves + 1)] for x in along.T]
    shapes = [np.ones(len(angles)), *(wave for waves in alone for wave in waves)]
    shapes += [one * other for first, second in combinations(alone, 2) for one in first for other in second]
    return np.column_stack(shapes)


class _Weighed(NamedTuple):
    """A process' size squared, in multiples of the noise's: mean over what is likely, and the likeliest.

    ``chi2`` is what the likeliest leaves of the residuals' sum of squares, ``evidence`` in nats.
    """

    variance: float
    likeliest: float
    chi2: float
    evidence: float


def _weigh(own: Array, pull: Array, chi2: float, freedom: float, least: float, odds: float) -> _Weighed:
    """How likely each size of a process is: marginal likelihood, with the noise at its best for each size.

    Args:
        own: (m, m) Z'WZ once the fit is conditioned on, Z in multiples of the noise.
        pull: (m,) Z'Wr over the noise.
        chi2: sum of squared residuals over the noise squared.
        freedom: how many residuals are free.
        least: the noise's lower bound over the noise.
        odds: of the process, of any size, to none, beforehand.
    """

    def likelihood(quadratic: float, logdet: float) -> tuple[float, float]:
        left = max(chi2 - quadratic, 1e-9 * chi2)
        ratio = max(np.sqrt(left / freedom), least)
        return -freedom * float(np.log(ratio)) - 0.5 * left / ratio**2 - 0.5 * logdet, left

    sizes = np.array(DISCREPANCY.sizes)
    nothing, _ = likelihood(0.0, 0.0)
    nats, squares = [], []
    for quadratic, logdet in zip(*quadratic_and_logdet(own[None], pull[None], sizes[:, None, None]), strict=True):
        value, left = likelihood(float(quadratic[0]), float(logdet[0]))
        nats.append(value - nothing)
        squares.append(left)
    most = max(0.0, *nats)
    likely, none = odds / len(sizes) * np.exp(np.array(nats) - most), float(np.exp(-most))
    best = int(np.argmax(nats))
    return _Weighed(
        variance=float(likely @ sizes**2 / (likely.sum() + none)),
        likeliest=float(sizes[best] ** 2),
        chi2=squares[best],
        evidence=float(np.logaddexp.reduce(nats) + np.log(odds / len(sizes))),
    )
