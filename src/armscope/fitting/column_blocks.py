"""Sums over rows for blocks of columns that don't enter a model's normal equations: for scans and for the atlas."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array, Indices
from armscope.fitting.design_matrix import ColumnOrder, StructuredDesign, grouped_columns, structured_design
from armscope.fitting.linearisation import Measured, linearised
from armscope.fitting.parameter_layout import ParameterLayout, current_parameters
from armscope.inference.linear_algebra import ColumnBlocks
from armscope.measurement.row_weights import RowWeights
from armscope.measurement.whitening import WhitenedPosture
from armscope.physics.effect import Term
from armscope.physics.model import FittedModel


@dataclass(frozen=True, eq=False)
class TermBlocks:
    """m blocks of c terms, all in the order in which their columns are multiplied: made once where they come again."""

    m: int
    c: int
    order: ColumnOrder

    @classmethod
    def of(cls, blocks: Sequence[Sequence[Term]]) -> TermBlocks:
        """Blocks of equally many terms."""
        return cls(len(blocks), len(blocks[0]), grouped_columns([term for block in blocks for term in block]))


class ModelColumns:
    """Some of a model's columns at rows, and the response: what blocks of terms are multiplied with.

    Args:
        layout: of the model's columns.
        inside: (k,) which of them.
        model: where columns are taken; the response is that before any effect, also of those that are not ``inside``.
        rows: the table and the channels that are used.
        weights: of the rows.
    """

    def __init__(
        self, layout: ParameterLayout, inside: Indices, model: FittedModel, rows: Measured, weights: RowWeights
    ) -> None:
        self.layout, self.model, self.table, self.weights = layout, model, linearised(rows), weights
        self.inside = inside
        self.terms = grouped_columns([layout.terms[i] for i in inside])
        self._kept: list[tuple[WhitenedPosture, StructuredDesign, Array]] | None = None

    def kept(self) -> ModelColumns:
        """The same, computed once where blocks come one after the other."""
        self._kept = list(self._made())
        return self

    def _made(self) -> Iterator[tuple[WhitenedPosture, StructuredDesign, Array]]:
        """Chunk by chunk: how all channels see the rows, the columns, and the response (c, n)."""
        values, active, present = active_effects(self.layout, self.model)
        apart = None if np.isin(active, self.inside).all() else grouped_columns(present)
        for chunk, posture in self.table.chunks(self.model):
            whitener = self.weights.whitener(chunk)
            seen = WhitenedPosture(posture, whitener)
            X, y = structured_design(seen, self.terms), whitener.response(self.model, posture).T
            if apart is None:
                y = y + X.matvec(values[self.inside][self.terms.order])
            else:
                y = y + structured_design(seen, apart).matvec(values[active][apart.order])
            yield seen, X, y

    def sums(self, groups: Sequence[TermBlocks]) -> list[ColumnBlocks]:
        """Sums over rows for blocks of terms, mm per SI unit.

        Args:
            groups: blocks are multiplied with those of their own group alone.

        Returns:
            Of each group: sums of its blocks with themselves, with the columns, and with the response.
        """
        sums = [_Sums.of(terms, len(self.terms.order)) for terms in groups]
        for seen, X, y in self._made() if self._kept is None else self._kept:
            for each in sums:
                each.add(structured_design(seen, each.terms.order), X, y)
        return [each.blocks(self.terms.back) for each in sums]


@dataclass(eq=False)
class _Sums:
    """Sums over some rows for blocks of terms; of those that move in one direction, only what is within each block."""

    terms: TermBlocks
    own: Array
    cross: Array
    b: Array

    @classmethod
    def of(cls, terms: TermBlocks, k: int) -> _Sums:
        m, c = terms.m, terms.c
        own = np.zeros((m, c, c) if terms.order.is_one_group else (m * c, m * c))
        return cls(terms, own, np.zeros((k, m * c)), np.zeros(m * c))

    def add(self, E: StructuredDesign, X: StructuredDesign, y: Array) -> None:
        if self.terms.order.is_one_group:
            self.own += E.within_blocks(self.terms.m)
        else:
            E.add_products(self.own)
        self.cross += X.products(E)
        self.b += E.rmatvec(y)

    def blocks(self, model_back: Indices) -> ColumnBlocks:
        m, c, order, own = self.terms.m, self.terms.c, self.terms.order, self.own
        if not order.is_one_group:
            own = order.whole(own).reshape(m, c, m, c)[np.arange(m), :, np.arange(m), :]
        cross = self.cross[np.ix_(model_back, order.back)].reshape(-1, m, c)
        return ColumnBlocks(own, np.moveaxis(cross, 1, 0), self.b[order.back].reshape(m, c))


def active_effects(layout: ParameterLayout, model: FittedModel) -> tuple[Array, Indices, list[Term]]:
    """The model's values (p,), which of them are not zero, and their terms."""
    values = current_parameters(layout, model)
    active = np.flatnonzero(values)
    return values, active, [layout.terms[i] for i in active]
