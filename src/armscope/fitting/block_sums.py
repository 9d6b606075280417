"""The linear problem: every column of the library at the current model, reduced to normal equations per block of rows.

Columns live only chunk by chunk; what stays is X'WX, X'Wy and y'Wy per block of rows. Selection, resampling and
cross-validation work on sums of blocks, so their cost does not depend on the number of rows.
Lengths are mm here: y and the columns are displacements of the tool in base axes, mm per SI unit of a term.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.sampling import in_one_stretch
from armscope.core.types import Array, Indices
from armscope.fitting.design_matrix import StructuredDesign, structured_design
from armscope.fitting.linearisation import Chunks, Measured, linearised
from armscope.fitting.parameter_layout import ParameterLayout, current_parameters
from armscope.inference.normal_equations import NormalEquations
from armscope.measurement.row_weights import RowWeights
from armscope.measurement.whitening import WhitenedPosture
from armscope.physics.model import FittedModel


def normal_equations_by_block(
    layout: ParameterLayout, model: FittedModel, rows: Measured, weights: RowWeights, blocks: Indices
) -> list[NormalEquations]:
    """Normal equations of each block of rows.

    The response is the residual of the model plus what its own effects contribute linearly, so that every hypothesis
    starts from no effects while the linearisation stands where the model stands.

    Args:
        layout: of the model's columns.
        model: the point of linearisation.
        rows: a table, or recordings.
        weights: of the rows; only the channels that they are of count.
        blocks: (N,) number of each row's block, from 0.

    Returns:
        One per block, mm per SI unit.
    """
    column_order = layout.column_order
    current = current_parameters(layout, model)[column_order.order]
    count, p = int(blocks.max()) + 1, len(layout.terms)
    table = linearised(rows)

    def of_part(chunks: Chunks) -> dict[int, _Sums]:
        sums: dict[int, _Sums] = {}
        for chunk, posture in chunks:
            whitener = weights.whitener(chunk)
            seen = structured_design(WhitenedPosture(posture, whitener), column_order)
            y = whitener.response(model, posture).T + seen.matvec(current)
            numbers, inside = weights.numbers(chunk), blocks[chunk]
            for block in np.unique(inside):
                at = in_one_stretch(np.flatnonzero(inside == block))
                sums.setdefault(int(block), _Sums.of(p)).add(seen.at(at), y[:, at], float(numbers[at].sum()))
        return sums

    order = np.argsort(blocks, kind="stable") if count > 1 and not table.keeps else None
    first, *others = table.each_part(model, of_part, order)
    whole = [first.pop(block) if block in first else _Sums.of(p) for block in range(count)]
    for part in others:
        for block, sums in part.items():
            whole[block].join(sums)
    back = column_order.back
    # one after the other: each has millions of numbers
    whole.reverse()
    return [(s := whole.pop()).equations(column_order.whole(s.G), back) for _ in range(count)]


@dataclass(frozen=True, eq=False)
class Slope:
    """What a model leaves of all rows, and where that falls: X'Wr (p,), r'Wr, and the number of weighted residuals."""

    b: Array
    left: float
    n: float

    def about(self, G: Array, at: Array) -> NormalEquations:
        """Normal equations at a model whose values are ``at`` (p,), from products G (p, p) of the columns there."""
        b = self.b + G @ at
        return NormalEquations(G, b, self.left + float((self.b + b) @ at), self.n)


def slope_at(layout: ParameterLayout, model: FittedModel, rows: Measured, weights: RowWeights) -> Slope:
    """The slope of the misfit at a model, without the products of columns, which take most of the time.

    Args:
        layout: of the model's columns.
        model: where columns are taken.
        rows: a table, or recordings.
        weights: of the rows; only the channels that they are of count.

    Returns:
        Sums over the rows, mm per SI unit.
    """
    order = layout.column_order

    def of_part(chunks: Chunks) -> Slope:
        b, left, n = np.zeros(len(layout.terms)), 0.0, 0.0
        for chunk, posture in chunks:
            whitener = weights.whitener(chunk)
            y = whitener.response(model, posture).T
            b += structured_design(WhitenedPosture(posture, whitener), order).rmatvec(y)
            left += float(np.vdot(y, y))
            n += float(weights.numbers(chunk).sum())
        return Slope(b[order.back], left, n)

    parts = linearised(rows).each_part(model, of_part)
    return Slope(np.sum([part.b for part in parts], axis=0), sum(p.left for p in parts), sum(p.n for p in parts))


@dataclass(eq=False)
class _Sums:
    """Sums over some rows in the order of a layout's columns; of G only the upper blocks."""

    G: Array
    b: Array
    yy: float = 0.0
    n: float = 0.0

    @classmethod
    def of(cls, p: int) -> _Sums:
        return cls(np.zeros((p, p)), np.zeros(p))

    def add(self, seen: StructuredDesign, y: Array, n: float) -> None:
        seen.add_products(self.G)
        self.b += seen.rmatvec(y)
        self.yy += float(np.vdot(y, y))
        self.n += n

    def join(self, other: _Sums) -> None:
        self.G += other.G
        self.b += other.b
        self.yy += other.yy
        self.n += other.n

    def equations(self, G: Array, back: Indices) -> NormalEquations:
        return NormalEquations(G, self.b[back], self.yy, self.n)
