"""Rows that are far off one after another: no bad shots, which come singly; something moved while they were measured.

Weights against bad shots silence whatever disagrees with most rows. A base or tool that jumped early or late, by far
more than the noise, would so be lost as two dozen bad shots. Here such rows count once more, and where a jump explains
them, they stay.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.diagnosis.constants import LOOP
from armscope.diagnosis.scans.change_points import jumps, pieces_of
from armscope.diagnosis.scans.context import ScanContext
from armscope.diagnosis.selection_loop import SelectionLoop
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.inference.edits import replaced
from armscope.inference.evidence import evaluate
from armscope.inference.normal_equations import total
from armscope.inference.problem import build_problem
from armscope.measurement.constants import WEIGHTS
from armscope.measurement.row_weights import RowWeights
from armscope.physics.backgrounds import DRIFT, FAMILIES
from armscope.physics.effect import Placed
from armscope.recordings import Recordings

Mask = NDArray[np.bool_]


class SelectionWithSustainedOutliers(SelectionLoop):
    """Rounds in which rows that are far off together are no bad shots if a jump explains them."""

    def _settle(self) -> None:
        super()._settle()
        for _ in range(LOOP.rounds_of_outliers):
            if not self._explained_by_a_jump():
                break

    def _explained_by_a_jump(self) -> bool:
        """Whether a jump explains rows that were far off together; all stays as it was where none does."""
        apart = far_off_together(self.recordings, self._suspect())
        if not apart.any():
            return False
        trusting = self.noise.weights.trusting(apart)
        promising = self._jumps(trusting)
        if not promising:
            return False
        known = {(candidate.key, candidate.variant) for candidate in self.space.candidates}
        new = [placed for placed in promising if (placed.key, placed.variant) not in known]
        kept, noise = dict(vars(self)), dict(vars(self.noise))
        self.candidates, self.noise.weights = [*self.candidates, *new], trusting
        super()._settle()
        if np.count_nonzero(self._suspect() & apart) <= LOOP.still_apart * np.count_nonzero(apart):
            return True
        vars(self).update(kept)
        vars(self.noise).update(noise)
        return False

    def _suspect(self) -> Mask:
        return np.asarray(self.noise.weights.robust_weight < WEIGHTS.inlier_weight)

    def _jumps(self, weights: RowWeights) -> list[Placed]:
        """Jumps that promise something where rows have these weights."""
        one_block = 0 * self.block_of_row
        sums = total(normal_equations_by_block(self.space.layout, self.point, self.table, weights, one_block))
        problem = build_problem(self.space, sums, self.noise.least_mm)
        steady = replaced(self.best.background, FAMILIES.index(DRIFT), 0)
        given = evaluate(problem, self.best.chosen, steady, problem.mismatch)
        context = ScanContext(problem, self.space, self.point, self.recordings, weights)
        return list(jumps(context, [given]))


def far_off_together(recordings: Recordings, suspect: Mask) -> Mask:
    """(N,) those of some suspect rows (N,) that lie, in the order of their run, where half of the rows are suspect."""
    found = np.zeros(len(suspect), dtype=bool)
    stretch = 2 * LOOP.far_off_together
    for rows, _ in pieces_of(recordings):
        counts = np.convolve(suspect[rows], np.ones(stretch, dtype=int), "valid")
        for first in np.flatnonzero(counts >= LOOP.far_off_together):
            found[rows[first : first + stretch]] = True
    return found & suspect
