"""The fitted model: an arm, its frames, its effects; it predicts exactly (`model_file` keeps it as model.yaml)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.inputs import InputError
from armscope.core.parallel import each_piece
from armscope.core.types import Array
from armscope.physics.drivers import follows
from armscope.physics.effect import Part, Placed
from armscope.physics.frames import ToolKey
from armscope.physics.loose_target import LOOSE_TARGET
from armscope.physics.scene import Posture, Scene
from armscope.physics.set_ups import SetUps
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.robot.constants import SEARCH

FARTHEST_IN_REACHES, FARTHEST_TOOL_M = 3.0, 1.0
"""An arm's tool is never as far from the base: what puts it there is no model of it."""


@dataclass(frozen=True, eq=False)
class Base:
    """Measurement frame from base frame: measured = rotation @ tool + translation (m)."""

    rotation: Array
    translation: Array


@dataclass(frozen=True)
class AsStated:
    """A tool point along axes ("tool z") that rows did not tell from the base along its own ("base z")."""

    tool: str
    base: str

    def text(self) -> str:
        """In words, as a calibration tells what it held."""
        return f"{self.tool}: as {self.base}; kept as stated"


@dataclass(frozen=True, eq=False)
class FittedModel:
    """An arm with everything that was found about it."""

    arm: Arm  # the nominal arm
    bases: Mapping[str, Base]  # where the base stands, by run, the last one last
    tools: tuple[Part, ...] = ()  # tool offsets as parts
    parts: tuple[Part, ...] = ()  # the effects, SI units
    # the small errors of each family that are allowed for everywhere without a name, as parts
    background: tuple[Part, ...] = ()
    # (3, 3) the arm's last frame from the measured tool frame, by tool, where orientations were measured
    tool_turns: Mapping[ToolKey, Array] = field(default_factory=dict)
    undetermined: tuple[AsStated, ...] = ()  # tool points that are as stated, since rows do not tell them from the base

    def moves_like(self, other: FittedModel) -> bool:
        """Whether another model surely predicts the same: its frames are these, and its effects but for zeros."""
        same = self.arm is other.arm and self.bases is other.bases and self.tool_turns is other.tool_turns
        return same and self._moving() == other._moving()

    def _moving(self) -> list[tuple[Placed, bytes]]:
        """All that moves anything, and by how much."""
        return [(part.placed, part.values.tobytes()) for part in self.everything if part.values.any()]

    def scene(self, recordings: Recordings) -> Scene:
        """The arm at the rows of a table."""
        return Scene(self.arm, recordings)

    @property
    def set_ups(self) -> SetUps:
        """The runs that stand on one base, for each base."""
        runs: dict[bytes, list[str]] = {}
        for run, base in self.bases.items():
            runs.setdefault(base.rotation.tobytes() + base.translation.tobytes(), []).append(run)
        return tuple(map(tuple, runs.values()))

    @property
    def everything(self) -> tuple[Part, ...]:
        """All that moves the arm or its readings: tools, background and effects."""
        return (*self.tools, *self.background, *self.parts)

    def in_its_own_base(self) -> FittedModel:
        """Without what moves base or target: where they or the instrument stood does not move the arm in its base."""
        own = (tuple(p for p in some if not moves_the_set_up(p.placed)) for some in (self.parts, self.background))
        parts, background = own
        return replace(self, parts=parts, background=background)

    def posture(self, scene: Scene) -> Posture:
        """The arm at a scene's rows with all effects in place."""
        return scene.posture(self.everything)

    def base_of(self, run: str) -> Base:
        """The base of a run; of the last known one for a run that the model does not know."""
        if not self.bases:
            raise InputError(
                "model", "bases", "no base frame", "a model knows where the base stands in one run at least"
            )
        return self.bases.get(run) or self.bases[list(self.bases)[-1]]

    def to_measurement(self, points: Array, runs: NDArray[np.str_]) -> Array:
        """Points (N, 3) in base axes to the measurement frame, m."""
        measured = np.empty_like(points)
        for run in np.unique(runs):
            rows = runs == run
            base = self.base_of(str(run))
            measured[rows] = points[rows] @ base.rotation.T + base.translation
        return measured

    def to_base(self, measured: Array, runs: NDArray[np.str_]) -> Array:
        """Measured points (N, 3) to base axes, m."""
        points = np.empty_like(measured)
        for run in np.unique(runs):
            rows = runs == run
            base = self.base_of(str(run))
            points[rows] = (measured[rows] - base.translation) @ base.rotation
        return points

    def base_turns(self, runs: NDArray[np.str_]) -> Array:
        """(N, 3, 3) measurement frame from base frame."""
        names, which = np.unique(runs, return_inverse=True)
        return np.array([self.base_of(str(run)).rotation for run in names])[which] if len(runs) else np.empty((0, 3, 3))

    def tool_turns_of(self, recordings: Recordings) -> Array:
        """(N, 3, 3) last frame from measured tool frame; unturned where the model knows none."""
        tools = np.stack([recordings.target, recordings.run], axis=1)
        keys, which = np.unique(tools, axis=0, return_inverse=True)
        turns = [self.tool_turns.get((str(t), None), self.tool_turns.get((str(t), str(r)), np.eye(3))) for t, r in keys]
        return np.array(turns)[which.reshape(-1)]

    def in_known_runs(self, recordings: Recordings) -> Recordings:
        """The table with rows of a run that the model does not know counted as of the last one that it knows."""
        known = np.isin(recordings.run, list(self.bases))
        if known.all() or not self.bases:
            return recordings
        return replace(recordings, run=np.where(known, recordings.run, list(self.bases)[-1]))

    def unknown_runs(self, recordings: Recordings) -> list[str]:
        """Runs of a table whose base the model does not know."""
        return sorted(set(np.unique(recordings.run).tolist()) - set(self.bases))


def moves_the_set_up(placed: Placed) -> bool:
    """Whether an effect moves base or instrument as a whole, in time, with the temperature or from run to run.

    So does a target that is loose on the tool: no command of the arm is wrong by it. A base that gives way to a load is
    the arm's: it does so under every command.
    """
    if placed.effect is LOOSE_TARGET:
        return True
    products = [product for term in placed.terms for product in term.products]
    of_base = placed.location == "base" and all(product.direction.location == "base" for product in products)
    return of_base and all(follows("run", product.driver) for product in products)


def predict(model: FittedModel, recordings: Recordings) -> Array:
    """Tool points (N, 3) in the measurement frame, m, exact; a run that the model does not know stands as the last one.

    Raises:
        InputError: the table lacks a context column that an effect of the model follows, or the model puts the tool
            where no arm of this size can.
    """
    recordings = model.in_known_runs(recordings)
    tool = np.concatenate(each_piece(_pieces(recordings), lambda at: _posture(model, recordings, at).tool))
    distance = np.linalg.norm(tool, axis=1)
    near = distance <= FARTHEST_IN_REACHES * model.arm.reach + FARTHEST_TOOL_M
    if not near.all():
        row = int(np.argmin(near))
        found, reach = f"a tool point {distance[row]:.3g} m from the base", f"{model.arm.reach:.3g} m"
        rule = f"{model.arm.name} reaches {reach} at most"
        raise InputError(recordings.source, f"line {row + 2}", found, rule, "Is the model's file as it was written?")
    return model.to_measurement(tool, recordings.run)


def _pieces(recordings: Recordings) -> list[slice]:
    """All rows, some at a time: all that drives effects there takes some kilobytes a row."""
    return [slice(start, start + SEARCH.rows_at_a_time) for start in range(0, len(recordings), SEARCH.rows_at_a_time)]


def _posture(model: FittedModel, recordings: Recordings, at: slice) -> Posture:
    return model.posture(model.scene(recordings.rows(at)))


def predict_orientation(model: FittedModel, recordings: Recordings) -> Array:
    """Orientations (N, 3, 3) of the arm's last frame in the measurement frame, with all effects in place.

    A tool frame that is turned against the last frame is not part of the model: positions do not show it.
    """
    recordings = model.in_known_runs(recordings)
    pieces = _pieces(recordings)
    rotations = np.concatenate(each_piece(pieces, lambda at: _posture(model, recordings, at).frames.tool_rotation))
    turned = np.empty_like(rotations)
    for run in np.unique(recordings.run):
        rows = recordings.run == run
        turned[rows] = model.base_of(str(run)).rotation @ rotations[rows]
    return turned
