"""What a kind of reading must say of itself, so that nothing else needs to know it; positions and orientations."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.rotations import turned_by
from armscope.core.types import Array
from armscope.measurement.constants import WEIGHTS
from armscope.physics.effect import AXES, Direction, Part, Placed, Term
from armscope.physics.frames import ToolKey, bases_and_tools, runs_of, tool_key, tool_turns
from armscope.physics.model import Base, FittedModel
from armscope.physics.orientation_error import ORIENTATION_ERROR
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


class PositionChannel(Channel):
    """Tool points in base axes, m: base and tool are free."""

    name, unit, width, floor = "position", "m", 3, 0.0

    def measured(self, recordings: Recordings) -> NDArray[np.bool_]:
        """(N,) rows whose point was measured."""
        return np.asarray(np.isfinite(recordings.positions).all(axis=1))

    def residual(self, model: FittedModel, posture: Posture) -> Array:
        """(n, 3) measured minus modelled tool points, base axes, m."""
        table = posture.scene.recordings
        return np.asarray(model.to_base(table.positions, table.run) - posture.tool)

    def sensitivity(self, posture: Posture, direction: Direction) -> Array | None:
        """(n, 3) displacement of the tool point, m."""
        return posture.displacement(direction)

    def nuisance(self, recordings: Recordings, tool_per_run: bool) -> list[Placed]:
        """A base twist per run, and a tool translation per target (and run, where asked)."""
        return list(bases_and_tools(recordings, tool_per_run))

    def retract(self, model: FittedModel, steps: Mapping[Term, float]) -> FittedModel:
        """Bases moved by twists in their own axes, tools by offsets in the last frame."""
        twists: dict[str, Array] = {}
        for term, value in steps.items():
            product = term.products[0]
            if product.driver.kind == "in run" and product.direction.location == "base":
                for run in runs_of(product.driver):
                    twists.setdefault(run, np.zeros(6))[AXES.index(product.direction.axis)] = value
        bases = {run: moved_base(base, twists.get(run, np.zeros(6))) for run, base in model.bases.items()}
        tools = tuple(
            Part(part.placed, part.values + np.array([steps.get(term, 0.0) for term in part.placed.terms]))
            for part in model.tools
        )
        return replace(model, bases=bases, tools=tools)

    def tools_apart(self, model: FittedModel, target: str) -> float:
        """Largest distance between a target's tool points, m."""
        points = np.array([part.values for part in model.tools if part.placed.variant == target])
        return float(np.linalg.norm(points[:, None] - points, axis=2).max())


def moved_base(base: Base, twist: Array) -> Base:
    """The base after a twist (translation m, rotation rad) in its own axes."""
    turn = turned_by(twist[3:])
    return Base(base.rotation @ turn, base.translation + base.rotation @ twist[:3])


POSITIONS = PositionChannel()


NOT_THE_TOOLS_RAD = np.radians(5)
"""Median turn between modelled and measured orientations beyond which they are not the tool's; joint zeros two degrees
off leave less."""


class OrientationChannel(Channel):
    """Rotation vectors from modelled to measured orientations in base axes, rad: the tool's turn is free."""

    name, unit, width = "orientation", "rad", 3
    floor = 1e-6  # No instrument resolves less

    def measured(self, recordings: Recordings) -> NDArray[np.bool_]:
        """(N,) rows whose orientation was measured."""
        return recordings.oriented

    def residual(self, model: FittedModel, posture: Posture) -> Array:
        """(n, 3) rotation vectors from modelled to measured orientations, base axes, rad; NaN where not measured."""
        from scipy.spatial.transform import Rotation  # slow to import, and few tables hold orientations

        recordings = posture.scene.recordings
        left, known = np.full((len(recordings), 3), np.nan), recordings.oriented
        measured = Rotation.from_quat(recordings.quaternions[known], scalar_first=True).as_matrix()
        bases = model.base_turns(recordings.run[known])
        modelled = posture.seen_rotation[known] @ model.tool_turns_of(recordings)[known]
        turned = np.swapaxes(bases, 1, 2) @ measured @ np.swapaxes(modelled, 1, 2)
        left[known] = Rotation.from_matrix(turned).as_rotvec()
        return left

    def sensitivity(self, posture: Posture, direction: Direction) -> Array | None:
        """(n, 3) turn of the tool, rad."""
        return posture.turn(direction)

    def nuisance(self, recordings: Recordings, tool_per_run: bool) -> list[Placed]:
        """A turn of the tool per target (and run, where asked)."""
        return list(tool_turns(recordings, tool_per_run))

    def retract(self, model: FittedModel, steps: Mapping[Term, float]) -> FittedModel:
        """Tools turned on the last frame."""
        turns: dict[ToolKey, Array] = {}
        for term, value in steps.items():
            product = term.products[0]
            axis = AXES.index(product.direction.axis) if product.direction.axis in AXES else -1
            if product.driver.kind.startswith("on target") and product.direction.location == "tool" and axis >= 3:
                turns.setdefault(tool_key(product.driver), np.zeros(3))[axis - 3] = value
        turned = {key: turned_by(turns.get(key, np.zeros(3))) @ turn for key, turn in model.tool_turns.items()}
        return replace(model, tool_turns=turned)

    def own_values(self, model: FittedModel) -> int:
        """The values by which orientations err with their attitude."""
        parts = (part for part in model.everything if part.placed.effect is ORIENTATION_ERROR)
        return sum(int(np.count_nonzero(part.values)) for part in parts)

    def doubt(self, residual: Array) -> tuple[str, str] | None:
        """Too few of them, or so far from the arm's that they are another frame's."""
        size = np.linalg.norm(residual[np.isfinite(residual).all(axis=1)], axis=1)
        if len(size) < WEIGHTS.fewest_orientations:
            return "few orientations", f"Only {len(size)} rows hold an orientation: positions alone were used."
        if np.median(size) > NOT_THE_TOOLS_RAD:
            return "orientations not the arm's", (
                f"The measured orientations lie {np.degrees(np.median(size)):.3g} degrees (median) from the arm's, "
                "however the tool is turned: positions alone were used. `armscope check` tries other orders."
            )
        return None

    def without(self, recordings: Recordings) -> Recordings:
        """The table without orientations."""
        return replace(recordings, orientation=None)

    def tools_apart(self, model: FittedModel, target: str) -> float:
        """Largest angle between a target's tool and its tool in the first run, rad."""
        from scipy.spatial.transform import Rotation  # slow to import, and few tables hold orientations

        turns = [turn for (of, _), turn in model.tool_turns.items() if of == target]
        rotations = Rotation.from_matrix(turns or [np.eye(3)])
        return float((rotations[0].inv() * rotations).magnitude().max())


ORIENTATIONS = OrientationChannel()


CHANNELS: tuple[Channel, ...] = (POSITIONS, ORIENTATIONS)  # The first is the reference: it is always measured


def supported(recordings: Recordings, channels: Sequence[Channel] = CHANNELS) -> tuple[Channel, ...]:
    """Those of some channels that a table holds readings of."""
    return tuple(c for n, c in enumerate(channels) if n == 0 or c.measured(recordings).any())
