"""The linear problem: every column of the library at the current model, reduced to normal equations.

Columns live only chunk by chunk; what stays is X'WX, X'Wy and y'Wy per block of rows. Selection, resampling and
cross-validation work on sums of blocks, so their cost does not depend on the number of rows.
Lengths are mm here: y and the columns are displacements of the tool in base axes, mm per SI unit of a term.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from armscope.core.parallel import each_piece
from armscope.core.types import Array, Indices
from armscope.fitting.constants import STEPS
from armscope.fitting.design_matrix import StructuredDesign, structured_design
from armscope.fitting.parameter_layout import ParameterLayout
from armscope.inference.normal_equations import NormalEquations
from armscope.measurement.channel import Channel, ChannelResiduals
from armscope.measurement.positions import POSITIONS
from armscope.measurement.registry import supported
from armscope.measurement.row_weights import RowWeights
from armscope.measurement.whitening import WhitenedPosture
from armscope.physics.model import FittedModel
from armscope.physics.posture import Posture
from armscope.physics.scene import Scene
from armscope.recordings import Recordings

Result = TypeVar("Result")
Chunks = Iterator[tuple[Indices, Posture]]
"""(rows, posture), chunk by chunk."""


@dataclass(eq=False)
class LinearisedTable:
    """A table's rows with what is computed on them, chunk by chunk, for a model that they are linearised about.

    Attributes:
        recordings: the rows.
        channels: what was measured there; the reference comes first.
        order: (N,) of the rows in which chunks take them, rows of one block side by side. Where it is given, what
            drives the effects is computed once, unless the table is long, and so is how the last model stands.
    """

    recordings: Recordings
    channels: tuple[Channel, ...] = ()
    order: Indices | None = None
    _scenes: list[tuple[Indices, Scene]] = field(default_factory=list, repr=False)
    _model: FittedModel | None = field(default=None, repr=False)
    _postures: list[Posture] = field(default_factory=list, repr=False)
    _left: tuple[FittedModel, ChannelResiduals] | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        self.channels = self.channels or supported(self.recordings)

    def __len__(self) -> int:
        return len(self.recordings)

    @property
    def keeps(self) -> bool:
        """Whether what was computed is kept between passes."""
        return self.order is not None and len(self) <= STEPS.kept_rows

    def rows(self, rows: Indices) -> LinearisedTable:
        """Some of the rows; nothing is kept of them."""
        return LinearisedTable(self.recordings.rows(rows), self.channels)

    def chunks(self, model: FittedModel, order: Indices | None = None, part: slice = slice(None)) -> Chunks:
        """(rows, posture) of the model, chunk by chunk.

        Args:
            model: whose posture it is.
            order: (N,) of rows, unless the table has its own.
            part: which rows of that order, where nothing is kept.

        Returns:
            Numbers of n rows, and how the model stands there.
        """
        if not self.keeps:
            yield from ((rows, model.posture(scene)) for rows, scene in self._made(model, order, part))
            return
        self._scenes = self._scenes or list(self._made(model, self.order, slice(None)))
        if self._model is not model:
            self._postures = [model.posture(scene) for _, scene in self._scenes]
            self._model = model
        yield from ((rows, posture) for (rows, _), posture in zip(self._scenes, self._postures, strict=True))

    def _made(self, model: FittedModel, order: Indices | None, part: slice) -> Iterator[tuple[Indices, Scene]]:
        order = (np.arange(len(self)) if order is None else order)[part]
        for start in range(0, len(order), STEPS.chunk_rows):
            rows = order[start : start + STEPS.chunk_rows]
            yield rows, model.scene(self.recordings.rows(rows))

    def each_part(
        self,
        model: FittedModel,
        work: Callable[[Chunks], Result],
        order: Indices | None = None,
    ) -> list[Result]:
        """What ``work`` makes of the chunks of each part of the table, in their order; a long table has several.

        Args:
            model: whose posture is taken.
            work: done by several processes where they are allowed; see `armscope.core.parallel`.
            order: (N,) of rows, unless the table has its own.

        Returns:
            One result per part, the same for any number of processes.
        """
        size = len(self) if self.keeps else STEPS.chunk_rows * STEPS.chunks_of_a_part
        parts = [slice(start, start + size) for start in range(0, len(self), size)]
        return each_piece(parts, lambda part: work(self.chunks(model, order, part)))


Measured = LinearisedTable | Recordings
"""Rows; of recordings all channels count that they support."""


def linearised(rows: Measured) -> LinearisedTable:
    """The rows as a table to linearise."""
    return rows if isinstance(rows, LinearisedTable) else LinearisedTable(rows)


def residuals(model: FittedModel, rows: Measured) -> ChannelResiduals:
    """What a model leaves of every row in every channel: measured minus modelled.

    A table remembers what the last model left: a search ends where a fit begins.
    """
    table = linearised(rows)
    if table._left is not None and table._left[0].moves_like(model):
        return table._left[1]

    def of_part(chunks: Chunks) -> list[tuple[Indices, list[Array]]]:
        return [(at, [channel.residual(model, posture) for channel in table.channels]) for at, posture in chunks]

    left = {channel: np.empty((len(table), channel.width)) for channel in table.channels}
    for part in table.each_part(model, of_part):
        for at, of_channels in part:
            for values, residual in zip(left.values(), of_channels, strict=True):
                values[at] = residual
    table._left = model, ChannelResiduals(left)
    return table._left[1]


def point_residuals(model: FittedModel, recordings: Recordings) -> Array:
    """(N, 3) measured minus modelled tool points, base axes, mm."""
    return residuals(model, LinearisedTable(recordings, (POSITIONS,))).points_mm


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
                at = _where(inside == block)
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


def _where(inside: NDArray[np.bool_]) -> slice | Indices:
    """Where a mask holds: as a slice, if it holds in one stretch."""
    at = np.flatnonzero(inside)
    return slice(int(at[0]), int(at[-1]) + 1) if at[-1] - at[0] + 1 == len(at) else at


def current_parameters(layout: ParameterLayout, model: FittedModel) -> Array:
    """(p,) the model's values of a layout's terms (frames count as zero: they are part of the linearisation point)."""
    values = np.zeros(len(layout.terms))
    for part in (*model.background, *model.parts):
        for term, value in zip(part.placed.terms, part.values, strict=True):
            values[layout.index[term]] += value
    return values
