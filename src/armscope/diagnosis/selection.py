"""The selection on a table of any length: a long one on a sample of its rows first.

All rows then weigh what could matter, once.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.types import Indices, Progress
from armscope.diagnosis.constants import LOOP
from armscope.diagnosis.errors_of_loads import OF_PAYLOADS
from armscope.diagnosis.selection_loop import SelectionLoop
from armscope.diagnosis.sided_by_loads import SelectionWithSidesOfLoads
from armscope.diagnosis.state import Selected
from armscope.fitting.linearisation import LinearisedTable
from armscope.inference.additions import best_additions
from armscope.inference.search import Search
from armscope.measurement.noise import Noise
from armscope.physics.effect import Placed
from armscope.physics.model import FittedModel
from armscope.recordings.some_rows import some_rows


def select(
    start: FittedModel,
    table: LinearisedTable,
    noise: Noise,
    frames: Sequence[Placed],
    block_of_row: Indices,
    progress: Progress,
) -> Selected:
    """The effects that the evidence asks for, fitted with the exact model.

    Args:
        start: the arm with its frames.
        table: the rows, and the channels that are used.
        noise: what is known of it.
        frames: always free.
        block_of_row: (N,) number of each row's block.
        progress: hears what is being done.

    Returns:
        The selection with its problem, model, weights and sums per block.
    """
    if len(table) <= LOOP.sample_rows:
        return SelectionWithSidesOfLoads(start, table, noise, frames, block_of_row, progress).run()
    rows = some_rows(table.recordings, LOOP.sample_rows, LOOP.rows_of_a_group)
    small = SelectionWithSidesOfLoads(start, table.rows(rows), noise, frames, block_of_row[rows], progress)
    small.search(of_a_sample=True)
    whole = SelectionWithSidesOfLoads(start, table, noise, frames, block_of_row, progress)
    whole.follow(small, _promising(small))
    background = small.best.background
    del small  # what it keeps of its rows and columns would take as much memory as all else
    progress("weighing all rows", 0.45)
    whole.round((background,), last=True)
    return whole.earned()


def _promising(found: SelectionLoop) -> list[Placed]:
    """The chosen effects and those that come next, given the best hypothesis and given none."""
    search = Search.on(found.problem)
    candidates = found.space.candidates
    kept = set(found.best.candidates) | {n for n, candidate in enumerate(candidates) if not candidate.competes}
    kept |= {coarse for n in kept if (coarse := candidates[n].refines) is not None}
    for hypothesis in (found.best, search.empty()):
        gain, _ = best_additions(found.problem, search.groups, hypothesis)
        kept |= {int(c) for c in np.argsort(-gain)[: LOOP.promising // 2]}
    return [found.space.placed[c] for c in sorted(kept) if found.space.placed[c].effect not in OF_PAYLOADS]
