"""What a kind of reading must say of itself, so that nothing but its own file needs to know it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.physics.effect import Direction, Placed, Term
from armscope.physics.model import FittedModel
from armscope.physics.scene import Posture
from armscope.recordings import Recordings


class Channel(ABC):
    """One kind of reading: tool points, orientations, torques. All numbers are in SI units.

    The first channel of a diagnosis is its reference: noise, sizes and thresholds are told in its thousandths (mm), and
    every other channel is scaled by the ratio of their robust noises.
    """

    name: str
    unit: str  # of residuals and of sensitivities per unit of a direction
    width: int  # how many numbers a row holds
    floor: float  # noise below which nothing is believed: residuals that are smaller are as good as that

    @abstractmethod
    def measured(self, recordings: Recordings) -> NDArray[np.bool_]:
        """(N,) rows that hold such a reading."""

    @abstractmethod
    def residual(self, model: FittedModel, posture: Posture) -> Array:
        """(n, width) measured minus modelled at a posture's rows; NaN where not measured."""

    @abstractmethod
    def sensitivity(self, posture: Posture, direction: Direction) -> Array | None:
        """(n, width) change of the modelled reading per SI unit of a direction; None where it does not see it."""

    def nuisance(self, recordings: Recordings, tool_per_run: bool) -> list[Placed]:
        """Terms that are always free because nobody states them well enough."""
        return []

    def retract(self, model: FittedModel, steps: Mapping[Term, float]) -> FittedModel:
        """The model with the channel's own free terms moved by steps, SI units; other terms don't count."""
        return model

    def own_values(self, model: FittedModel) -> int:
        """How many values of the model only this channel sees, which take some of its noise up."""
        return 0

    def doubt(self, residual: Array) -> tuple[str, str] | None:
        """(kind, sentence) why readings can't be the arm's, by what the free terms leave (N, width); None: they can."""
        return None

    def without(self, recordings: Recordings) -> Recordings:
        """The table without such readings, so that nothing else is placed on account of them."""
        return recordings

    def tools_apart(self, model: FittedModel, target: str) -> float:
        """How far a target's tools lie apart between runs, in the channel's unit; 0 where it can't tell."""
        return 0.0


@dataclass(frozen=True, eq=False)
class ChannelResiduals:
    """What a model leaves of N rows, channel by channel."""

    # (N, width) in each channel's unit, NaN where not measured; the reference comes first
    by_channel: Mapping[Channel, Array]
    # how many values of the model only this channel sees; none where it is not named
    own_values: Mapping[Channel, int] = field(default_factory=dict)

    @property
    def points_mm(self) -> Array:
        """(N, 3) mm: measured minus modelled tool points in base axes."""
        return 1e3 * self["position"]

    def __getitem__(self, name: str) -> Array:
        """(N, width) of the channel of a name. Raises KeyError: no such channel was measured."""
        for channel, residual in self.by_channel.items():
            if channel.name == name:
                return residual
        raise KeyError(name)

    def __contains__(self, name: str) -> bool:
        return any(channel.name == name for channel in self.by_channel)


def nuisances(channels: Sequence[Channel], recordings: Recordings, tool_per_run: bool) -> list[Placed]:
    """The always-free terms of all channels.

    Args:
        channels: that are used.
        recordings: the table.
        tool_per_run: a tool of its own in every run.

    Returns:
        Terms in place, channel by channel.
    """
    return [placed for channel in channels for placed in channel.nuisance(recordings, tool_per_run)]


def retracted(channels: Sequence[Channel], model: FittedModel, steps: Mapping[Term, float]) -> FittedModel:
    """The model with the free terms of all channels moved by steps, SI units.

    Args:
        channels: that are used.
        model: from which it departs.
        steps: by free term, SI units.

    Returns:
        The model moved.
    """
    for channel in channels:
        model = channel.retract(model, steps)
    return model
