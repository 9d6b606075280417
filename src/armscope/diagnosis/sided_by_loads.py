"""Play that turns over with gravity's load, beside rows at the turn, where nobody knows the side.

Such a load is a small difference of large ones, and stated masses are off by a tenth: by them a row near the turn may
be put on the wrong flank. There it is off by the whole gap, many times the noise, so that one row outweighs what a
hundred others say for the play, and whatever rises smoothly through the turn takes its place. Weights don't mend that:
they come from the fit without the play. So where something else follows a load that could turn play over, it is asked
whether the rows away from the turn are for the play; if so, the rounds start once more from there, and the better
answer on all rows stays.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from armscope.core.location import Location
from armscope.core.sampling import spread_evenly
from armscope.diagnosis.constants import LOOP
from armscope.diagnosis.sustained_outliers import SelectionWithSustainedOutliers
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.joint_scatter import log_likelihood
from armscope.inference.constants import BUDGET, PRIORS
from armscope.inference.edits import replaced
from armscope.inference.evidence import Hypothesis
from armscope.inference.normal_equations import total
from armscope.inference.problem import SelectedEffect, build_problem
from armscope.inference.search import Search
from armscope.measurement.row_weights import RowWeights
from armscope.physics.backgrounds import FAMILIES, SOFT
from armscope.physics.effect import Placed
from armscope.physics.loads import torque_stderr
from armscope.physics.scene import Scene
from armscope.physics.soft_start import SOFT_START
from armscope.physics.transmission import BACKLASH

FOLLOWS_LOADS = ("load", SOFT_START)
"""Variants that rise through the turn of a load: the curve over it, and drives that are softer under small ones."""


class SelectionWithSidesOfLoads(SelectionWithSustainedOutliers):
    """Rounds in which rows at the turn of a joint's load don't speak against play that turns over there."""

    def _settle(self) -> None:
        super()._settle()
        for play in self._plays():
            if self._is_better_with(play):
                break

    def _plays(self) -> Iterator[int]:
        """Plays by a joint's load in whose place something else follows loads."""
        soft = bool(self.found.background[FAMILIES.index(SOFT)])
        places = {p.location for p in map(self._placed, self.found.candidates) if p.variant in FOLLOWS_LOADS}
        for number, placed in enumerate(self.space.placed):
            taken = soft or placed.location in places
            if taken and is_play_by_load(placed) and number not in self.found.candidates:
                yield number

    def _placed(self, number: int) -> Placed:
        return self.space.placed[number]

    def _is_better_with(self, play: int) -> bool:
        """Whether the rounds end with a play, and all rows are more probable then; else all stays as it was."""
        key = self._placed(play).key
        at_turn = rows_at_turn(Scene(self.model.arm, self.recordings), Location.of(key[1]).number)
        if not at_turn.any():
            return False
        away = self.noise.weights.without(at_turn)
        promising = self._promising(play, away)
        if promising is None:
            return False
        before, kept, noise = self._probable(), dict(vars(self)), dict(vars(self.noise))
        self.last, self.noise.weights = (promising, self.space), away
        super()._settle()
        there = any(self._placed(c).key == key and is_play_by_load(self._placed(c)) for c in self.best.candidates)
        if there and self._probable() > before + PRIORS.sure_nats:
            return True
        vars(self).update(kept)
        vars(self.noise).update(noise)
        return False

    def _promising(self, play: int, away: RowWeights) -> Hypothesis | None:
        """The play in place of what follows loads, if rows away from the turn are for it."""
        sums = total(normal_equations_by_block(self.space.layout, self.point, self.table, away, 0 * self.block_of_row))
        search = Search.on(build_problem(self.space, sums, self.noise.least_mm))
        found, location = self.found, self._placed(play).location
        others = tuple(
            c for c in found.chosen
            if self._placed(c.candidate).location != location or self._placed(c.candidate).variant not in FOLLOWS_LOADS
        )  # fmt: skip
        steady = replaced(found.background, FAMILIES.index(SOFT), 0)
        middle = SelectedEffect(play, len(search.problem.sizes) // 2)
        as_is = search.with_best_sizes(search.evaluated(found.chosen, found))
        instead = search.evaluated((*others, middle), found, steady)
        for _ in range(BUDGET.named_at_once):  # what else the curve was: a drive that gives way
            larger = search.additions(instead, 1, least=0.0)
            instead = larger[0] if larger else instead
        instead = search.pruned(search.with_best_sizes(instead))
        there = play in instead.candidates and instead.log_posterior > as_is.log_posterior
        return instead if there else None

    def _probable(self) -> float:
        """How probable all rows are, nats, less what was fitted to them."""
        rows = spread_evenly(len(self.table), LOOP.scatter_rows)
        left, moved = self.fit.residuals[rows], self.noise.moved[:, rows]
        nats = log_likelihood(left, moved, self.noise.scatter, self.noise.least_mm)
        return nats * len(self.table) / len(rows) - self.fit.effective_dof


def is_play_by_load(placed: Placed) -> bool:
    """Whether an effect is play whose side gravity's load decides."""
    return placed.effect == BACKLASH and placed.variant == "load"


def rows_at_turn(scene: Scene, joint: int) -> NDArray[np.bool_]:
    """(N,) rows in which gravity may load a motor (from 1) from the other side than computed."""
    return np.asarray(np.abs(scene.torques[:, joint - 1]) < LOOP.at_turn * torque_stderr(scene, joint))
