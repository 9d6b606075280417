"""How much each row counts: per channel a weight, and a whitening where rows scatter along known directions."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.measurement import robust
from armscope.measurement.channel import POSITIONS, Channel, ChannelResiduals
from armscope.measurement.constants import WEIGHTS
from armscope.measurement.whitening import Whitener


@dataclass(frozen=True, eq=False)
class RowNoise:
    """What is known of N rows' noise beside its size."""

    uncertainty: Array  # (N,) of the reference channel, relative to the usual row's
    independence_weight: Array  # (N,) of an independent row that each stands for: a pose visited again is no new pose

    @property
    def nominal_weight(self) -> Array:
        """(N,) weights of rows that are no bad shots."""
        return np.asarray(self.independence_weight / self.uncertainty**2)

    def weights(self, left: ChannelResiduals, least: float, whitening: Array | None = None) -> RowWeights:
        """Weights against what a fitted model leaves, the reference channel whitened.

        Args:
            left: residuals of the model by channel.
            least: mm, below which the reference channel's noise is not taken to be.
            whitening: (N, width, width) of the reference channel.

        Returns:
            Weights of positions and of turns.
        """
        return self._weights(robust.quartic_weights, left, least, whitening)

    def first_weights(self, left: ChannelResiduals, least: float) -> RowWeights:
        """Weights while structure may still be in the residuals."""
        return self._weights(robust.huber_weights, left, least, None)

    def _weights(self, rule: robust.Rule, left: ChannelResiduals, least: float, whitening: Array | None) -> RowWeights:
        (reference, residual), *others = left.by_channel.items()
        white = whitened(1e3 * residual, whitening)
        weight = rule(white, self.uncertainty, least) * self.independence_weight
        of_channels = [ChannelWeights(reference, weight, self.nominal_weight, whitening)]
        for channel, residual in others:
            noise = robust.scale_of(white / self.uncertainty[:, None], least)
            of_channels.append(self._beside(channel, residual, rule, noise, left.own_values.get(channel, 0)))
        return RowWeights(tuple(of_channels), self.independence_weight)

    def _beside(
        self, channel: Channel, residual: Array, rule: robust.Rule, noise: float, own_values: int
    ) -> ChannelWeights:
        """Weights of another channel beside the reference, whose noise (mm) it is scaled to."""
        known = np.isfinite(residual).all(axis=1)
        nominal = np.where(known, self.independence_weight, 0.0)
        weight = nominal.copy()
        weight[known] *= rule(residual[known], np.ones(int(known.sum())), channel.floor)
        left = max(1 - own_values / max(1, residual[known].size), WEIGHTS.least_freedom)
        scale = 1e-3 * noise * np.sqrt(left) / robust.scale_of(residual[known], channel.floor)
        return ChannelWeights(channel, weight, nominal, scale=scale)


@dataclass(frozen=True, eq=False)
class ChannelWeights:
    """Weights of one channel's N rows."""

    channel: Channel
    weight: Array  # (N,), 0 where not measured
    nominal_weight: Array | None = None  # (N,) the weights if no row were a bad shot; None: ones
    whitening: Array | None = None  # (N, width, width) of each row, or None
    scale: float = 1.0  # m per unit of the channel, by which it counts beside the reference: the ratio of their noises

    @property
    def robust_weight(self) -> Array:
        """(N,) 1 for rows that look like the others, less for bad shots."""
        return self.weight if self.nominal_weight is None else np.asarray(self.weight / self.nominal_weight)

    @property
    def counts(self) -> Array:
        """(N,) whether each row's reading does not look like a bad shot."""
        nominal = 1.0 if self.nominal_weight is None else self.nominal_weight
        return np.asarray(self.weight > WEIGHTS.inlier_weight * nominal)

    def factor(self, rows: Indices) -> Array:
        """(n,) or (n, width, width) what readings of ``rows`` are multiplied by."""
        root = self.scale * np.sqrt(self.weight[rows])
        return root if self.whitening is None else np.asarray(root[:, None, None] * self.whitening[rows])

    def trusting(self, which: NDArray[np.bool_]) -> ChannelWeights:
        """The weights with some rows' (N,) as if they were no bad shots."""
        nominal = np.ones(len(self.weight)) if self.nominal_weight is None else self.nominal_weight
        return replace(self, weight=np.where(which, nominal, self.weight))

    def without(self, which: NDArray[np.bool_]) -> ChannelWeights:
        """The weights with some rows (N,) left out."""
        return replace(self, weight=np.where(which, 0.0, self.weight))

    def take(self, rows: Indices, share: float) -> ChannelWeights:
        """The weights of some rows, each standing for 1 / ``share`` rows."""
        nominal = None if self.nominal_weight is None else self.nominal_weight[rows] / share
        whitening = None if self.whitening is None else self.whitening[rows]
        return replace(self, weight=self.weight[rows] / share, nominal_weight=nominal, whitening=whitening)


@dataclass(frozen=True, eq=False)
class RowWeights:
    """Weights of N rows."""

    of_channels: tuple[ChannelWeights, ...]  # per channel; the reference first
    independence_weight: Array | None = None  # (N,) of an independent row that each row stands for; None: ones

    @classmethod
    def of_positions(cls, weight: Array) -> RowWeights:
        """Weights (N,) of positions that are all there is."""
        return cls((ChannelWeights(POSITIONS, weight),))

    @property
    def reference(self) -> ChannelWeights:
        """The weights of the reference channel."""
        return self.of_channels[0]

    @property
    def channels(self) -> tuple[Channel, ...]:
        """What was measured."""
        return tuple(each.channel for each in self.of_channels)

    @property
    def robust_weight(self) -> Array:
        """(N,) 1 for rows whose reference reading looks like the others', less for bad shots."""
        return self.reference.robust_weight

    @property
    def whitening(self) -> Array | None:
        """(N, width, width) of the reference channel."""
        return self.reference.whitening

    def numbers(self, rows: Indices) -> Array:
        """(n,) how many independent numbers each of ``rows`` holds."""
        share = np.ones(len(rows)) if self.independence_weight is None else self.independence_weight[rows]
        held = sum(each.channel.width * np.where(each.counts[rows], share, 0.0) for each in self.of_channels)
        return np.asarray(held)

    def whitener(self, rows: Indices) -> Whitener:
        """W^1/2 of ``rows``."""
        return Whitener(tuple((each.channel, each.factor(rows)) for each in self.of_channels))

    @property
    def of_reference(self) -> RowWeights:
        """The weights of the reference channel alone."""
        return replace(self, of_channels=self.of_channels[:1])

    @property
    def unwhitened(self) -> RowWeights:
        """The same weights of readings as they were measured."""
        return replace(self, of_channels=tuple(replace(each, whitening=None) for each in self.of_channels))

    @property
    def is_plain(self) -> bool:
        """Whether nothing but the reference channel counts, as it was measured."""
        return len(self.of_channels) == 1 and self.whitening is None

    def trusting(self, which: NDArray[np.bool_]) -> RowWeights:
        """The weights with some rows' (N,) as if they were no bad shots."""
        return replace(self, of_channels=tuple(each.trusting(which) for each in self.of_channels))

    def without(self, which: NDArray[np.bool_]) -> RowWeights:
        """The weights with some rows (N,) left out."""
        return replace(self, of_channels=tuple(weights.without(which) for weights in self.of_channels))

    def take(self, rows: Indices, share: float = 1.0) -> RowWeights:
        """The weights of some rows, each standing for 1 / ``share`` rows."""
        independent = None if self.independence_weight is None else self.independence_weight[rows]
        return RowWeights(tuple(each.take(rows, share) for each in self.of_channels), independent)


def whitened(residuals: Array, whitening: Array | None) -> Array:
    """Residuals (N, width) without the known scatter."""
    if whitening is None:
        return residuals
    return np.asarray((whitening @ residuals[:, :, None])[:, :, 0])
