"""Rounds of columns -> selection -> exact refit -> scan, until neither effects, suspect rows nor scatter change."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from armscope.core.types import Indices, Progress
from armscope.diagnosis.constants import LOOP
from armscope.diagnosis.errors_of_loads import on_loads
from armscope.diagnosis.free_curves import predicted_without_curves, told_by_laws
from armscope.diagnosis.implausible import more_plausible, without_implausible
from armscope.diagnosis.kept_effects import kept_effects
from armscope.diagnosis.model_space import EffectSpace, build_model_space
from armscope.diagnosis.naming import named
from armscope.diagnosis.round_state import RoundState
from armscope.diagnosis.row_noise import NoiseOfRows
from armscope.diagnosis.scans.constants import SCANS
from armscope.diagnosis.scans.context import ScanContext, few_rows
from armscope.diagnosis.scans.new_candidates import scanned_candidates
from armscope.diagnosis.sizes_of_waves import GEARS, freedom_of_waves, with_sizes_of_rows
from armscope.diagnosis.state import Selected
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.constants import STEPS
from armscope.fitting.linearisation import Measured, linearised, residuals
from armscope.fitting.refit import Refit, refit
from armscope.fitting.summed_rows import SummedRows
from armscope.inference.edits import replaced
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.model_space import BackgroundSizes
from armscope.inference.normal_equations import NormalEquations, total
from armscope.inference.problem import Problem, background_sizes, build_problem
from armscope.inference.search import Search
from armscope.measurement.noise import Noise
from armscope.physics.backgrounds import DRIFT, FAMILIES, backgrounds, gear_waves
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.drift import base_shifts_of_runs
from armscope.physics.effect import Placed
from armscope.physics.frames import set_ups_of
from armscope.physics.freeform import follows_own_angle, refined
from armscope.physics.model import FittedModel
from armscope.physics.registry import library
from armscope.physics.soft_start import soft_starts
from armscope.physics.transmission import MESH_COUNTS


class SelectionLoop:
    """The rounds on one table.

    Args:
        start: the arm with its frames fitted.
        rows: a table, or recordings.
        noise: what is known of it.
        frames: the free frames.
        block_of_row: (N,) which block of rows each row is in.
        progress: told how far it is.
    """

    def __init__(
        self,
        start: FittedModel,
        rows: Measured,
        noise: Noise,
        frames: Sequence[Placed],
        block_of_row: Indices,
        progress: Progress,
    ) -> None:
        self.table = linearised(rows).in_order(np.argsort(block_of_row, kind="stable"))
        self.recordings = recordings = self.table.recordings
        self.frames, self.progress, self.block_of_row = frames, progress, block_of_row
        self.candidates: list[Placed] = []
        self.families: list[list[Placed]] = []
        self.model = start
        self.noise = NoiseOfRows(start, self.table, noise, residuals(start, self.table))
        self.loads: list[Placed] = []
        self.last: tuple[Hypothesis, EffectSpace] | None = None
        self.scans, self.scanned = 0, few_rows(recordings)
        self.by_block: list[NormalEquations] | None = None
        self.summed: SummedRows | None = None
        self.fit: Refit

    def run(self) -> Selected:
        """Rounds until nothing changes, and what of that earns its place."""
        self.search()
        self._look_for_lines_again()
        for _ in range(LOOP.late_scans if self.noise.scatter else 0):
            if self.noise.scatter_has_changed():  # told anew from what a fit leaves that knows of it
                self.round(self._where_it_ended())
        return self.earned(finer=True)

    def search(self, of_a_sample: bool = False) -> None:
        """Rounds until nothing changes, without free curves if that predicts more; all rows may still follow."""
        self._settle()
        plainer = predicted_without_curves(self.problem, self.blocks, self.found)
        if plainer is not None:
            self._take(Search.on(self.problem), plainer)
            self.model = self.fit.model
            self.candidates = [placed for placed in self.candidates if placed.parametrisation != "curve"]
            self._settle()
        self._refine(of_a_sample)

    def _settle(self) -> None:
        """Rounds until nothing changes."""
        previous: RoundState | None = None
        settled = False
        for number in range(LOOP.rounds):
            self.progress("looking for effects", 0.05 + 0.05 * number)
            new = self.round(
                None if number < LOOP.full_rounds else self._where_it_ended(), number < LOOP.scanning_rounds
            )
            state = self._state()
            same = previous is not None and state.is_like(previous)
            depends = any(c in self.space.requires for c in self.best.candidates)  # on values that must settle, too
            may_end = not new and same and (settled or not depends)
            if may_end and not self.noise.has_changed(self.model, self.fit.noise):
                break
            settled, previous = same, state
            self.candidates = [*self.candidates, *new]

    def _refine(self, of_a_sample: bool) -> None:
        """Finer forms of the curves and gears that were chosen; what they can't follow may be scatter."""
        fine = [refined(self.model.arm, self.recordings, self.space.placed[c]) for c in self.best.candidates]
        curves = any(follows_own_angle(self.space.placed[c]) for c in self.best.candidates)
        if not self.best.background[GEARS] and not curves:
            return
        self.candidates = [*self.candidates, *[placed for placed in fine if placed is not None]]
        starts = self._where_it_ended() or []
        if not of_a_sample:  # a long table tells every joint's curve
            self.families[GEARS] = gear_waves(self.recordings, PLAUSIBLE.fine_waves)
            # curves of some joints, coarse ones of a short table, too, may be what all gears have a little of
            starts += [replaced(start, GEARS, LOOP.size_of_gears) for start in starts if not start[GEARS]]
        self.round(starts)
        # what looked like scatter may have been what the coarse curves could not follow
        self.noise.look_for_scatter()
        if not of_a_sample:
            self.round(self._where_it_ended())

    def _look_for_lines_again(self) -> None:
        """Gears' lines that stand out only now that all else is known, the largest first."""
        for _ in range(LOOP.late_scans):
            new = self._scanned(Search.on(self.problem), MESH_COUNTS[-1])
            if not new:
                break
            known = self._state()
            self.candidates = [*self.candidates, *new]
            self.round(self._where_it_ended())
            if self._state().is_like(known):
                break
            self.noise.look_for_scatter()  # what looked like it may have been the line
            self.round(self._where_it_ended())

    def follow(self, other: SelectionLoop, candidates: Sequence[Placed]) -> None:
        """Go on from where the rounds on a sample of the rows ended, with fewer candidates."""
        self.candidates, self.families = list(candidates), other.families
        self.model, self.last = other.model, other.last
        self.noise.follow(other.noise, residuals(self.model, self.table), other.fit.noise)

    def _where_it_ended(self) -> list[BackgroundSizes] | None:
        """The background from which the next search starts."""
        return None if self.last is None else [self.last[0].background]

    def round(
        self, starts: Sequence[BackgroundSizes] | None = None, scanning: bool = False, last: bool = False
    ) -> list[Placed]:
        """One round.

        Args:
            starts: backgrounds from which the search starts; all of the space's where not given.
            scanning: whether scanned numbers are looked for.
            last: whether it is known to be the last: its sums are then kept block by block.

        Returns:
            New candidates that scanning found.
        """
        if not self.families:  # on all rows of a long table they are those that its sample left
            arm, set_ups = self.model.arm, set_ups_of(self.frames)
            families = backgrounds(arm, self.recordings, set_ups)
            others = [*base_shifts_of_runs(set_ups), *soft_starts(arm, self.recordings)]
            self.candidates = [*library(arm, self.recordings), *others]
            self.families = list(families.values())
        self.point, payload, self.loads = on_loads(self.model, self.recordings)
        self.space = build_model_space(self.frames, self.families, [*self.candidates, *payload], self.loads)
        self.weights = self.noise.weights
        sums = self._sums(self.block_of_row if last else 0 * self.block_of_row)
        self.by_block = sums if last else None
        self.problem = build_problem(self.space, together := total(sums), self.noise.least_mm)
        self.summed = self._summed(together) if last and len(self.table) > STEPS.quickly_passed else None
        search = Search.on(self.problem)
        self._take(search, search.best(starts, None if self.last is None else search.transferred(*self.last)))
        self.scans += scanning
        most = MESH_COUNTS[-1] if self.scans == SCANS.scan_of_fine_lines else SCANS.ordinary_lines
        new = self._scanned(search, most) if scanning else []
        self.model = self.fit.model
        if not self.summed or self.summed.are_passed_over:  # else what all rows leave is still to come
            self.noise.weigh(self.fit.channel_residuals, self.fit.noise, self.fit.weights.whitening)
        return new

    @property
    def blocks(self) -> list[NormalEquations]:
        """Sums over each block of rows in the last round; rounds on the way need their total alone."""
        self.by_block = self.by_block or self._sums(self.block_of_row)
        return self.by_block

    def _sums(self, block_of_row: Indices) -> list[NormalEquations]:
        return normal_equations_by_block(self.space.layout, self.point, self.table, self.weights, block_of_row)

    def _take(self, search: Search, found: Hypothesis) -> None:
        """Names and the exact fit of a hypothesis."""
        self.found, self.last = search.refined(told_by_laws(search, found)), (found, self.space)
        self._fit(named(search, self.space, self.found))

    def _fit(self, best: Hypothesis, of_all: bool = False) -> None:
        """The exact fit of the names, without those that no arm can have."""
        left, fit = without_implausible(self.problem, self.space, best, self._fitted)
        self.best, self.fit = more_plausible(self.problem, left, fit, self._fitted)
        if of_all and self.summed:
            self.fit = self._fitted(self.best, self.fit.model)

    def _fitted(self, best: Hypothesis, near: FittedModel | None = None) -> Refit:
        """A hypothesis fitted with the exact model; of a long table to the end only if it is near (the last fit)."""
        effects = [
            (self.space.placed[c.candidate], float(self.problem.sizes[c.size]) * (LOOP.within if c.nested else 1.0))
            for c in best.chosen
        ]
        small = list(zip(self.families, background_sizes(self.problem, best.background), strict=True))
        (masses,) = self.space.companions
        small.append((self.loads, float(masses.joins(best.candidates, best.background))))
        rows, noise, start = self.summed or self.table, self.noise, self.point
        if self.summed:
            self.summed.on_the_way = near is None
            start = near if near and self.summed.are_passed_over else start
        return refit(start, rows, self.frames, small, effects, noise.rows, noise.least_mm, noise.weights.whitening)

    def _summed(self, together: NormalEquations) -> SummedRows:
        """A long table with its sums, where its fits start; where it is very long, they pass over its rows once."""
        few, known = len(self.table) <= STEPS.kept_rows, (self.table, self.space.layout, self.point, together)
        return SummedRows.few(*known) if few else SummedRows.of(*known, LOOP.rows_of_a_group)

    def earned(self, finer: bool = False) -> Selected:
        """Where the rounds stand, without what makes held-out rows worse, gears' waves as the rows say.

        Args:
            finer: whether gears have finer waves in the last fit, which no search could afford.
        """
        wander = self.families[FAMILIES.index(DRIFT)]
        left = kept_effects(self.problem, self.blocks, self.best, self.space, wander)
        waves = self._waves(left, finer)
        if self.summed or left is not self.best or waves != self.families[GEARS]:
            self.families[GEARS] = waves
            self._fit(left, of_all=True)
            self.model = self.fit.model
        return self.selected()

    def _waves(self, left: Hypothesis, finer: bool) -> list[Placed]:
        """Gears' waves in the last fit, as large as the rows say."""
        waves, settled = self.families[GEARS], (self.problem, self.space, left)
        freedom = freedom_of_waves(*settled, self.blocks, waves)
        if finer and left.background[GEARS]:
            waves = gear_waves(self.recordings, PLAUSIBLE.finest_waves)
        if freedom is None:
            return waves
        return with_sizes_of_rows(*(self._beside(left, waves) if finer else settled), waves, freedom)

    def _beside(self, left: Hypothesis, waves: Sequence[Placed]) -> tuple[Problem, EffectSpace, Hypothesis]:
        """The sums of what was chosen alone, beside other waves of gears."""
        families = [*self.families[:GEARS], waves, *self.families[GEARS + 1 :]]
        chosen = [self.space.placed[c.candidate] for c in left.chosen]
        fitted = [part.placed for part in self.point.parts]
        space = build_model_space(self.frames, families, [*chosen, *fitted], self.loads)
        (sums,) = normal_equations_by_block(space.layout, self.point, self.table, self.weights, 0 * self.block_of_row)
        problem = build_problem(space, sums, self.noise.least_mm)
        same = tuple(replace(c, candidate=number) for number, c in enumerate(left.chosen))
        return problem, space, evaluate(problem, same, left.background, left.noise)

    def selected(self) -> Selected:
        """Where the rounds stand."""
        return Selected(
            space=self.space,
            problem=self.problem,
            blocks=self.blocks,
            point=self.point,
            found=self.found,
            best=self.best,
            fit=self.fit,
            scatter=tuple(self.noise.scatter),
            growth=self.noise.growth,
            table=self.table,
        )

    def _state(self) -> RoundState:
        chosen = [self.space.candidates[c] for c in self.best.candidates]
        return RoundState.of(chosen, self.noise.weights)

    def _scanned(self, search: Search, most: int) -> list[Placed]:
        """New candidates whose scanned numbers promise something; gears' lines up to so many per turn."""
        context = ScanContext(self.problem, self.space, self.point, self.recordings, self.noise.weights, self.scanned)
        return scanned_candidates(context, search, self.best, most)
