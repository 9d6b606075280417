"""Blocks of columns that are weighed against a model without entering its Gram matrix: for scans and for the atlas."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.fitting.design_matrix import grouped_columns, structured_design
from armscope.fitting.linearisation import chunks, current_parameters, response
from armscope.fitting.model_space import Pool
from armscope.inference.evidence import solve_lower
from armscope.measurement.row_weights import RowWeights
from armscope.physics.effect import Term
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings


@dataclass(frozen=True, eq=False)
class ColumnBlocks:
    """m blocks of c columns beside k columns of a model; mm per SI unit.

    Attributes:
        own: (m, c, c) X'WX within each block.
        cross: (m, k, c) model columns against the block's.
        b: (m, c) X'Wy.
    """

    own: Array
    cross: Array
    b: Array


def weigh_blocks(
    blocks: Sequence[Sequence[Term]],
    pool: Pool,
    inside: NDArray[np.intp],
    model: FittedModel,
    recordings: Recordings,
    weights: RowWeights,
) -> ColumnBlocks:
    """Sums over rows for blocks of equally many terms against the pool's columns ``inside``."""
    m, c = len(blocks), len(blocks[0])
    beside = grouped_columns([term for block in blocks for term in block])
    model_terms = grouped_columns([pool.terms[i] for i in inside])
    values = current_parameters(pool, model)
    # the response before any effect, also of those that are not among the columns inside
    active = np.flatnonzero(values)
    present = grouped_columns([pool.terms[i] for i in active])
    k = len(inside)
    own, cross, b = np.zeros((m * c, m * c)), np.zeros((k, m * c)), np.zeros(m * c)
    for rows, posture in chunks(model, recordings):
        lens = weights.lens(rows)
        seen = posture.through(lens)
        y = response(model, posture, lens).T + structured_design(seen, present).matvec(values[active][present.order])
        E = structured_design(seen, beside)
        E.add_products(own)
        cross += structured_design(seen, model_terms).products(E)
        b += E.rmatvec(y)
    own = beside.whole(own).reshape(m, c, m, c)[np.arange(m), :, np.arange(m), :]
    cross = cross[np.ix_(model_terms.back, beside.back)]
    return ColumnBlocks(own, np.moveaxis(cross.reshape(k, m, c), 1, 0), b[beside.back].reshape(m, c))


def schur_complement(blocks: ColumnBlocks, factor: Array, whitened_rhs: Array) -> tuple[Array, Array]:
    """(own, b) of the blocks once the model's posterior is conditioned on.

    Args:
        factor: (k, k) Cholesky factor of the model's penalised Gram matrix, in the blocks' units.
        whitened_rhs: (k,) factor^-1 X'Wy of the model.
    """
    m, k, c = blocks.cross.shape
    V = solve_lower(factor, blocks.cross.transpose(1, 0, 2).reshape(k, m * c))
    V = V.reshape(k, m, c).transpose(1, 0, 2)
    return blocks.own - np.swapaxes(V, 1, 2) @ V, blocks.b - np.einsum("mkc,k->mc", V, whitened_rhs)


def rss_reduction(own: Array, b: Array, before: Array, tiny: float = 1e-6) -> Array:
    """(m,) reduction of the sum of squares by each block; directions that the model absorbs already count nothing.

    Args:
        before: (m, c) diagonal of the blocks' own matrices before conditioning: what "absorbed" is measured against.
    """
    norm = np.sqrt(np.maximum(before, 1e-300))
    scaled = own / (norm[:, :, None] * norm[:, None, :])
    values, vectors = np.linalg.eigh(scaled)
    u = np.einsum("mij,mi->mj", vectors, b / norm)
    return np.asarray(np.sum(np.where(values > tiny, u**2 / np.maximum(values, tiny), 0.0), axis=1))
