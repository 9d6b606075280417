"""The swarm's loops as compiled code; all in one file, since numba's cache does not notice a change in another.

What makes it fast: each particle is moved (random numbers and all), judged and remembered while it is in the nearest
cache; and memory is laid out with `LANES` swarms side by side, so that an innermost loop does several swarms with one
instruction. Each swarm has its own SFC64 stream: a single stream can't be drawn in parallel. Moves do the arithmetic of
`velocity_update` in the same order, without fused multiply-adds: they agree with the NumPy engine's to the last bit.

``lanes`` is always LANES, but not known to the compiler: it would unroll short loops of known length into scalars.
"""

from __future__ import annotations

import numba
import numpy as np

from armscope.core.types import Array
from armscope.swarm.kernel_data import LANES, Outcome, Pack, Problems, Words
from armscope.swarm.streams import WEIGHT_UNIT

ROW_BLOCK = 4  # rows of the triangular product that are computed in one loop

# Unsigned, since indices that might be negative would keep numba's loops scalar.
_NONE, ONE, _TWO, _THREE, _FOUR, _FIVE = (np.uint64(k * LANES) for k in range(6))
_UNIT = 2.0**-53  # numpy makes uniform doubles of a word's upper 53 bits
_LOWER_HALF, _HALF = np.uint64(2**32 - 1), np.uint64(32)
THRESHOLD, DIVERGED, OTHER = 0, 1, 2  # why a swarm stopped

_compiled = numba.njit(cache=True, nogil=True, error_model="numpy")


@_compiled
def run_packs(given: Problems, outcome: Outcome, pack: Pack, lanes: np.uint64) -> None:
    """All swarms, pack by pack; the last pack repeats the last swarm, which gives the same result again.

    Args:
        given: the problems.
        outcome: filled by this.
        pack: room for the state of one pack.
        lanes: `LANES`.
    """
    swarms = len(given.targets)
    for first in range(0, swarms, LANES):
        for lane in range(LANES):
            pack.swarms[lane] = min(first + lane, swarms - 1)
        _load(given, outcome.states, pack)
        _place(given, pack)
        _run_pack(given, outcome, pack, lanes)


@_compiled
def _load(given: Problems, states: Words, pack: Pack) -> None:
    """Lay the pack's problems and streams out lane by lane."""
    dimensions = given.targets.shape[1]
    padded = len(pack.image) // LANES
    for lane in range(LANES):
        swarm, factor = pack.swarms[lane], given.factor_of[pack.swarms[lane]]
        pack.tally[LANES + lane] = given.rests[swarm]
        pack.at_work[lane] = True
        for k in range(4):
            pack.stream[k * LANES + lane] = states[swarm, k]
        for aim in range(len(pack.aims) // (3 * LANES)):
            pack.aims[(aim * 3 + 1) * LANES + lane] = given.targets[swarm, aim % dimensions]
            pack.aims[(aim * 3 + 2) * LANES + lane] = given.speed_limits[swarm, aim % dimensions]
        if given.orthonormal:
            continue
        for column in range(dimensions):
            for row in range(column + 1):
                pack.factor[(column * padded + row) * LANES + lane] = given.factors[factor, row, column]


@_compiled
def _place(given: Problems, pack: Pack) -> None:
    """Every particle at rest, uniformly distributed in the search box."""
    dimensions, stream = given.targets.shape[1], pack.stream
    for cell in range(given.particles * dimensions):
        for lane in range(LANES):
            a, b = stream[lane], stream[LANES + lane]
            c, counter = stream[2 * LANES + lane], stream[3 * LANES + lane]
            drawn = a + b + counter
            stream[lane] = b ^ (b >> np.uint64(11))
            stream[LANES + lane] = c + (c << np.uint64(3))
            stream[2 * LANES + lane] = ((c << np.uint64(24)) | (c >> np.uint64(40))) + drawn
            stream[3 * LANES + lane] = counter + np.uint64(1)
            swarm, d = pack.swarms[lane], cell % dimensions
            share = np.float64(np.int64(drawn >> np.uint64(11))) * _UNIT
            start = given.lower[swarm, d] + given.width[swarm, d] * share
            pack.cells[cell * 3 * LANES + lane] = start
            pack.cells[(cell * 3 + 1) * LANES + lane] = 0.0
            pack.cells[(cell * 3 + 2) * LANES + lane] = start


@_compiled
def _run_pack(given: Problems, outcome: Outcome, pack: Pack, lanes: np.uint64) -> None:
    """One pack from its placed particles until its last swarm has stopped."""
    dimensions, count = given.targets.shape[1], len(given.coefficients)
    for k in range(len(pack.best_fitness)):
        pack.best_fitness[k] = np.inf
    for iteration in range(count + 1):
        for lane in range(LANES):  # loops, since assigning to slices takes numba seconds to compile
            pack.tally[3 * LANES + lane] = 0.0
            pack.tally[4 * LANES + lane] = np.inf
            pack.tally[5 * LANES + lane] = 0.0
        for particle in range(given.particles):
            cell = np.uint64(particle * dimensions * 3 * LANES)
            if iteration > 0:
                aim = cell if given.ring else _NONE
                weights = given.coefficients[iteration - 1]
                _move(
                    pack.stream, pack.cells, cell, pack.aims, aim, pack.tally, given.clamped, given.orthonormal,
                    weights[0], weights[1], weights[2], dimensions, lanes,
                )  # fmt: skip
            elif given.orthonormal:
                _sum_gaps(pack.cells, cell, pack.aims, pack.tally, dimensions, lanes)
            if not given.orthonormal:
                _sum_images(
                    pack.cells, cell, pack.aims, pack.factor, pack.image, pack.tally, given.first_blocks, lanes
                )  # fmt: skip
            _judge(pack.tally, pack.best_fitness, particle, lanes)
            _remember(pack.cells, cell, pack.tally, dimensions, lanes)
        _lead(pack, given.ring, given.particles, dimensions)
        if not _note(given, outcome, pack, iteration):
            break


# so many parameters here and below: in the innermost loop a tuple of them would be taken apart anew each time
@_compiled
def _move(
    stream: Words, cells: Array, cell: np.uint64, aims: Array, aim: np.uint64, tally: Array, clamped: bool,
    orthonormal: bool, inertia: float, cognitive: float, social: float, dimensions: int, lanes: np.uint64,
) -> None:  # fmt: skip
    """`velocity_update` and step of one particle, and with an orthonormal factor the sum of its squares, in one pass.

    SFC64 (C. Doty-Humphrey, PractRand; as in numpy) is drawn once per dimension, for both r1 and r2.
    """
    cognitive *= WEIGHT_UNIT
    social *= WEIGHT_UNIT
    for _ in range(dimensions):
        for lane in range(lanes):
            a, b = stream[lane], stream[ONE + lane]
            c, counter = stream[_TWO + lane], stream[_THREE + lane]
            word = a + b + counter
            stream[lane] = b ^ (b >> np.uint64(11))
            stream[ONE + lane] = c + (c << np.uint64(3))
            stream[_TWO + lane] = ((c << np.uint64(24)) | (c >> np.uint64(40))) + word
            stream[_THREE + lane] = counter + np.uint64(1)
            # signed conversions, exact for halves: one instruction each, where the unsigned ones are many
            r1 = np.float64(np.int64(word & _LOWER_HALF))
            r2 = np.float64(np.int64(word >> _HALF))
            position = cells[cell + lane]
            own_pull = (cells[cell + _TWO + lane] - position) * r1 * cognitive
            social_pull = (aims[aim + lane] - position) * r2 * social
            velocity = cells[cell + ONE + lane] * inertia + own_pull + social_pull
            if clamped:
                limit = aims[aim + _TWO + lane]
                velocity = -limit if velocity < -limit else velocity
                velocity = limit if velocity > limit else velocity
            position += velocity
            cells[cell + ONE + lane] = velocity
            cells[cell + lane] = position
            if orthonormal:
                gap = position - aims[aim + ONE + lane]
                tally[lane] += gap * gap
        cell += _THREE
        aim += _THREE


@_compiled
def _sum_gaps(cells: Array, cell: np.uint64, aims: Array, tally: Array, dimensions: int, lanes: np.uint64) -> None:
    """The sum of squares of one particle at an orthonormal factor, |z - b|^2."""
    aim = _NONE
    for _ in range(dimensions):
        for lane in range(lanes):
            gap = cells[cell + lane] - aims[aim + ONE + lane]
            tally[lane] += gap * gap
        cell += _THREE
        aim += _THREE


# as above
@_compiled
def _sum_images(
    cells: Array, cell: np.uint64, aims: Array, factor: Array, image: Array, tally: Array, first_blocks: Words,
    lanes: np.uint64,
) -> None:  # fmt: skip
    """The sum of squares of one particle at a triangular factor, |R z - b|^2, column by column without the zeros."""
    rows, dimensions = np.uint64(len(image)), len(first_blocks)
    for k in range(_NONE, rows, np.uint64(1)):
        image[k] = 0.0
    column_start, block = _NONE, np.uint64(ROW_BLOCK) * ONE
    for column in range(dimensions):
        used = np.uint64(column // ROW_BLOCK + 1) * block
        for row in range(first_blocks[column] * block, used, block):
            entry = column_start + row
            for lane in range(lanes):
                position = cells[cell + lane]
                image[row + lane] += factor[entry + lane] * position
                image[row + ONE + lane] += factor[entry + ONE + lane] * position
                image[row + _TWO + lane] += factor[entry + _TWO + lane] * position
                image[row + _THREE + lane] += factor[entry + _THREE + lane] * position
        column_start += rows
        cell += _THREE
    first, aim = _NONE, _NONE
    for _ in range(dimensions):
        for lane in range(lanes):
            gap = image[first + lane] - aims[aim + ONE + lane]
            tally[lane] += gap * gap
        first += ONE
        aim += _THREE


@_compiled
def _judge(tally: Array, best_fitness: Array, particle: int, lanes: np.uint64) -> None:
    """Whether one particle's mean square is its best so far (NaN and infinity never are), and that the swarm's."""
    first, number = np.uint64(particle * LANES), float(particle)
    for lane in range(lanes):
        fitness = tally[lane] + tally[ONE + lane]
        best = best_fitness[first + lane]
        better = fitness < best
        best = fitness if better else best
        leads = best < tally[_FOUR + lane]
        tally[lane] = 0.0
        tally[_TWO + lane] = 1.0 if better else 0.0
        tally[_THREE + lane] += 1.0 if fitness < np.inf else 0.0
        tally[_FOUR + lane] = best if leads else tally[_FOUR + lane]
        tally[_FIVE + lane] = number if leads else tally[_FIVE + lane]
        best_fitness[first + lane] = best


@_compiled
def _remember(cells: Array, cell: np.uint64, tally: Array, dimensions: int, lanes: np.uint64) -> None:
    """Make one particle's position its best where it is better."""
    for _ in range(dimensions):
        for lane in range(lanes):
            position, best = cells[cell + lane], cells[cell + _TWO + lane]
            cells[cell + _TWO + lane] = position if tally[_TWO + lane] > 0.0 else best
        cell += _THREE


@_compiled
def _lead(pack: Pack, ring: bool, particles: int, dimensions: int) -> None:
    """Let the particles follow the best of their swarm, or the best of three on their ring."""
    fitness = pack.best_fitness
    for particle in range(particles if ring else 1):
        for lane in range(LANES):
            followed = int(pack.tally[5 * LANES + lane])
            if ring:
                followed = particle
                for neighbour in ((particle - 1) % particles, (particle + 1) % particles):
                    if fitness[neighbour * LANES + lane] < fitness[followed * LANES + lane]:
                        followed = neighbour
            for d in range(dimensions):
                best = pack.cells[((followed * dimensions + d) * 3 + 2) * LANES + lane]
                pack.aims[(particle * dimensions + d) * 3 * LANES + lane] = best


@_compiled
def _note(given: Problems, outcome: Outcome, pack: Pack, iteration: int) -> bool:
    """Write down the swarms' progress and those that stop; whether any goes on."""
    last, any_at_work = len(given.coefficients), False
    for lane in range(LANES):
        pack.progress[iteration * LANES + lane] = pack.tally[4 * LANES + lane]
        if not pack.at_work[lane]:
            continue
        reached = pack.tally[4 * LANES + lane] < given.threshold
        gone = pack.tally[3 * LANES + lane] == 0.0 and not _any_finite(given, pack, lane)
        pack.at_work[lane] = not (reached or gone or iteration == last)
        if not pack.at_work[lane]:
            outcome.codes[pack.swarms[lane]] = THRESHOLD if reached else (DIVERGED if gone else OTHER)
            _hand_over(outcome, pack, lane, iteration)
        any_at_work = any_at_work or pack.at_work[lane]
    return any_at_work


@_compiled
def _hand_over(outcome: Outcome, pack: Pack, lane: int, iteration: int) -> None:
    """The result of a swarm that has stopped."""
    swarm, dimensions = pack.swarms[lane], outcome.positions.shape[1]
    fitness, leader = pack.tally[4 * LANES + lane], int(pack.tally[5 * LANES + lane])
    outcome.iterations[swarm] = iteration
    for k in range(4):
        outcome.states[swarm, k] = pack.stream[k * LANES + lane]
    for k in range(outcome.history.shape[1]):
        outcome.history[swarm, k] = pack.progress[k * LANES + lane] if k < iteration else fitness
    if fitness < np.inf:
        outcome.fitness[swarm] = fitness
        for d in range(dimensions):
            outcome.positions[swarm, d] = pack.cells[((leader * dimensions + d) * 3 + 2) * LANES + lane]


@_compiled
def _any_finite(given: Problems, pack: Pack, lane: int) -> bool:
    """Whether any particle of a lane still has a finite position."""
    dimensions = given.targets.shape[1]
    for particle in range(given.particles):
        for d in range(dimensions):
            if not np.isfinite(pack.cells[(particle * dimensions + d) * 3 * LANES + lane]):
                break
        else:
            return True
    return False
