"""From recordings to a verdict: frames, then rounds of columns, selection, exact refit and scan, then judgement."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armscope.diagnosis import robust
from armscope.diagnosis.checks import FEWEST_ROWS, check_table, too_far
from armscope.diagnosis.evidence import Hypothesis, Problem, background_sizes, problem
from armscope.diagnosis.frames import fit_frames
from armscope.diagnosis.judge import Evidence, judge, undecided
from armscope.diagnosis.noise import Noise, known_noise, relative_uncertainty
from armscope.diagnosis.problem import COUNTS, Gram, Pool, accumulate, pool, residuals, total
from armscope.diagnosis.refit import Refit, refit
from armscope.diagnosis.scan import jumps, mesh_lines
from armscope.diagnosis.scatter import Scattered, find_scatter, levers, noise_between, whitening
from armscope.diagnosis.search import STARTS, Search
from armscope.diagnosis.validation import Blocks, split
from armscope.diagnosis.verdict import Notice, Verdict
from armscope.diagnosis.weights import RowWeights
from armscope.physics.backgrounds import backgrounds
from armscope.physics.effect import Placed
from armscope.physics.frames import free_frames
from armscope.physics.model import FittedModel
from armscope.physics.payload import PAYLOAD_ERROR, payload_errors
from armscope.physics.registry import library
from armscope.physics.scene import Part
from armscope.recordings import Recordings
from armscope.robot import Arm

Array = NDArray[np.float64]
Progress = Callable[[str, float], None]

ROUNDS, FULL_ROUNDS = 8, 2
"""Rounds at most; the first ones search from all starts, later ones from where the last one ended."""
SAMPLE_ROWS = 5000
"""The first rounds look at this many rows at most; the last one at all of them."""


@dataclass(frozen=True)
class Settings:
    """What a user may ask for.

    Attributes:
        seed: of folds and resampling.
        tool_per_run: whether the tool offset is free in every run, not only per target.
        resamples: how many times rows are resampled for the inclusion frequencies; 0 leaves them out.
        cross_validation: whether the procedure is validated on held-out rows.
    """

    seed: int = 0
    tool_per_run: bool = False
    resamples: int = 10
    cross_validation: bool = True


@dataclass(frozen=True, eq=False)
class Selected:
    """Where the rounds ended."""

    problem: Problem
    blocks: list[Gram]
    best: Hypothesis
    fit: Refit
    scatter: tuple[Scattered, ...]


def diagnose(
    arm: Arm,
    recordings: Recordings,
    settings: Settings | None = None,
    progress: Progress | None = None,
) -> Verdict:
    """Find where in the arm the mismatch arises, which physics was left out, and how large it is.

    Args:
        arm: the nominal arm.
        recordings: measured rows.
        settings: see `Settings`.
        progress: called with a sentence and the share done, 0 ... 1.

    Raises:
        InputError: the recordings don't fit the arm or hold no usable rows.
    """
    settings, tell = settings or Settings(), progress or (lambda text, share: None)
    started = time.perf_counter()
    checked = check_table(arm, recordings)
    table = checked.recordings
    tell("fitting base and tool", 0.02)
    start = fit_frames(arm, table, settings.tool_per_run)
    first = residuals(start, table)
    noise = known_noise(arm, table)
    frames = free_frames(table, settings.tool_per_run)
    obstacle = too_far(arm, table, first) or _too_few(table, frames)
    if obstacle is not None:
        return undecided(start, table, first, noise, (*checked.notices, obstacle), time.perf_counter() - started)
    rng = np.random.default_rng(settings.seed)
    layout = split(table, rng)
    found = select(start, table, first, noise, frames, layout, tell)
    verdict = judge(
        Evidence(
            start,
            table,
            first,
            noise,
            checked.notices,
            layout,
            found.problem,
            found.blocks,
            found.best,
            found.fit,
            found.scatter,
        ),
        settings.resamples,
        settings.cross_validation,
        rng,
        tell,
    )
    tell("done", 1.0)
    return verdict.after(time.perf_counter() - started, vars(settings))


def _too_few(recordings: Recordings, frames: Sequence[Placed]) -> Notice | None:
    free = sum(len(placed.terms) for placed in frames)
    if len(recordings) >= FEWEST_ROWS and 3 * len(recordings) > 2 * free:
        return None
    text = f"{len(recordings)} rows hold {3 * len(recordings)} numbers, {free} of which base and tool take up: too few."
    return Notice("fewer rows than parameters", text)


def select(
    start: FittedModel,
    recordings: Recordings,
    first: Array,
    noise: Noise,
    frames: Sequence[Placed],
    layout: Blocks,
    tell: Progress,
) -> Selected:
    """Rounds of selection and exact refit, until neither effects, suspect rows nor scanned numbers change."""
    arm = start.arm
    candidates = library(arm, recordings)
    families = list(backgrounds(arm, recordings).values())
    moved = levers(start, recordings)
    model, left = start, first
    scatter: list[Scattered] = []
    uncertainty = relative_uncertainty(recordings, robust.scale_of(left))
    weights = RowWeights(robust.first_weights(left, uncertainty, noise.least_mm))
    previous: tuple[frozenset[str], bytes] | None = None
    settled = False
    last: tuple[Hypothesis, Pool] | None = None
    for number in range(ROUNDS):
        tell("looking for effects", 0.05 + 0.05 * number)
        model, payload = _payload(model, recordings)
        columns = pool(frames, families, [*candidates, *payload])
        blocks = accumulate(columns, model, recordings, weights, layout.of_row)
        weighed = problem(columns, total(blocks), noise.least_mm)
        search = Search.on(weighed)
        warm = None if last is None else search.taken_over(*last)
        starts = STARTS if warm is None or number < FULL_ROUNDS else (warm.background,)
        found = search.best(starts, warm)
        best, last = search.promoted(found), (found, columns)
        effects = [(columns.candidates[c.candidate], float(weighed.sizes[c.size])) for c in best.chosen]
        small = list(zip(families, background_sizes(weighed, best), strict=True))
        fit = refit(model, recordings, frames, small, effects, uncertainty, noise.least_mm, weights.turn)
        new = [*_scanned(weighed, best, model, recordings, weights, columns)]
        model, left, weights = fit.model, fit.residuals, fit.weights
        uncertainty = relative_uncertainty(recordings, fit.noise)
        state = frozenset(str(placed) + placed.variant for placed, _ in effects), (weights.row < COUNTS).tobytes()
        if not new and state == previous and (settled or not payload):
            again = find_scatter(left, moved, noise.least_mm)
            if {s.motor for s in again} == {s.motor for s in scatter}:
                break
            scatter = again
            turn = whitening(scatter, moved, noise_between(left, moved, scatter, noise.least_mm))
            white = RowWeights(weights.row, turn).whitened(left)
            weights = RowWeights(robust.weights(white, uncertainty, noise.least_mm), turn)
        settled = state == previous
        previous = state
        candidates = [*candidates, *new]
    return Selected(weighed, blocks, best, fit, tuple(scatter))


def _payload(model: FittedModel, recordings: Recordings) -> tuple[FittedModel, list[Placed]]:
    """Payload errors on top of what gives way in the model, and the model with its own ones written anew."""
    stiff = [part for part in model.parts if part.placed.effect is not PAYLOAD_ERROR]
    placed = list(payload_errors(recordings, [part for part in stiff if part.placed.reading == "plain"]))
    by_variant = {p.variant: p for p in placed}
    errors = [
        Part(by_variant[part.placed.variant], part.values)
        for part in model.parts
        if part.placed.effect is PAYLOAD_ERROR and part.placed.variant in by_variant
    ]
    return replace(model, parts=(*stiff, *errors)), placed


def _scanned(
    weighed: Problem, best: Hypothesis, model: FittedModel, recordings: Recordings, weights: RowWeights, columns: Pool
) -> list[Placed]:
    """New candidates whose scanned numbers promise something, given the best hypothesis and given none."""
    known = {(placed.key, placed.variant) for placed in columns.candidates}
    new: dict[tuple[tuple[str, str], str], Placed] = {}
    given = (best, Search.on(weighed).empty()) if best.chosen else (best,)
    for scan in (mesh_lines, jumps):
        for placed in scan(weighed, given, model, recordings, weights):
            if (placed.key, placed.variant) not in known:
                new[(placed.key, placed.variant)] = placed
    return list(new.values())
