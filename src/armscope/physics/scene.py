"""The arm at the rows of a table: what drives its effects there, how it stands with them, and how it would move.

`Scene` holds what does not change (nominal frames, loads, drivers); `Posture` holds the frames with some effects in
place, and gives the columns of further ones. Loads are taken at the nominal geometry first and then, where something
gives way, once more where the arm stands with that: what is left is of third order.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from copy import copy
from dataclasses import dataclass

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.physics import drivers
from armscope.physics.effect import AXES, Direction, Driver, Placed
from armscope.physics.loaded_arm import AS_STATED, LoadedArm, Misstated
from armscope.physics.posture import FRAMES, Posture
from armscope.recordings import Recordings
from armscope.robot import Arm, Chain, chain
from armscope.robot.parallelogram import Linkage

LINKAGE_JOINT = 3
"""The chain joint that a parallelogram drives."""


@dataclass(frozen=True, eq=False)
class Part:
    """A placed effect with the values of its terms, SI units."""

    placed: Placed
    values: Array


class Scene(LoadedArm):
    """An arm at N recorded rows, what its effects follow there, and how they move it.

    Args:
        arm: the arm.
        recordings: the rows; only angles and context are used, not the measured positions.
        misstated: by how much loads are other than stated.

    Attributes:
        chain_angles: (N, n) angles of the chain's joints, rad.
    """

    def __init__(self, arm: Arm, recordings: Recordings, misstated: Misstated = AS_STATED) -> None:
        super().__init__(arm, recordings, misstated)
        self.chain_angles: Array = recordings.motor_angles @ arm.actuation.T
        self._rigid: Scene | None = None

    def driver(self, driver: Driver) -> Array:
        """Values (N,) of a driver."""
        if self._rigid is not None and not drivers.follows("load", driver):
            return self._rigid.driver(driver)
        values: Array = self.remember(driver, lambda: drivers.driver_values(self, driver))
        return values

    def _bent(self, frames: Chain) -> Scene:
        """The same rows with loads taken at other frames; what does not depend on them is kept here."""
        bent = copy(self)
        bent.loaded, bent._memory, bent._rigid = frames, {}, self
        return bent

    @property
    def linkage(self) -> Linkage:
        """The nominal parallelogram."""
        assert self.arm.description.parallelogram is not None
        return Linkage.from_description(self.arm.description.parallelogram)

    @property
    def elbow_angle(self) -> Array:
        """(N,) D-H angle of the joint that the parallelogram drives, rad."""
        rows = self.arm.description.dh
        offset = 0.0 if rows is None else np.radians(rows.joints[LINKAGE_JOINT - 1].theta_offset_deg)
        return self.chain_angles[:, LINKAGE_JOINT - 1] + offset

    def amounts(self, parts: Sequence[Part]) -> dict[Direction, Array]:
        """How much (N,) of every direction all parts together do, SI units."""
        amounts: dict[Direction, Array] = {}

        def add(direction: Direction, amount: Array) -> None:
            amounts[direction] = amounts[direction] + amount if direction in amounts else amount

        for part in parts:
            if part.placed.effect.exact is not None:
                for direction, amount in part.placed.effect.exact(self, part):
                    add(direction, amount)
                continue
            for value, term in zip(part.values, part.placed.terms, strict=True):
                for product in term.products if value else ():
                    add(product.direction, value * product.factor * self.driver(product.driver))
        return amounts

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

    def stretch(self, parts: Sequence[Part]) -> float:
        """The instrument's scale error of all parts together."""
        return float(
            sum(
                value * product.factor
                for part in parts
                for value, term in zip(part.values, part.placed.terms, strict=True)
                for product in term.products
                if product.direction.location == "instrument"
            )
        )

    def posture(self, parts: Sequence[Part] = ()) -> Posture:
        """The arm with some effects (and tool offsets, as parts) in place."""
        if not parts:
            return Posture(self, self.nominal)
        giving = [part for part in parts if _gives_way(part)]
        frames = chain(self.arm, self.recordings.motor_angles, self.twists(giving or parts))
        if not giving or np.abs(frames.tool - self.nominal.tool).max() > FARTHEST_M:
            frames = chain(self.arm, self.recordings.motor_angles, self.twists(parts)) if giving else frames
            return Posture(self, frames, self.stretch(parts))
        # what only gives way moves the arm by little: turned frames and tools, which imitate each other, stay out of it
        bent = self._bent(frames)
        frames = chain(self.arm, self.recordings.motor_angles, bent.twists(parts))
        return Posture(bent, frames, self.stretch(parts))


FARTHEST_M = 0.2
"""An arm that a fit on its way bends farther than this is loaded as if it were rigid."""


def _gives_way(part: Part) -> bool:
    """Whether a part follows a load and is there at all."""
    return bool(np.any(part.values)) and any(
        drivers.follows("load", product.driver) for term in part.placed.terms for product in term.products
    )
