"""How the arm's motion is seen: which part of it counts, and how much."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array


@dataclass(frozen=True, eq=False)
class Lens:
    """How much of a row's motion counts.

    Attributes:
        shift: (N, 3, 3) what displacements are multiplied by: the root of a row's weight, and its whitening.
        turn: (N,) m/rad, by which turns of the tool count beside displacements; None: turns don't count.
    """

    shift: Array
    turn: Array | None = None

    @property
    def numbers(self) -> int:
        """How many numbers a row has."""
        return 3 if self.turn is None else 6

    def through(self, shift: Array, turn: Array) -> Array:
        """(N, 3 or 6) displacements (N, 3), and turns (N, 3) rad where they count, as they are seen."""
        shifted = np.einsum("nij,nj->ni", self.shift, shift)
        if self.turn is None:
            return shifted
        return np.concatenate([shifted, self.turn[:, None] * turn], axis=1)
