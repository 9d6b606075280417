"""Sums over rows for blocks of columns that don't enter a model's normal equations: for scans and for the atlas."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.types import Array, Indices
from armscope.fitting.design_matrix import grouped_columns, structured_design
from armscope.fitting.linearisation import Measured, current_parameters, linearised
from armscope.fitting.parameter_layout import ParameterLayout
from armscope.inference.linear_algebra import ColumnBlocks
from armscope.measurement.row_weights import RowWeights
from armscope.measurement.whitening import WhitenedPosture
from armscope.physics.effect import Term
from armscope.physics.model import FittedModel


def column_blocks(
    blocks: Sequence[Sequence[Term]],
    layout: ParameterLayout,
    inside: Indices,
    model: FittedModel,
    rows: Measured,
    weights: RowWeights,
) -> ColumnBlocks:
    """Sums over rows for blocks of equally many terms against some of a layout's columns, mm per SI unit.

    Args:
        blocks: m blocks of c terms.
        layout: of the model's columns.
        inside: (k,) which of them.
        model: where columns are taken; the response is that before any effect, also of those that are not ``inside``.
        rows: the table and the channels that are used.
        weights: of the rows.
        recordings: the rows.

    Returns:
        Sums of the blocks with themselves, with the columns, and with the response.
    """
    m, c = len(blocks), len(blocks[0])
    beside = grouped_columns([term for block in blocks for term in block])
    model_terms = grouped_columns([layout.terms[i] for i in inside])
    values, active, present = active_effects(layout, model)
    column_order = grouped_columns(present)
    k = len(inside)
    own, cross, b = np.zeros((m * c, m * c)), np.zeros((k, m * c)), np.zeros(m * c)
    for chunk, posture in linearised(rows).chunks(model):
        whitener = weights.whitener(chunk)
        seen = WhitenedPosture(posture, whitener)
        y = whitener.response(model, posture).T + structured_design(seen, column_order).matvec(
            values[active][column_order.order]
        )
        E = structured_design(seen, beside)
        E.add_products(own)
        cross += structured_design(seen, model_terms).products(E)
        b += E.rmatvec(y)
    own = beside.whole(own).reshape(m, c, m, c)[np.arange(m), :, np.arange(m), :]
    cross = cross[np.ix_(model_terms.back, beside.back)]
    return ColumnBlocks(own, np.moveaxis(cross.reshape(k, m, c), 1, 0), b[beside.back].reshape(m, c))


def active_effects(layout: ParameterLayout, model: FittedModel) -> tuple[Array, Indices, list[Term]]:
    """The model's values (p,), which of them are not zero, and their terms."""
    values = current_parameters(layout, model)
    active = np.flatnonzero(values)
    return values, active, [layout.terms[i] for i in active]
