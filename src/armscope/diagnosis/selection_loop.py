"""Rounds of columns -> selection -> exact refit -> scan, until neither effects, suspect rows nor scatter change.

A long table is diagnosed on a sample of its rows first; all rows then evaluate what could matter, once.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices, Progress
from armscope.diagnosis.promotion import named
from armscope.diagnosis.scans.scanning import jumps, mesh_lines, pauses
from armscope.fitting.joint_scatter import Scattered, find_scatter, motor_jacobians, noise_between, whitening
from armscope.fitting.linearisation import keep_drivers, missed, normal_equations_by_block
from armscope.fitting.model_space import Pool, pool
from armscope.fitting.refit import Refit, refit
from armscope.inference.evidence import Hypothesis, Problem, background_sizes, problem
from armscope.inference.normal_equations import NormalEquations, total
from armscope.inference.search import STARTS, Search
from armscope.inference.updates import best_additions
from armscope.measurement import robust
from armscope.measurement.noise import (
    Growth,
    Noise,
    distances,
    growth,
    independence_weights,
    poses,
    relative_uncertainty,
)
from armscope.measurement.row_weights import INLIER_WEIGHT, RowNoise
from armscope.physics.backgrounds import backgrounds
from armscope.physics.drift import BASE_DRIFT
from armscope.physics.effect import Placed
from armscope.physics.freeform import refined
from armscope.physics.model import FittedModel
from armscope.physics.payload import PAYLOAD_ERROR, payload_errors
from armscope.physics.registry import library
from armscope.physics.scene import Part
from armscope.recordings import Recordings

State = tuple[frozenset[str], NDArray[np.bool_]]

ROUNDS, FULL_ROUNDS, SCANNING_ROUNDS = 7, 2, 4
"""Rounds at most; the first search from all starts, later ones from where the last one ended; the last do not scan."""
SAMPLE_ROWS = 3000
"""Longer tables are diagnosed on this many of their rows first."""
ROWS_OF_A_GROUP = 20
"""Rows of every run and target that the sample holds at least."""
SCATTER_ROWS = 4000
"""Scatter is looked for on this many rows at most."""
FLICKERING = 0.002
"""Share of the rows that may still come and go when the rounds end."""
WITHIN = 0.3
"""Names within a background are fitted freely, but not so freely that several could run against each other."""
PROMISING = 60
"""How many effects beside the chosen ones are weighed again on all rows of a long table."""


@dataclass(frozen=True, eq=False)
class Selected:
    """Where the rounds ended; ``point`` is where the blocks were linearised; ``best`` is ``found`` with names."""

    problem: Problem
    blocks: list[NormalEquations]
    point: FittedModel
    found: Hypothesis
    best: Hypothesis
    fit: Refit
    scatter: tuple[Scattered, ...]
    growth: Growth | None


def select(
    start: FittedModel,
    recordings: Recordings,
    noise: Noise,
    frames: Sequence[Placed],
    block_of_row: Indices,
    tell: Progress,
) -> Selected:
    """The effects that the evidence asks for, fitted with the exact model."""
    if len(recordings) <= SAMPLE_ROWS:
        return SelectionLoop(start, recordings, noise, frames, block_of_row, tell).run()
    rows = _sample(recordings)
    small = SelectionLoop(start, recordings.rows(rows), noise, frames, block_of_row[rows], tell)
    found = small.run(of_a_sample=True)
    whole = SelectionLoop(start, recordings, noise, frames, block_of_row, tell, _promising(found))
    whole.follow(small)
    tell("weighing all rows", 0.45)
    whole.round((found.best.background,))
    return whole.selected()


def _sample(recordings: Recordings) -> Indices:
    """Rows spread evenly over the table, and some of every run and target."""
    rows = [np.linspace(0, len(recordings) - 1, SAMPLE_ROWS).astype(np.intp)]
    groups = np.char.add(np.char.add(recordings.run, "\n"), recordings.target)
    rows += [np.flatnonzero(groups == group)[:ROWS_OF_A_GROUP] for group in np.unique(groups)]
    return np.unique(np.concatenate(rows))


def _promising(found: Selected) -> list[Placed]:
    """The chosen effects and those that come next, given the best hypothesis and given none."""
    search = Search.on(found.problem)
    candidates = found.problem.pool.candidates
    kept = set(found.best.candidates) | {n for n, placed in enumerate(candidates) if placed.refinement}
    coarse = {candidates[n].key for n in kept if candidates[n].refinement and candidates[n].variant == "angle"}
    kept |= {n for n, placed in enumerate(candidates) if placed.key in coarse and placed.variant == "angle"}
    for hypothesis in (found.best, search.empty()):
        gain, _ = best_additions(found.problem, search.groups, hypothesis)
        kept |= {int(c) for c in np.argsort(-gain)[: PROMISING // 2]}
    return [candidates[c] for c in sorted(kept) if candidates[c].effect is not PAYLOAD_ERROR]


class SelectionLoop:
    """The rounds on one table.

    Args:
        start: the arm with its frames fitted.
        recordings: the rows.
        noise: what is known of it.
        frames: the free frames.
        block_of_row: (N,) which block of rows each row is in.
        tell: told of the progress.
        candidates: effects that compete; the whole library where not given.
    """

    def __init__(
        self,
        start: FittedModel,
        recordings: Recordings,
        noise: Noise,
        frames: Sequence[Placed],
        block_of_row: Indices,
        tell: Progress,
        candidates: Sequence[Placed] | None = None,
    ) -> None:
        self.recordings = keep_drivers(recordings, np.argsort(block_of_row, kind="stable"))
        self.noise, self.frames, self.tell = noise, frames, tell
        self.block_of_row = block_of_row
        self.candidates = library(start.arm, recordings) if candidates is None else list(candidates)
        self.families = list(backgrounds(start.arm, recordings).values())
        self.moved = motor_jacobians(start, self.recordings)
        self.model, self.missed = start, missed(start, self.recordings)
        self.scatter: list[Scattered] = []
        self.pose = poses(self.recordings)
        self.growth: Growth | None = None
        uncertainty = relative_uncertainty(self.recordings, robust.scale_of(self.left))
        near = np.ones(len(self.recordings), dtype=bool)
        self.rows = RowNoise(uncertainty, independence_weights(self.left, self.pose, near))
        self.weights = self.rows.first_weights(self.missed, noise.least_mm)
        self.last: tuple[Hypothesis, Pool] | None = None

    def run(self, of_a_sample: bool = False) -> Selected:
        """Rounds until nothing changes; those on all rows still follow where these are a sample."""
        previous: State | None = None
        settled = False
        for number in range(ROUNDS):
            self.tell("looking for effects", 0.05 + 0.05 * number)
            new = self.round(STARTS if number < FULL_ROUNDS else None, scanning=number < SCANNING_ROUNDS)
            state = self._state()
            same = previous is not None and self._alike(state, previous)
            if (
                not new
                and same
                and (settled or not self._rests())
                and not (self._noise_changed() or self._scatter_changed())
            ):
                break
            settled = same
            previous = state
            self.candidates = [*self.candidates, *new]
        fine = [refined(self.model.arm, self.recordings, self.pool.candidates[c]) for c in self.best.candidates]
        if any(fine):
            self.candidates = [*self.candidates, *[placed for placed in fine if placed is not None]]
            self.round(None)
            # what looked like scatter may have been what the coarse curves could not follow
            self._take_scatter(self._find_scatter())
            if not of_a_sample:
                self.round(None)
        return self.selected()

    def follow(self, other: SelectionLoop) -> None:
        """Go on from where the rounds on a sample of the rows ended."""
        self.model, self.last, self.scatter, self.growth = other.model, other.last, other.scatter, other.growth
        self.missed = missed(self.model, self.recordings)
        self._weigh_rows(other.fit.noise, whitening(self.scatter, self.moved, other.fit.noise))

    @property
    def left(self) -> Array:
        """(N, 3) mm, what the model leaves of the points."""
        return self.missed.shift

    def round(self, starts: Sequence[tuple[int, ...]] | None, scanning: bool = False) -> list[Placed]:
        """One round; returns new candidates that scanning found. Without starts it goes on from the last round."""
        model, payload = _payload(self.model, self.recordings)
        self.pool = pool(self.frames, self.families, [*self.candidates, *payload])
        self.point = model
        self.blocks = normal_equations_by_block(self.pool, model, self.recordings, self.weights, self.block_of_row)
        self.problem = problem(self.pool, total(self.blocks), self.noise.least_mm)
        search = Search.on(self.problem)
        warm = None if self.last is None else search.transferred(*self.last)
        if starts is None:
            starts = STARTS if warm is None else (warm.background,)
        found = search.best(starts, warm)
        self.found = search.refined(found)
        self.best, self.last = named(search, self.found), (found, self.pool)
        self.fit = self._fitted(model)
        against = self._against_their_load()
        if against:
            self.best = search.without(self.best, against)
            self.fit = self._fitted(model)
        new = self._scanned(search, model) if scanning else []
        self.model, self.missed, self.weights = self.fit.model, self.fit.missed, self.fit.weights
        self._weigh_rows(self.fit.noise, self.weights.whitening)
        return new

    def _fitted(self, model: FittedModel) -> Refit:
        """The best hypothesis fitted with the exact model."""
        effects = [
            (self.pool.candidates[c.candidate], float(self.problem.sizes[c.size]) * (WITHIN if c.nested else 1.0))
            for c in self.best.chosen
        ]
        small = list(zip(self.families, background_sizes(self.problem, self.best), strict=True))
        white = self.weights.whitening
        return refit(model, self.recordings, self.frames, small, effects, self.rows, self.noise.least_mm, white)

    def _against_their_load(self) -> list[int]:
        """Names within a background whose fitted values turned out negative where they can't be."""
        return [
            c.candidate
            for c, part in zip(self.best.chosen, self.fit.model.parts, strict=True)
            if c.nested and self.pool.nonnegative[c.candidate] and part.values[0] < 0
        ]

    def _weigh_rows(self, noise: float, white: Array | None) -> None:
        """What the residuals tell about the rows' noise, and their weights by it."""
        uncertainty = relative_uncertainty(self.recordings, noise, self._by_distance())
        alone = RowNoise(uncertainty, np.ones(len(uncertainty))).weights(self.missed, self.noise.least_mm)
        self.rows = RowNoise(
            uncertainty, independence_weights(self.left, self.pose, alone.robust_weight > INLIER_WEIGHT)
        )
        self.weights = self.rows.weights(self.missed, self.noise.least_mm, white)

    def selected(self) -> Selected:
        """Where the rounds stand."""
        return Selected(
            self.problem, self.blocks, self.point, self.found, self.best, self.fit, tuple(self.scatter), self.growth
        )

    def _state(self) -> State:
        """What must not change any more: the effects and the rows that do not count."""
        chosen = [self.pool.candidates[c] for c in self.best.candidates]
        return frozenset(str(p) + p.variant for p in chosen), self.weights.robust_weight < INLIER_WEIGHT

    def _alike(self, state: State, previous: State) -> bool:
        """Whether two rounds ended alike: the same effects, and the same rows count but for a few of very many."""
        changed = np.count_nonzero(state[1] != previous[1])
        return state[0] == previous[0] and bool(changed <= FLICKERING * len(self.recordings))

    def _rests(self) -> bool:
        """Whether some effect rests on others' values, which then must settle, too."""
        return any(self.pool.candidates[c].effect.requires for c in self.best.candidates)

    def _noise_changed(self) -> bool:
        return self._grows() or self._scatter_changed()

    def _scatter_changed(self) -> bool:
        """Look for scatter in what is left; take its whitening into account where it is new."""
        found = self._find_scatter()
        if {s.motor for s in found} == {s.motor for s in self.scatter}:
            return False
        self._take_scatter(found)
        return True

    def _by_distance(self) -> Array | None:
        """(N,) noise of the rows, mm, where it grows with distance."""
        if self.growth is None:
            return None
        return self.growth.at(np.linalg.norm(self.recordings.positions, axis=1))

    def _grows(self) -> bool:
        """Look for noise that grows with distance in what is left, where no row's own noise is stated."""
        if self.recordings.sigma is not None or self.growth is not None or self.scatter:
            return False
        away = distances(self.model, self.recordings)
        found = None if away is None else growth(self.left, away, self.weights.robust_weight > INLIER_WEIGHT)
        if found is None or found.evidence < sum(each.evidence for each in self._find_scatter()):
            return False
        self.growth = found
        self._weigh_rows(self.fit.noise, self.weights.whitening)
        return True

    def _find_scatter(self) -> list[Scattered]:
        """Scatter in what is left, on as many rows as it takes."""
        rows = np.unique(np.linspace(0, len(self.left) - 1, min(len(self.left), SCATTER_ROWS)).astype(np.intp))
        relative = self.rows.uncertainty[rows, None]
        return find_scatter(self.left[rows] / relative, self.moved[:, rows] / relative, self.noise.least_mm)

    def _take_scatter(self, found: list[Scattered]) -> None:
        """Whiten the rows by scatter of these places and sizes, and evaluate them anew."""
        self.scatter = found
        between = noise_between(self.left, self.moved, found, self.noise.least_mm)
        white = whitening(found, self.moved, between)
        self.weights = self.rows.weights(self.missed, self.noise.least_mm, white)

    def _scanned(self, search: Search, model: FittedModel) -> list[Placed]:
        """New candidates whose scanned numbers promise something, given the best hypothesis and given none."""
        known = {(placed.key, placed.variant) for placed in self.pool.candidates}
        new: dict[tuple[tuple[str, str], str], Placed] = {}
        given = (self.best, search.empty()) if self.best.chosen else (self.best,)
        for scan in (mesh_lines, jumps):
            for placed in scan(self.problem, given, model, self.recordings, self.weights):
                if (placed.key, placed.variant) not in known:
                    new[(placed.key, placed.variant)] = placed
        for placed in self._paused(search, model):
            if (placed.key, placed.variant) not in known:
                new[(placed.key, placed.variant)] = placed
        return list(new.values())

    def _paused(self, search: Search, model: FittedModel) -> Iterator[Placed]:
        """Drifts with one pause more, where the best hypothesis has a drift by the order of rows."""
        chosen = {c: self.pool.candidates[c] for c in self.best.candidates}
        drifts = [
            c for c, placed in chosen.items() if placed.effect is BASE_DRIFT and placed.variant.startswith("rows")
        ]
        if drifts:
            # what else moves the base may be the drift's pauses: all of it, or one of it beside a jump that is one
            beside = [c for c, placed in chosen.items() if placed.location == "base" and c not in drifts]
            for replaced in sorted({(), tuple(beside), *((one,) for one in beside)}):
                rest = search.without(self.best, replaced)
                yield from pauses(self.problem, rest, drifts[0], model, self.recordings, self.weights)


def _payload(model: FittedModel, recordings: Recordings) -> tuple[FittedModel, list[Placed]]:
    """Payload errors on top of what gives way in the model, and the model with its own ones written anew."""
    stiff = [part for part in model.parts if part.placed.effect is not PAYLOAD_ERROR]
    placed = list(payload_errors(recordings, [part for part in stiff if part.placed.parametrisation == "plain"]))
    by_variant = {p.variant: p for p in placed}
    errors = [
        Part(by_variant[part.placed.variant], part.values)
        for part in model.parts
        if part.placed.effect is PAYLOAD_ERROR and part.placed.variant in by_variant
    ]
    return replace(model, parts=(*stiff, *errors)), placed
