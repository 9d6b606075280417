"""A table's rows with what is computed on them chunk by chunk, and what a model leaves of them.

Lengths are mm here: residuals are measured minus modelled tool points, base axes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from armscope.core.parallel import each_piece, shared_array
from armscope.core.types import Array, Indices
from armscope.fitting.constants import STEPS
from armscope.measurement.channel import POSITIONS, Channel, ChannelResiduals, supported
from armscope.physics.model import FittedModel
from armscope.physics.scene import Posture, Scene
from armscope.recordings import Recordings

Result = TypeVar("Result")
Chunks = Iterator[tuple[Indices, Posture]]
"""(rows, posture), chunk by chunk."""


@dataclass(eq=False)
class LinearisedTable:
    """A table's rows with what is computed on them, chunk by chunk, for a model that they are linearised about."""

    recordings: Recordings  # the rows
    channels: tuple[Channel, ...] = ()  # what was measured there; the reference comes first
    # (N,) of the rows in which chunks take them, rows of one block side by side. Where it is given, what drives the
    # effects is computed once, unless the table is long, and so is how the last model stands
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

    def in_order(self, order: Indices) -> LinearisedTable:
        """The same rows taken in an order (N,); of a long table it stays known what the last model left."""
        left = self._left if len(self) > STEPS.kept_rows else None  # in another order it is rounded otherwise
        return LinearisedTable(self.recordings, self.channels, order, _left=left)

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

    left = {channel: shared_array((len(table), channel.width)) for channel in table.channels}

    def of_part(chunks: Chunks) -> None:
        for at, posture in chunks:
            for channel, values in left.items():
                values[at] = channel.residual(model, posture)

    table.each_part(model, of_part)
    table._left = model, ChannelResiduals(left, {channel: channel.own_values(model) for channel in left})
    return table._left[1]


def point_residuals(model: FittedModel, recordings: Recordings) -> Array:
    """(N, 3) measured minus modelled tool points, base axes, mm."""
    return residuals(model, LinearisedTable(recordings, (POSITIONS,))).points_mm
