"""One stream of random numbers for each swarm, so that no result depends on what else is computed beside it.

Each swarm reads its stream in this order: the start positions, particles x dimensions; then in each iteration one word
of 64 bits for each dimension of each particle. The lower half of the word gives r1 and the upper half r2, in steps of
2^-32: fine enough for a weight, and half the cost of two whole words.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

WEIGHT_UNIT = 2.0**-32


def spawn_generators(seed: int | Sequence[int] | np.random.SeedSequence, count: int) -> list[np.random.Generator]:
    """``count`` independent generators (SFC64, numpy's fastest), spawned from one seed; equal for equal seeds."""
    sequence = seed if isinstance(seed, np.random.SeedSequence) else np.random.SeedSequence(seed)
    return [np.random.Generator(np.random.SFC64(child)) for child in sequence.spawn(count)]


class WeightStream:
    """The weights r1 and r2 of several swarms, drawn iteration by iteration from their generators into one memory.

    Args:
        generators: one per swarm, of any kind.
        shape: particles and dimensions.
    """

    def __init__(self, generators: Sequence[np.random.Generator], shape: tuple[int, int]) -> None:
        self.generators = list(generators)
        whole = (len(self.generators), *shape)
        self._words = np.empty((len(self.generators), shape[0] * shape[1]), dtype="<u8")
        self._halves = self._words.view("<u4").reshape(*whole, 2)
        self._r1, self._r2 = np.empty(whole), np.empty(whole)

    def draw(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """r1 and r2 of the next iteration, swarms x particles x dimensions, in units of `WEIGHT_UNIT`."""
        for row, generator in enumerate(self.generators):
            self._words[row] = _words(generator, self._words.shape[1])
        np.copyto(self._r1, self._halves[..., 0])
        np.copyto(self._r2, self._halves[..., 1])
        return self._r1, self._r2


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
