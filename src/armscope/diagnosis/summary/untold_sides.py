"""Play of which only the order of rows tells the side: fitted, told as scatter, and in no model to predict with.

Other rows come in an order of their own, which nobody has stated either. Until the sides are written down, what the
model promises, and what is left of the rows, is therefore without it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.diagnosis.state import DiagnosisState
from armscope.fitting.gaps import is_play_by_approach, rows_of_unknown_side
from armscope.fitting.linearisation import residuals
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings


def untold_plays(state: DiagnosisState) -> list[int]:
    """Chosen candidates that are play by the order of rows."""
    if not state.recordings.sides_by_order:
        return []
    return [c.candidate for c in state.best.chosen if is_play_by_approach(state.space.placed[c.candidate])]


def columns_of_untold(state: DiagnosisState) -> Indices:
    """Columns of the selection's layout that are theirs."""
    columns = [state.space.layout.of(state.space.placed[candidate]) for candidate in untold_plays(state)]
    return np.concatenate([np.empty(0, dtype=np.intp), *columns])


def without_untold(state: DiagnosisState) -> FittedModel:
    """The fitted model without them."""
    model = state.fit.model
    if not state.recordings.sides_by_order:
        return model
    return replace(model, parts=tuple(part for part in model.parts if not is_play_by_approach(part.placed)))


def left_without_untold(state: DiagnosisState) -> Array:
    """(N, 3) mm that the model without them leaves of the rows, base axes."""
    if not untold_plays(state):
        return state.fit.residuals
    return residuals(without_untold(state), state.table).points_mm


def of_unknown_side(state: DiagnosisState) -> NDArray[np.bool_]:
    """(N,) rows to which the order of rows does not tell the way, as the first of a run: no bad shots for that."""
    plays = [state.space.placed[candidate] for candidate in untold_plays(state)]
    return rows_of_unknown_side(state.recordings, plays)


def as_recorded(recordings: Recordings) -> Recordings:
    """The rows without sides that nobody wrote down."""
    return replace(recordings, approach=None, sides_by_order=False) if recordings.sides_by_order else recordings
