"""Readings of all channels side by side, so that each number counts as much as it is worth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.types import Array
from armscope.measurement.channel import Channel
from armscope.physics.effect import Direction, Product, Term
from armscope.physics.model import FittedModel
from armscope.physics.scene import Posture, Scene


@dataclass(frozen=True, eq=False)
class Whitener:
    """W^1/2 of n rows, channel by channel."""

    # per channel what its numbers are multiplied by: (n,), or (n, width, width) where they hang together; with the root
    # of a row's weight and the channel's scale (m per unit)
    factors: tuple[tuple[Channel, Array], ...]

    @classmethod
    def plain(cls, channels: Sequence[Channel], rows: int) -> Whitener:
        """Every reading as it is."""
        return cls(tuple((channel, np.ones(rows)) for channel in channels))

    @property
    def width(self) -> int:
        """How many numbers a row has in all channels."""
        return sum(channel.width for channel, _ in self.factors)

    def side_by_side(self, readings: Sequence[Array | None]) -> Array:
        """(n, width) whitened readings (n, width of each channel); None counts as zeros."""
        # one component of all rows side by side: products with drivers run along the rows
        out = np.empty((len(self.factors[0][1]), self.width), order="F")
        end = 0
        for (channel, factor), reading in zip(self.factors, readings, strict=True):
            at = out[:, end : end + channel.width]
            end += channel.width
            if reading is None:
                at[:] = 0.0
            elif factor.ndim == 1:
                np.multiply(factor[:, None], reading, out=at)
            else:
                at[:] = np.einsum("nij,nj->ni", factor, reading)
        return out

    def response(self, model: FittedModel, posture: Posture) -> Array:
        """(n, width) what a model leaves of a posture's rows: W^1/2 y, mm."""
        left = (1e3 * np.nan_to_num(channel.residual(model, posture)) for channel, _ in self.factors)
        return self.side_by_side(list(left))


class WhitenedPosture:
    """A posture as all channels see it.

    Args:
        posture: an arm's frames at n rows.
        whitener: of the same rows.
    """

    def __init__(self, posture: Posture, whitener: Whitener) -> None:
        self.posture = replace(posture, moved={}, turned={})  # what is computed here goes with this object
        self.whitener = whitener
        self._seen: dict[Direction, Array] = {}

    @classmethod
    def plain(cls, posture: Posture, channels: Sequence[Channel]) -> WhitenedPosture:
        """Readings of some channels as they are."""
        return cls(posture, Whitener.plain(channels, len(posture.scene)))

    @property
    def scene(self) -> Scene:
        """The rows and their drivers."""
        return self.posture.scene

    @property
    def width(self) -> int:
        """How many numbers a row has."""
        return self.whitener.width

    def sensitivity(self, direction: Direction) -> Array:
        """(n, width) whitened change of all readings per SI unit of a direction, m."""
        if direction not in self._seen:
            seen = [channel.sensitivity(self.posture, direction) for channel, _ in self.whitener.factors]
            self._seen[direction] = self.whitener.side_by_side(seen)
        return self._seen[direction]

    def column(self, term: Term) -> Array:
        """(n, width) whitened change of all readings per SI unit of a term, m."""
        first, *others = term.products
        total = self._product(first)
        for product in others:
            total = total + self._product(product)
        return total

    def fill(self, out: Array, term: Term) -> None:
        """Write `column` into ``out`` (width, n), lying."""
        for number, (direction, (first, *others)) in enumerate(term.by_direction):
            amount = first.factor * self.scene.driver(first.driver)
            for product in others:
                amount += product.factor * self.scene.driver(product.driver)
            if number == 0:
                np.multiply(self.sensitivity(direction).T, amount, out=out)
            else:
                out += self.sensitivity(direction).T * amount

    def _product(self, product: Product) -> Array:
        amount = product.factor * self.scene.driver(product.driver)
        return np.asarray(self.sensitivity(product.direction) * amount[:, None])
