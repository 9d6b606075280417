"""Frames and effects that recordings share, what they leave, and how surely a change stands beside them."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from armscope.comparison.bad_shots import weigh_rows
from armscope.comparison.constants import SHARED
from armscope.comparison.flange_load import load_at_the_flange
from armscope.comparison.noisier import LeftOver
from armscope.comparison.own_errors import learned, no_own_errors, own_errors
from armscope.comparison.penalised import HeldColumns, held_values, left_of_groups, variance_left
from armscope.comparison.scoring import Possible, Scored, Statistic, halves, overdispersion, scored
from armscope.comparison.sets import columns_of_rows
from armscope.core.types import Array, Indices
from armscope.fitting.joint_scatter import motor_jacobians
from armscope.fitting.linearisation import point_residuals
from armscope.fitting.registration import fit_frames
from armscope.fitting.transfer import belongs_to_the_arm
from armscope.measurement import robust
from armscope.physics.effect import Placed
from armscope.physics.frames import free_frames
from armscope.physics.registry import library
from armscope.physics.tilting import ABOUT_ITS_FOOT
from armscope.physics.wobble import RUNS_OUT
from armscope.recordings import Recordings
from armscope.robot import Arm


class SharedModel:
    """Frames and shared effects, of several arms errors of each arm's own, what they leave, and changes beside them."""

    def __init__(self, arm: Arm, table: Recordings, group: Indices, of_arms: bool = False) -> None:
        self.group = np.repeat(group, 3)
        model = fit_frames(arm, table)
        self.arm = arm
        self.tools = {part.placed.variant: arm.tool + part.values for part in model.tools}
        residual = point_residuals(model, table)
        weight = np.repeat(np.sqrt(robust.huber_weights(residual, np.ones(len(residual)), 0.0)), 3)
        placed = [each for each in library(arm, table) if belongs_to_the_arm(each)]
        simple = [each for each in placed if not each.variant.endswith((RUNS_OUT, ABOUT_ITS_FOOT))]
        self.placed = [each for each in simple if len(each.terms) <= SHARED.terms and not each.nameless]
        frames = [term for each in free_frames(table, False) for term in each.terms]
        terms = [term for each in self.placed for term in each.terms]
        columns = weight[:, None] * columns_of_rows(model, table, [*frames, *terms])
        self.residual, self._moved = weight * residual.reshape(-1), motor_jacobians(model, table)
        self.frames, self.effects = columns[:, : len(frames)], columns[:, len(frames) :]
        size = np.sqrt(np.mean(self.effects**2, axis=0))
        self.scale = np.where(size > 0, SHARED.prior_mm / np.where(size > 0, size, 1), 0.0)
        self.plausible = np.array([term.plausible for each in self.placed for term in each.terms])
        self._start = np.cumsum([0, *(len(each.terms) for each in self.placed)])
        self.dispersion = 1.0
        self.robust = self.weight = weight
        self.own = own_errors(model, table, group).weighed(weight) if of_arms else no_own_errors(len(weight))
        self.noise = self._settled_noise()
        weigh_rows(self)
        self.settle(())
        self.dispersion = overdispersion(self._between_halves(table.motor_angles))
        if (load := load_at_the_flange(arm, table)) is not None:
            self._offer(load, columns_of_rows(model, table, load.terms))

    def _offer(self, placed: Placed, columns: Array) -> None:
        """One more effect that may have changed, of columns (3N, q), and that is not among what is shared."""
        self.placed.append(placed)
        self.effects = np.hstack([self.effects, self.weight[:, None] * columns])
        self.scale = np.append(self.scale, np.zeros(len(placed.terms)))
        self.plausible = np.append(self.plausible, [term.plausible for term in placed.terms])
        self._start = np.append(self._start, self._start[-1] + len(placed.terms))

    @property
    def settled(self) -> bool:
        """Whether recordings count by what is known without the changes: nothing else would be found with them."""
        return self.weighed_alone and not self.of_arms

    @property
    def of_arms(self) -> bool:
        """Whether recordings are of several arms, each with errors of its own."""
        return len(self.own.size) > 0

    def settle(self, taken: Sequence[Possible], of_most: bool = False) -> None:
        """Recordings count by their noise, and errors of each arm's own are as large as arms of the type have them.

        Args:
            taken: changes, which would else count as noise, or as what arms of this type have.
            of_most: whatever stands out, taken or not, does not count as what arms of this type have.
        """
        self._weigh_recordings(taken)
        for _ in range(SHARED.size_rounds if self.of_arms else 0):
            self.own = learned(self.own, self.residual, self.base(taken), of_most)
            self.noise = self._settled_noise(taken)

    def _weigh_recordings(self, taken: Sequence[Possible]) -> None:
        """Each recording counts by its own noise: pooled, the quiet one's rows would be too sure of themselves.

        By what is left when it is fitted alone. Beside what all share, one in which several causes changed would count
        as a noisy one, whose rows then show no change. Where a recording is too short to be fitted alone, by what is
        left beside what all share.
        """
        alone = [each.left(each.base(())) for each in map(self.alone, range(self.group[-1] + 1))]
        self.weighed_alone = min(free for _, free in alone) >= SHARED.free_alone
        if self.weighed_alone:
            self._weigh(np.sqrt([variance for variance, _ in alone]))
            return
        self._reweigh(self.robust / self.weight)
        for _ in range(SHARED.weighings):
            left, free = self._left_of_each(taken)
            self._weigh(np.sqrt(np.bincount(self.group, left**2) / free + SHARED.least_square))
            self.noise = self._settled_noise()

    def _left_of_each(self, taken: Sequence[Possible]) -> tuple[Array, Array]:
        """(3N,) what is left beside changes, as rows are weighed, and (sets,) how many numbers of each are free."""
        return left_of_groups(self.residual, self.base(taken), self.group)

    def _weigh(self, noise: Array) -> None:
        """Give recordings weights by their noise (sets,), as multiples of those that they have."""
        variance = np.bincount(self.group) @ noise**2 / len(self.group)
        self._reweigh((np.sqrt(variance) / noise)[self.group])
        self.noise = float(variance)

    def trust(self, weights: Array) -> None:
        """Rows count by ``weights`` (3N,), whatever they counted before."""
        self._reweigh(weights / self.weight)
        self.robust = weights

    def weighed_anew(self, weights: Array) -> SharedModel:
        """The same rows with other weights (3N,)."""
        other = copy.copy(self)
        other.trust(weights)
        other.noise = other._settled_noise()
        return other

    def _reweigh(self, relative: Array) -> None:
        self.weight, self.residual = self.weight * relative, self.residual * relative
        self.frames, self.effects = self.frames * relative[:, None], self.effects * relative[:, None]
        self.own = self.own.weighed(relative)

    def left_over(self, taken: Sequence[Possible]) -> list[LeftOver]:
        """What is left of each recording, alone where it is long enough, and together beside the changes taken."""
        weighed, free = self._left_of_each(taken)
        left = []
        for number, fewer in enumerate(free):
            rows = self.group == number
            together = own = (weighed[rows] / self.weight[rows]).reshape(-1, 3)
            if self.weighed_alone:
                alone = self.alone(number)
                base = alone.base(())
                own, fewer = alone.left_by(base).reshape(-1, 3), alone.left(base)[1]
            left.append(LeftOver(own, float(fewer), together, self._moved[:, rows[::3]]))
        return left

    def alone(self, number: int) -> SharedModel:
        """One recording, with effects of its own."""
        rows = self.group == number
        alone = copy.copy(self)
        alone.weight = self.weight[rows]
        alone.residual, alone.frames, alone.effects = self.residual[rows], self.frames[rows], self.effects[rows]
        alone.frames, alone.group = alone.frames[:, np.any(alone.frames != 0, axis=0)], self.group[rows]
        alone.own = no_own_errors(len(alone.residual))
        alone.noise = alone._settled_noise()
        return alone

    def _between_halves(self, angles: Array) -> Iterator[Statistic]:
        """What differs between halves of each recording, for every effect, with frames and effects of its own."""
        for number in range(self.group[-1] + 1):
            alone = self.alone(number)
            parts = [np.repeat(half, 3) for half in halves(angles[self.group[::3] == number])]
            changes = [
                Possible(each, at, self._of(self.plausible, at), part, (), ())
                for at, each in enumerate(self.placed)
                for part in parts
            ]
            yield from (each.statistic for each in alone.scores(changes, ()))

    def possible_changes(self, masks: Sequence[tuple[tuple[int, ...], tuple[int, ...]]]) -> list[Possible]:
        """Every effect of the library in every one of some groups of recordings."""
        return [
            Possible(each, number, self._of(self.plausible, number), np.isin(self.group, inside), inside, against)
            for number, each in enumerate(self.placed)
            for inside, against in masks
            if np.abs(self.columns_of(number, inside)).max() > 0
        ]

    def columns(self, possible: Possible) -> Array:
        """(3N, q) a change's columns, mm per unit, as rows are weighed: half of it more there, half less elsewhere.

        Beside what is shared it is the same as all of it on either side, and which side comes first does not matter.
        """
        return self.effects[:, self.at(possible.number)] * (possible.there - 0.5)[:, None]

    def size(self, possible: Possible) -> Array:
        """(q,) of a change's columns beside the same effect where it is shared: what both sides show is what counts."""
        square = self.effects[:, self.at(possible.number)] ** 2
        there, elsewhere = square[possible.there].sum(axis=0), square[~possible.there].sum(axis=0)
        either = there + elsewhere
        return np.asarray(np.sqrt(there * elsewhere / np.where(either > 0, either, 1.0)))

    def _told(self, possible: Possible, variance: float) -> NDArray[np.bool_]:
        """(q,) the numbers that move the rows by more than their noise where they change as much as arms show."""
        return np.asarray(self.size(possible) > np.sqrt(variance) / possible.plausible)

    def evidence(self, taken: Sequence[Possible]) -> float:
        """How likely the rows are with changes, nats: what they fit better less what their numbers cost (Schwarz)."""
        variance, free = self.left(self.base(taken))
        price = sum(int(self._told(each, variance).sum()) for each in taken) / 2 * np.log(max(free, 2.0))
        return float(-len(self.residual) / 2 * np.log(variance * free) / self.dispersion - price)

    def scores(self, possible: Sequence[Possible], taken: Sequence[Possible]) -> list[Scored]:
        """How much better each change makes the fit, beside those that were taken."""
        base = self.base(taken)
        variance, _ = self.left(base)
        columns = [self._seen_columns(each, variance) for each in possible]
        return scored(columns, self.residual, base, self.dispersion, self.own)

    def _seen_columns(self, possible: Possible, variance: float) -> Array:
        """(3N, q) of a change's numbers that the rows can show, beside the same effect where it is shared."""
        told = self._told(possible, variance)
        return self.columns(possible)[:, told] / self.size(possible)[told]

    def variance(self, taken: Sequence[Possible]) -> float:
        """Of what is left, per axis, mm^2."""
        return self.left(self.base(taken))[0]

    def left_mm(self, taken: Sequence[Possible]) -> list[Array]:
        """What frames leave, what is shared beside them, and changes, too: three of (sets,) RMS per axis, mm."""
        frames = HeldColumns(self.frames, np.zeros(self.frames.shape[1]))
        return [
            np.sqrt(np.bincount(self.group, self.left_by(base) ** 2) / np.bincount(self.group))
            for base in (frames, self.base(()), self.base(taken))
        ]

    def left_by(self, base: HeldColumns) -> Array:
        """What columns with penalties leave in the rows as they were measured, without their weights, mm."""
        return np.asarray((self.residual - base.columns @ held_values(self.residual, base)) / self.weight)

    def _of(self, numbers: Array, number: int) -> Array:
        """An effect's part of numbers that stand one per term."""
        return numbers[self.at(number)]

    def at(self, number: int) -> slice:
        """Where the terms of an effect stand among those of all."""
        return slice(self._start[number], self._start[number + 1])

    def columns_of(self, number: int, sets: tuple[int, ...]) -> Array:
        """(3N, q) an effect's columns in the rows of some recordings."""
        return self.effects[:, self.at(number)] * np.isin(self.group, sets)[:, None]

    def base(
        self,
        taken: Sequence[Possible],
        kept: NDArray[np.bool_] | None = None,
        own: NDArray[np.bool_] | None = None,
        prior_mm: float = SHARED.prior_mm,
    ) -> HeldColumns:
        """All that a change stands beside: errors of each arm's own, frames, changes that were taken, what is shared.

        Args:
            taken: the changes.
            kept: (p,) of the shared effects' terms; None for all that can be seen.
            own: (c,) of the errors of each arm's own; None for all.
            prior_mm: how large shared effects are at the tool.

        Returns:
            Columns in units of which one costs as much as the noise, but for frames and changes, which are free.
        """
        kept = self.scale > 0 if kept is None else kept
        drawn = self.own.sized if own is None else self.own.sized[:, own]
        free = np.hstack([self.frames, *(self.columns(each) for each in taken)])
        free = free / np.maximum(np.linalg.norm(free, axis=0), 1e-30)
        shared = self.effects[:, kept] * self.scale[kept] * (prior_mm / SHARED.prior_mm)
        penalty = np.full(drawn.shape[1] + free.shape[1] + shared.shape[1], self.noise)
        # a wrist that was held leaves part of its tool to the base
        penalty[drawn.shape[1] : drawn.shape[1] + free.shape[1]] = SHARED.held
        return HeldColumns(np.hstack([drawn, free, shared]), penalty, drawn.shape[1])

    def left(self, base: HeldColumns) -> tuple[float, float]:
        """Variance per number, and how many numbers are free, beside columns with penalties."""
        return variance_left(self.residual, base)

    def _settled_noise(self, taken: Sequence[Possible] = ()) -> float:
        """The variance that the prior is weighed by, found with itself."""
        self.noise = float(np.mean(self.residual**2)) / SHARED.first_noise + SHARED.least_variance
        base = self.base(taken)
        held = base.penalty == self.noise
        for _ in range(SHARED.noise_rounds):
            base = base.held(np.where(held, self.noise, base.penalty))
            self.noise = max(self.left(base)[0], SHARED.least_variance)
        return self.noise
