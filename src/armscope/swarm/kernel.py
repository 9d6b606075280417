"""The particle swarm on least squares as compiled code (numba): the algorithm of `engine`, `LANES` swarms in step.

What makes it fast: one pass per particle that draws the random numbers, moves it and judges it while it is in the
nearest cache; and memory laid out with `LANES` swarms side by side, so that each innermost loop is one instruction for
several swarms (each with its own SFC64 stream - a single stream can't be drawn in parallel). No lane looks at another,
and the arithmetic of the moves is that of `velocity_update` in the same order without fused multiply-adds, so a
swarm's result depends neither on its lane nor on its neighbours.

Array shapes, all flat: cells = particles x dimensions x (position, velocity, personal best) x lanes; anything "per
lane" has `LANES` values, the fastest index.
"""

from __future__ import annotations

from collections.abc import Sequence

import numba
import numpy as np
from numpy.typing import NDArray

from armscope.swarm.least_squares import LeastSquares
from armscope.swarm.result import StopReason, SwarmResult, final_reason
from armscope.swarm.settings import SwarmSettings
from armscope.swarm.streams import set_sfc64_states, sfc64_states

Array = NDArray[np.float64]

LANES = 16
_LANES = np.uint64(LANES)  # unsigned indices spare numba's test for negative ones, which would keep loops scalar
_CELL = np.uint64(3 * LANES)
_STEP = 2.0**-53
_WHOLE, _THRESHOLD, _DIVERGED = 0, 1, 2

compiled = numba.njit(cache=True, nogil=True, error_model="numpy")


def run_kernel(
    problems: LeastSquares,
    lower: Array,
    upper: Array,
    generators: Sequence[np.random.Generator],
    settings: SwarmSettings,
) -> SwarmResult:
    """What `minimise` does for ``problems``, compiled. Bounds are S x D; the generators must be SFC64."""
    swarms, dimensions = problems.targets.shape
    states = sfc64_states(generators)
    rule, count = settings.rule, settings.iterations
    coefficients = np.array([rule.coefficients(i, count) for i in range(count)]).reshape(count, 3)
    clamped = settings.velocity_clamp is not None
    speed_limits = (upper - lower) * settings.velocity_clamp if clamped else np.zeros_like(lower)
    positions, fitness = np.full((swarms, dimensions), np.nan), np.full(swarms, np.inf)
    history, iterations = np.empty((swarms, count + 1)), np.empty(swarms, dtype=np.int64)
    codes = np.empty(swarms, dtype=np.int64)
    _run_packs(
        np.ascontiguousarray(problems.factors, dtype=float),
        np.ascontiguousarray(problems.factor_of, dtype=np.int64),
        np.ascontiguousarray(problems.targets, dtype=float),
        np.ascontiguousarray(problems.rests, dtype=float),
        problems.is_orthonormal,
        np.ascontiguousarray(lower),
        np.ascontiguousarray(upper - lower),
        speed_limits,
        clamped,
        settings.particles,
        coefficients,
        settings.neighbourhood == "ring",
        -np.inf if settings.threshold is None else float(settings.threshold),
        states,
        positions,
        fitness,
        history,
        iterations,
        codes,
        _LANES,
    )
    set_sfc64_states(generators, states)
    early = {_THRESHOLD: StopReason.THRESHOLD, _DIVERGED: StopReason.DIVERGED}
    reasons = np.empty(swarms, dtype=object)
    reasons[:] = [early.get(code) or final_reason(best) for code, best in zip(codes.tolist(), fitness, strict=True)]
    return SwarmResult(positions, fitness, history, iterations, reasons)


@compiled
def _run_packs(
    factors, factor_of, targets, rests, orthonormal, lower, width, speed_limits, clamped, particles, coefficients,
    ring, threshold, states, positions, fitness, history, iterations, codes, lanes,
):  # fmt: skip
    """Run all swarms, `LANES` at a time; the last pack repeats the last swarm, which gives the same result again."""
    swarms, dimensions = targets.shape
    stream = np.empty(4 * LANES, dtype=np.uint64)
    cells = np.empty(particles * dimensions * 3 * LANES)
    leaders = np.empty((particles if ring else 1) * dimensions * LANES)
    best_fitness = np.empty(particles * LANES)
    factor = np.empty(dimensions * dimensions * LANES)
    target, limit, rest = np.empty(dimensions * LANES), np.empty(dimensions * LANES), np.empty(LANES)
    chosen = np.empty(LANES, dtype=np.int64)
    for first in range(0, swarms, LANES):
        for lane in range(LANES):
            swarm = min(first + lane, swarms - 1)
            chosen[lane] = swarm
            rest[lane] = rests[swarm]
            for k in range(4):
                stream[k * LANES + lane] = states[swarm, k]
            for d in range(dimensions):
                target[d * LANES + lane] = targets[swarm, d]
                limit[d * LANES + lane] = speed_limits[swarm, d]
                for column in range(dimensions):
                    factor[(d * dimensions + column) * LANES + lane] = factors[factor_of[swarm], d, column]
        _place(stream, cells, chosen, lower, width, particles, dimensions)
        _run_pack(
            stream, cells, leaders, best_fitness, factor, target, rest, limit, clamped, orthonormal, particles,
            dimensions, coefficients, ring, threshold, chosen, states, positions, fitness, history, iterations, codes,
            lanes,
        )  # fmt: skip


@compiled
def _run_pack(
    stream, cells, leaders, best_fitness, factor, target, rest, limit, clamped, orthonormal, particles, dimensions,
    coefficients, ring, threshold, chosen, states, positions, fitness, history, iterations, codes, lanes,
):  # fmt: skip
    """One pack from its placed particles to its end."""
    count = len(coefficients)
    judged, image = np.empty(LANES), np.empty(dimensions * LANES)
    better, finite = np.empty(LANES, dtype=np.int64), np.empty(LANES, dtype=np.int64)
    pack_best, pack_leader = np.empty(LANES), np.empty(LANES, dtype=np.int64)
    at_work = np.ones(LANES, dtype=np.bool_)
    best_fitness[:] = np.inf
    for iteration in range(count + 1):
        finite[:] = 0
        for particle in range(particles):
            cell = np.uint64(particle * dimensions * 3 * LANES)
            if iteration > 0:
                leader = np.uint64(particle * dimensions * LANES if ring else 0)
                inertia, cognitive, social = coefficients[iteration - 1]
                _move(stream, cells, cell, leaders, leader, limit, clamped, inertia, cognitive, social, dimensions, lanes)
            _judge(cells, cell, factor, target, rest, orthonormal, judged, image, dimensions, lanes)
            _remember(cells, cell, best_fitness, np.uint64(particle * LANES), judged, better, finite, dimensions, lanes)
        _lead(cells, best_fitness, leaders, ring, pack_best, pack_leader, particles, dimensions)
        working = 0
        for lane in range(LANES):
            if not at_work[lane]:
                continue
            swarm = chosen[lane]
            history[swarm, iteration] = pack_best[lane]
            reached = pack_best[lane] < threshold
            gone = finite[lane] == 0 and not _any_finite(cells, lane, particles, dimensions)
            if not (reached or gone or iteration == count):
                working += 1
                continue
            at_work[lane] = False
            codes[swarm] = _THRESHOLD if reached else (_DIVERGED if gone else _WHOLE)
            iterations[swarm] = iteration
            history[swarm, iteration:] = pack_best[lane]
            for k in range(4):
                states[swarm, k] = stream[k * LANES + lane]
            if pack_best[lane] < np.inf:
                fitness[swarm] = pack_best[lane]
                for d in range(dimensions):
                    best = (pack_leader[lane] * dimensions + d) * 3 + 2
                    positions[swarm, d] = cells[best * LANES + lane]
        if working == 0:
            break


@compiled
def _place(stream, cells, chosen, lower, width, particles, dimensions):
    """Every particle at rest, uniformly distributed in the search box."""
    for cell in range(particles * dimensions):
        for lane in range(LANES):
            a, b = stream[lane], stream[LANES + lane]
            c, counter = stream[2 * LANES + lane], stream[3 * LANES + lane]
            drawn = a + b + counter
            stream[lane] = b ^ (b >> np.uint64(11))
            stream[LANES + lane] = c + (c << np.uint64(3))
            stream[2 * LANES + lane] = ((c << np.uint64(24)) | (c >> np.uint64(40))) + drawn
            stream[3 * LANES + lane] = counter + np.uint64(1)
            swarm, d = chosen[lane], cell % dimensions
            start = lower[swarm, d] + width[swarm, d] * (np.float64(np.int64(drawn >> np.uint64(11))) * _STEP)
            cells[cell * 3 * LANES + lane] = start
            cells[(cell * 3 + 1) * LANES + lane] = 0.0
            cells[(cell * 3 + 2) * LANES + lane] = start


@compiled
def _move(stream, cells, cell, leaders, leader, limit, clamped, inertia, cognitive, social, dimensions, lanes):
    """One particle's velocity update and step; SFC64 (Doty-Humphrey's PractRand, as in numpy) twice per dimension."""
    bound = np.uint64(0)
    for _ in range(dimensions):
        for lane in range(lanes):
            a = stream[lane]
            b = stream[_LANES + lane]
            c = stream[_LANES + _LANES + lane]
            counter = stream[_CELL + lane]
            drawn = a + b + counter
            counter += np.uint64(1)
            a = b ^ (b >> np.uint64(11))
            b = c + (c << np.uint64(3))
            c = ((c << np.uint64(24)) | (c >> np.uint64(40))) + drawn
            # below 2^53, so the signed conversion is exact; it is one instruction, the unsigned one is many
            r1 = np.float64(np.int64(drawn >> np.uint64(11))) * _STEP
            drawn = a + b + counter
            counter += np.uint64(1)
            stream[lane] = b ^ (b >> np.uint64(11))
            stream[_LANES + lane] = c + (c << np.uint64(3))
            stream[_LANES + _LANES + lane] = ((c << np.uint64(24)) | (c >> np.uint64(40))) + drawn
            stream[_CELL + lane] = counter
            r2 = np.float64(np.int64(drawn >> np.uint64(11))) * _STEP
            position = cells[cell + lane]
            own_pull = (cells[cell + _LANES + _LANES + lane] - position) * r1 * cognitive
            social_pull = (leaders[leader + lane] - position) * r2 * social
            velocity = cells[cell + _LANES + lane] * inertia + own_pull + social_pull
            if clamped:
                if velocity < -limit[bound + lane]:
                    velocity = -limit[bound + lane]
                if velocity > limit[bound + lane]:
                    velocity = limit[bound + lane]
            cells[cell + _LANES + lane] = velocity
            cells[cell + lane] = position + velocity
        cell += _CELL
        leader += _LANES
        bound += _LANES


@compiled
def _judge(cells, cell, factor, target, rest, orthonormal, judged, image, dimensions, lanes):
    """The RMS residual sqrt(|R z - b|^2 + rest) of one particle, into ``judged``."""
    for lane in range(lanes):
        judged[lane] = 0.0
    if orthonormal:
        row = np.uint64(0)
        for _ in range(dimensions):
            for lane in range(lanes):
                gap = cells[cell + lane] - target[row + lane]
                judged[lane] += gap * gap
            cell += _CELL
            row += _LANES
    else:
        # column by column, so that no sum waits for its own last term; the zeros below the diagonal are skipped
        image[:] = -target
        for column in range(dimensions):
            for row in range(column + 1):
                entry = np.uint64((row * dimensions + column) * LANES)
                into = np.uint64(row * LANES)
                for lane in range(lanes):
                    image[into + lane] += factor[entry + lane] * cells[cell + lane]
            cell += _CELL
        into = np.uint64(0)
        for _ in range(dimensions):
            for lane in range(lanes):
                judged[lane] += image[into + lane] * image[into + lane]
            into += _LANES
    for lane in range(lanes):
        judged[lane] = np.sqrt(judged[lane] + rest[lane])


@compiled
def _remember(cells, cell, best_fitness, best, judged, better, finite, dimensions, lanes):
    """Take over one particle's position as its best where it is better; NaN and infinity never are."""
    improved = 0
    for lane in range(lanes):
        better[lane] = judged[lane] < best_fitness[best + lane]
        finite[lane] += judged[lane] < np.inf
        improved += better[lane]
        best_fitness[best + lane] = judged[lane] if better[lane] else best_fitness[best + lane]
    if improved == 0:
        return
    for _ in range(dimensions):
        for lane in range(lanes):
            kept = cells[cell + _LANES + _LANES + lane]
            cells[cell + _LANES + _LANES + lane] = cells[cell + lane] if better[lane] else kept
        cell += _CELL


@compiled
def _lead(cells, best_fitness, leaders, ring, pack_best, pack_leader, particles, dimensions):
    """Whom the particles follow in the next iteration, and the best of each swarm."""
    pack_best[:] = np.inf
    pack_leader[:] = 0
    for particle in range(particles):
        for lane in range(LANES):
            candidate = best_fitness[particle * LANES + lane]
            if candidate < pack_best[lane]:
                pack_best[lane] = candidate
                pack_leader[lane] = particle
    for particle in range(particles if ring else 1):
        for lane in range(LANES):
            followed = pack_leader[lane]
            if ring:
                followed = particle
                for neighbour in ((particle - 1) % particles, (particle + 1) % particles):
                    if best_fitness[neighbour * LANES + lane] < best_fitness[followed * LANES + lane]:
                        followed = neighbour
            for d in range(dimensions):
                best = (followed * dimensions + d) * 3 + 2
                leaders[(particle * dimensions + d) * LANES + lane] = cells[best * LANES + lane]


@compiled
def _any_finite(cells, lane, particles, dimensions):
    """Whether any particle of a lane still has a finite position."""
    for particle in range(particles):
        finite = True
        for d in range(dimensions):
            finite = finite and np.isfinite(cells[(particle * dimensions + d) * 3 * LANES + lane])
        if finite:
            return True
    return False
