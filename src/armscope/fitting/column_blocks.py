"""Sums over rows for blocks of columns that don't enter a model's normal equations: for scans and for the atlas."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.types import Array, Indices
from armscope.fitting.design_matrix import arranged, stacked
from armscope.fitting.linearisation import chunks, pool_values, response
from armscope.fitting.parameter_layout import ParameterLayout
from armscope.inference.linear_algebra import ColumnBlocks
from armscope.measurement.row_weights import RowWeights
from armscope.physics.effect import Term
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings


def column_blocks(
    blocks: Sequence[Sequence[Term]],
    layout: ParameterLayout,
    inside: Indices,
    model: FittedModel,
    recordings: Recordings,
    weights: RowWeights,
) -> ColumnBlocks:
    """Sums over rows for blocks of equally many terms against some of a layout's columns, mm per SI unit.

    Args:
        blocks: m blocks of c terms.
        layout: of the model's columns.
        inside: (k,) which of them.
        model: where columns are taken; the response is that before any effect, also of those that are not ``inside``.
        recordings: the rows.
        weights: of the rows.
    """
    m, c = len(blocks), len(blocks[0])
    beside = arranged([term for block in blocks for term in block])
    model_terms = arranged([layout.terms[i] for i in inside])
    values, active, present = active_effects(layout, model)
    arrangement = arranged(present)
    k = len(inside)
    own, cross, b = np.zeros((m * c, m * c)), np.zeros((k, m * c)), np.zeros(m * c)
    for rows, posture in chunks(model, recordings):
        lens = weights.lens(rows)
        seen = posture.through(lens)
        y = response(model, posture, lens).T + stacked(seen, arrangement).combined(values[active][arrangement.order])
        E = stacked(seen, beside)
        E.add_products(own)
        cross += stacked(seen, model_terms).products(E)
        b += E.onto(y)
    own = beside.whole(own).reshape(m, c, m, c)[np.arange(m), :, np.arange(m), :]
    cross = cross[np.ix_(model_terms.back, beside.back)]
    return ColumnBlocks(own, np.moveaxis(cross.reshape(k, m, c), 1, 0), b[beside.back].reshape(m, c))


def active_effects(layout: ParameterLayout, model: FittedModel) -> tuple[Array, Indices, list[Term]]:
    """The model's values (p,), which of them are not zero, and their terms."""
    values = pool_values(layout, model)
    active = np.flatnonzero(values)
    return values, active, [layout.terms[i] for i in active]
