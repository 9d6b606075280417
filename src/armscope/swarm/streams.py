"""One stream of random numbers for each swarm, so that no result depends on what else is computed beside it.

Each swarm reads its stream in this order: the start positions, particles x dimensions; then in each iteration one word
of 64 bits for each dimension of each particle. The lower half of the word gives r1 and the upper half r2, in steps of
2^-32: fine enough for a weight, and half the cost of two whole words.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

WEIGHT_UNIT = 2.0**-32
BLOCK_WORDS = 4096  # how many words are drawn at once, about


def spawn_generators(seed: int | Sequence[int] | np.random.SeedSequence, count: int) -> list[np.random.Generator]:
    """``count`` independent generators (SFC64, numpy's fastest), spawned from one seed; equal for equal seeds."""
    sequence = seed if isinstance(seed, np.random.SeedSequence) else np.random.SeedSequence(seed)
    return [np.random.Generator(np.random.SFC64(child)) for child in sequence.spawn(count)]


class WeightStream:
    """The weights r1 and r2 of several swarms, iteration by iteration, each from its own generator.

    Several iterations are drawn at once, since asking a generator takes as long as a thousand of its words. A generator
    whose swarm stops early is set back to where that swarm left it.

    Args:
        generators: one per swarm, of any kind.
        shape: particles and dimensions.
        iterations: how often `draw` will be called at most.
    """

    def __init__(self, generators: Sequence[np.random.Generator], shape: tuple[int, int], iterations: int) -> None:
        self._generators, self._iterations_left = list(generators), iterations
        self._per_iteration = shape[0] * shape[1]
        self._block = max(1, BLOCK_WORDS // self._per_iteration)
        self._words = np.empty((len(self._generators), 0, self._per_iteration), dtype="<u8")
        self._used = 0
        self._before: list[Any] = []  # the generators' states before the words in memory
        self._weights = np.empty((2, len(self._generators), *shape))

    def draw(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """r1 and r2 of the next iteration, swarms x particles x dimensions, in units of `WEIGHT_UNIT`."""
        if self._used == self._words.shape[1]:
            self._refill()
        halves = self._words[:, self._used].view("<u4").reshape(*self._weights.shape[1:], 2)
        self._used += 1
        np.copyto(self._weights[0], halves[..., 0])
        np.copyto(self._weights[1], halves[..., 1])
        return self._weights[0], self._weights[1]

    def keep(self, staying: NDArray[np.bool_]) -> None:
        """Let the swarms go that do not stay."""
        for row in np.flatnonzero(~staying):
            if self._before:
                self._generators[row].bit_generator.state = self._before[row]
                _words(self._generators[row], self._used * self._per_iteration)
        kept = np.flatnonzero(staying)
        self._generators = [self._generators[row] for row in kept]
        self._before = [self._before[row] for row in kept] if self._before else []
        self._words, self._weights = self._words[kept], self._weights[:, kept]

    def _refill(self) -> None:
        block = min(self._block, self._iterations_left)
        self._iterations_left -= block
        self._before = [generator.bit_generator.state for generator in self._generators]
        if self._words.shape[1] != block:
            self._words = np.empty((len(self._generators), block, self._per_iteration), dtype="<u8")
        for row, generator in enumerate(self._generators):
            self._words[row] = _words(generator, block * self._per_iteration).reshape(block, -1)
        self._used = 0


def _words(generator: np.random.Generator, count: int) -> NDArray[np.uint64]:
    if isinstance(generator.bit_generator, np.random.SFC64):
        return generator.bit_generator.random_raw(count)  # the same words as below, in half the time
    return generator.integers(0, 2**64, size=count, dtype=np.uint64)


def are_sfc64(generators: Sequence[np.random.Generator]) -> bool:
    """Whether all of them are SFC64, whose stream the compiled kernel continues."""
    return all(isinstance(generator.bit_generator, np.random.SFC64) for generator in generators)


def sfc64_states(generators: Sequence[np.random.Generator]) -> NDArray[np.uint64]:
    """The states (a, b, c, counter) of SFC64 generators, one row each."""
    return np.array([g.bit_generator.state["state"]["state"] for g in generators], dtype=np.uint64)


def set_sfc64_states(generators: Sequence[np.random.Generator], states: NDArray[np.uint64]) -> None:
    """Let SFC64 generators go on from ``states``, as if they had drawn the numbers themselves."""
    for generator, state in zip(generators, states, strict=True):
        whole = generator.bit_generator.state
        whole["state"]["state"] = state
        generator.bit_generator.state = whole
