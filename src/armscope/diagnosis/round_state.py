"""What must not change any more when the rounds of a selection end."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.diagnosis.constants import LOOP
from armscope.inference.model_space import Candidate
from armscope.measurement.constants import WEIGHTS
from armscope.measurement.row_weights import RowWeights


@dataclass(frozen=True, eq=False)
class RoundState:
    """How a round ended."""

    effects: frozenset[str]  # labels of what was chosen
    suspect: NDArray[np.bool_]  # (N,) rows that do not count

    @staticmethod
    def of(chosen: Iterable[Candidate], weights: RowWeights) -> RoundState:
        """The state with these effects and weights of rows."""
        effects = frozenset(candidate.label + candidate.variant for candidate in chosen)
        return RoundState(effects, weights.robust_weight < WEIGHTS.inlier_weight)

    def is_like(self, previous: RoundState) -> bool:
        """Whether two rounds ended alike: the same effects, and the same rows count but for a few of very many."""
        changed = np.count_nonzero(self.suspect != previous.suspect)
        return self.effects == previous.effects and bool(changed <= LOOP.flickering * len(self.suspect))
