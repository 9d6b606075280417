"""The arm at the rows of a table: what drives its effects there, how it stands with them, and how it would move.

`Scene` holds what does not change (nominal frames, loads, drivers); `Posture` holds the frames with some effects in
place, and gives the columns of further ones. Loads are taken at the nominal geometry first and then, where something
gives way, once more where the arm stands with that: what is left is of third order.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from copy import copy
from dataclasses import dataclass, field

import numpy as np

from armscope.core.location import Location
from armscope.core.rotations import turned_by
from armscope.core.types import Array
from armscope.physics import drivers
from armscope.physics.effect import Part
from armscope.physics.loaded_arm import AS_STATED, LoadedArm, Misstated
from armscope.physics.terms import AXES, Direction, DrivenTogether, Driver, Term, all_driven, motor
from armscope.recordings import Recordings
from armscope.robot import Arm, Chain, chain, twist_jacobian
from armscope.robot.kinematics import joint_axes, joint_jacobian, turn_jacobian

INSTRUMENT = "instrument"
SCALE = Direction(INSTRUMENT, "scale")
HEIGHT = Direction(INSTRUMENT, "height")
FRAMES = ("base", "joint", "link", "tool")
"""Kinds of places that a twist moves; other directions are seen by instruments that do not look at the tool."""


class Scene(LoadedArm):
    """An arm at N recorded rows, what its effects follow there, and how they move it.

    Args:
        arm: the arm.
        recordings: the rows; only angles and context are used, not the measured positions.
        misstated: by how much loads are other than stated.
    """

    def __init__(self, arm: Arm, recordings: Recordings, misstated: Misstated = AS_STATED) -> None:
        super().__init__(arm, recordings, misstated)
        self._rigid: Scene | None = None

    def driver(self, driver: Driver) -> Array:
        """Values (N,) of a driver."""
        if self._rigid is not None and not drivers.follows("load", driver):
            return self._rigid.driver(driver)
        values: Array = self.remember(driver, lambda: drivers.driver_values(self, driver))
        return values

    @property
    def rigid(self) -> Scene:
        """The same rows where nothing gives way, at which what follows no load is kept."""
        return self if self._rigid is None else self._rigid

    def _bent(self, frames: Chain) -> Scene:
        """The same rows with loads taken at other frames; what does not depend on them is kept here."""
        bent = copy(self)
        bent.loaded, bent._memory, bent._rigid = frames, {}, self
        return bent

    def amounts(self, parts: Sequence[Part]) -> dict[Direction, Array]:
        """How much (N,) of every direction all parts together do, SI units."""
        amounts: dict[Direction, Array] = {}

        def add(direction: Direction, amount: Array) -> None:
            amounts[direction] = amounts[direction] + amount if direction in amounts else amount

        linear = [part for part in parts if part.placed.effect.exact is None and part.values.any()]
        for part in parts:
            if part.placed.effect.exact is not None:
                for direction, amount in part.placed.effect.exact(self, part):
                    add(direction, amount)
        for part in linear:  # part by part, as loads are kept: a link's mass is in those of all joints
            for driver in _loads(part.placed.driven):
                self.driver(driver)
        if linear:
            values = np.concatenate([part.values for part in linear])
            for group in all_driven(tuple((part.placed.driven, len(part.values)) for part in linear)):
                weights = values[group.at] * group.factors
                if weights.any():
                    add(group.direction, self._driven(group, weights.tolist()))
        return amounts

    def _driven(self, group: DrivenTogether, weights: Sequence[float]) -> Array:
        """(N,) what drivers of one direction come to."""
        total, one = np.zeros(len(self)), np.empty(len(self))
        for values, driver, weight in zip(self.rigid._at_hand(group), group.drivers, weights, strict=True):
            if weight:
                total += np.multiply(self.driver(driver) if values is None else values, weight, out=one)
        return total

    def _at_hand(self, group: DrivenTogether) -> list[Array | None]:
        """Values of each driver, which are kept anyway: looking one up takes as long as it does; None for loads."""

        def compute() -> list[Array | None]:
            return [None if drivers.follows("load", driver) else self.driver(driver) for driver in group.drivers]

        kept: list[Array | None] = self.remember(group, compute)
        return kept

    def twists(self, parts: Sequence[Part]) -> dict[str, Array]:
        """Twists (N, 6) by frame of all parts together, SI units; motor turns become turns of the chain's joints."""
        twists: dict[str, Array] = {}
        for direction, amount in self.amounts(parts).items():
            for location, axis, share in self._moved_by(direction):
                twists.setdefault(location, np.zeros((len(self), 6)))[:, axis] += share * amount
        return twists

    def _moved_by(self, direction: Direction) -> Iterator[tuple[str, int, float]]:
        """The frames that move in a direction, the axes along or about which they do, and by how much; maybe none."""
        place = Location.of(direction.location)
        if place.kind == "motor" and direction.axis == "turn":
            for joint in np.flatnonzero(self.arm.actuation[:, place.index]):
                yield f"joint {joint + 1}", AXES.index("rz"), float(self.arm.actuation[joint, place.index])
        elif place.kind in FRAMES:
            yield direction.location, AXES.index(direction.axis), 1.0

    def stretch(self, parts: Sequence[Part], along: Direction = SCALE) -> float:
        """The instrument's scale error of all parts together, of all lengths or of heights."""
        return float(
            sum(
                part.values[group.at] @ group.factors
                for part in parts
                for group in part.placed.driven
                if group.direction == along
            )
        )

    @property
    def up(self) -> Array:
        """(3,) unit vector against gravity, base axes; none where nothing falls."""
        size = float(np.linalg.norm(self.arm.gravity))
        return np.zeros(3) if size == 0 else -self.arm.gravity / size

    def misread(self, parts: Sequence[Part]) -> Array | None:
        """(N, 3) by which the tool is taken to be turned, about its own axes, rad; None: it is read as it is."""
        amounts = self.amounts([part for part in parts if part.placed.location == INSTRUMENT])
        about = [amounts.get(Direction(INSTRUMENT, axis)) for axis in AXES[3:]]
        if all(amount is None for amount in about):
            return None
        return np.stack([np.zeros(len(self)) if amount is None else amount for amount in about], axis=-1)

    def posture(self, parts: Sequence[Part] = ()) -> Posture:
        """The arm with some effects (and tool offsets, as parts) in place."""
        if not parts:
            return Posture(self, self.nominal)
        giving = [part for part in parts if _gives_way(part)]
        frames = chain(self.arm, self.recordings.motor_angles, self.twists(giving or parts))
        if not giving or np.abs(frames.tool - self.nominal.tool).max() > FARTHEST_M:
            frames = chain(self.arm, self.recordings.motor_angles, self.twists(parts)) if giving else frames
            return Posture(self, frames, self.stretch(parts), self.stretch(parts, HEIGHT), self.misread(parts))
        # what only gives way moves the arm by little: turned frames and tools, which imitate each other, stay out of it
        bent = self._bent(frames)
        frames = chain(self.arm, self.recordings.motor_angles, bent.twists(parts))
        return Posture(bent, frames, self.stretch(parts), self.stretch(parts, HEIGHT), self.misread(parts))


FARTHEST_M = 0.2
"""An arm that a fit on its way bends farther than this is loaded as if it were rigid."""


def _gives_way(part: Part) -> bool:
    """Whether a part follows a load and is there at all."""
    return bool(part.values.any()) and any(map(_follows_load, part.placed.driven))


@functools.lru_cache(maxsize=10_000)
def _follows_load(group: DrivenTogether) -> bool:
    """Whether some driver of it does."""
    return any(drivers.follows("load", driver) for driver in group.drivers)


@functools.lru_cache(maxsize=10_000)
def _loads(driven: tuple[DrivenTogether, ...]) -> tuple[Driver, ...]:
    """Those of the drivers that follow a load."""
    return tuple(driver for group in driven for driver in group.drivers if drivers.follows("load", driver))


@dataclass(eq=False)
class Posture:
    """An arm's frames at N rows with some effects in place, and the columns of further small effects there."""

    scene: Scene  # rows and drivers
    frames: Chain  # where the frames stand, base axes
    stretch: float = 0.0  # relative length error of the instrument
    heightened: float = 0.0  # relative error of its heights, beside that
    # (N, 3) by which the tool is taken to be turned, about its own axes, rad; None: it is read as it is
    misread: Array | None = None
    # moved, turned: what was computed of `displacement` and `turn`
    moved: dict[Direction, Array] = field(default_factory=dict, repr=False)
    turned: dict[Direction, Array] = field(default_factory=dict, repr=False)

    @property
    def seen_rotation(self) -> Array:
        """(N, 3, 3) orientations of the last frame as the instrument sees them, in base axes."""
        rotation = self.frames.tool_rotation
        return rotation if self.misread is None else rotation @ turned_by(self.misread)

    @property
    def tool(self) -> Array:
        """(N, 3) tool points as the instrument sees them, in base axes, m."""
        points = self.frames.tool * (1 + self.stretch)
        return points + self.heightened * self._heights if self.heightened else points

    @property
    def _heights(self) -> Array:
        """(N, 3) the part of tool points along the vertical, m."""
        up = self.scene.up
        return np.outer(self.frames.tool @ up, up)

    def displacement(self, direction: Direction) -> Array | None:
        """(N, 3) displacement of the tool point per unit of a direction, m; None where nothing moves."""
        if direction not in self.moved:
            self.moved.update(self._displacements(direction.location))
        return self.moved.get(direction)

    def turn(self, direction: Direction) -> Array | None:
        """(N, 3) turn of the tool per unit of a direction, rad; None where nothing turns."""
        if direction not in self.turned:
            self.turned.update(self._turns(direction.location))
        return self.turned.get(direction)

    def column(self, term: Term) -> Array:
        """(N, 3) displacement of the tool point per SI unit of a term, m."""
        total = np.zeros_like(self.frames.tool)
        for product in term.products:
            moved = self.displacement(product.direction)
            if moved is not None:
                total += moved * (product.factor * self.scene.driver(product.driver))[:, None]
        return total

    def _displacements(self, location: str) -> dict[Direction, Array]:
        kind = Location.of(location).kind
        if kind == INSTRUMENT:
            return {SCALE: self.frames.tool, HEIGHT: self._heights}
        if kind == "motor":
            return _by_motor(joint_jacobian(self.frames) @ self.scene.arm.actuation)
        return _by_axis(location, twist_jacobian(self.frames, location)) if kind in FRAMES else {}

    def _turns(self, location: str) -> dict[Direction, Array]:
        kind = Location.of(location).kind
        if kind == "motor":
            return _by_motor(joint_axes(self.frames) @ self.scene.arm.actuation)
        seen = "tool" if kind == INSTRUMENT else location
        return _by_axis(location, turn_jacobian(self.frames, seen)) if kind in (*FRAMES, INSTRUMENT) else {}


def _by_motor(jacobian: Array) -> dict[Direction, Array]:
    """Columns (N, 3) of a Jacobian (N, 3, m) by the motors' directions."""
    return {motor(j + 1): jacobian[:, :, j] for j in range(jacobian.shape[2])}


def _by_axis(location: str, jacobian: Array) -> dict[Direction, Array]:
    """Columns (N, 3) of a Jacobian (N, 3, 6) by the directions of a frame."""
    return {Direction(location, name): jacobian[:, :, axis] for axis, name in enumerate(AXES)}
