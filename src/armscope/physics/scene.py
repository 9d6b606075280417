"""The arm at the rows of a table: what drives its effects there, how it stands with them, and how it would move.

`Scene` holds what does not change (nominal frames, loads, drivers); `Posture` holds the frames with some effects in
place, and gives the columns of further ones. Loads are taken at the nominal geometry first and then, where something
gives way, once more where the arm stands with that: what is left is of third order.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.physics import drivers
from armscope.physics.effect import AXES, Direction, Driver, Placed
from armscope.physics.posture import FRAMES, Posture
from armscope.recordings import Recordings
from armscope.robot import Arm, Chain, chain
from armscope.robot.gravity import gravity_wrenches
from armscope.robot.parallelogram import Linkage

LINKAGE_JOINT = 3
"""The chain joint that a parallelogram drives."""


@dataclass(frozen=True, eq=False)
class Misstated:
    """By how much loads are other than stated.

    Attributes:
        payload_kg: added to the payload at the tool point, in all rows.
        payload_share: of the stated payload, added to it.
        payload_offset: (3,) m, the payload's centre off the tool point, in the last frame's axes.
        masses: (n,) of each link's stated mass, added to it.
    """

    payload_kg: float = 0.0
    payload_share: float = 0.0
    payload_offset: Array | None = None
    masses: Array | None = None


AS_STATED = Misstated()


@dataclass(frozen=True, eq=False)
class Part:
    """A placed effect with the values of its terms, SI units."""

    placed: Placed
    values: Array


class Scene:
    """An arm at N recorded rows.

    Args:
        arm: the arm.
        recordings: the rows; only angles and context are used, not the measured positions.
        misstated: by how much loads are other than stated.

    Attributes:
        nominal: frames without any effect.
        loaded: frames at which loads are taken.
    """

    def __init__(self, arm: Arm, recordings: Recordings, misstated: Misstated = AS_STATED) -> None:
        self.arm, self.recordings, self.misstated = arm, recordings, misstated
        self.nominal: Chain = chain(arm, recordings.motor_angles)
        self.loaded: Chain = self.nominal
        self.chain_angles: Array = recordings.motor_angles @ arm.actuation.T
        self._memory: dict[Any, Any] = {}
        self._rigid: Scene | None = None

    def __len__(self) -> int:
        return len(self.recordings)

    def remember(self, key: Any, compute: Callable[[], Any]) -> Any:
        """The value of ``compute()``, computed once."""
        try:
            return self._memory[key]
        except KeyError:
            return self._memory.setdefault(key, compute())

    def driver(self, driver: Driver) -> Array:
        """Values (N,) of a driver."""
        if self._rigid is not None and not drivers.follows("load", driver):
            return self._rigid.driver(driver)
        values: Array = self.remember(driver, lambda: drivers.evaluate(self, driver))
        return values

    def loaded_as(self, misstated: Misstated) -> Scene:
        """The same rows with loads other than stated, taken at the same frames."""
        other = copy(self)
        other.misstated, other._memory = misstated, {}
        return other

    def with_heavier_link(self, link: int, share: float) -> Scene:
        """The same rows with the mass of link ``link`` (from 1) larger by a share of it."""
        stated = np.zeros(self.arm.n_joints) if self.misstated.masses is None else self.misstated.masses
        masses = stated + share * np.eye(self.arm.n_joints)[link - 1]
        # loads ask link by link: only the last one's are kept
        known: tuple[int, float, Scene] | None = self._memory.get("heavier link")
        if known is None or known[:2] != (link, share):
            known = (link, share, self.loaded_as(replace(self.misstated, masses=masses)))
            self._memory["heavier link"] = known
        return known[2]

    def _bent(self, frames: Chain) -> Scene:
        """The same rows with loads taken at other frames; what does not depend on them is kept here."""
        bent = copy(self)
        bent.loaded, bent._memory, bent._rigid = frames, {}, self
        return bent

    @property
    def payload(self) -> Array:
        """(N,) kg at the tool point: stated, plus the error under study."""
        stated, wrong = self.recordings.payload, self.misstated
        known = np.zeros(len(self)) if stated is None else np.nan_to_num(stated)
        return wrong.payload_kg + (1 + wrong.payload_share) * known

    @property
    def wrenches(self) -> tuple[Array, Array]:
        """Force and moment (N, n, 3) of gravity at each joint, base axes."""

        def compute() -> tuple[Array, Array]:
            heavier, offset = self.misstated.masses, self.misstated.payload_offset
            masses = None if heavier is None else (1 + heavier) * self.arm.masses
            force, moment = gravity_wrenches(self.arm, self.loaded, self.payload, masses)
            if offset is None:
                return force, moment
            off = self.loaded.tool_rotation @ offset
            return force, moment + np.cross(off, self.payload[:, None] * self.arm.gravity)[:, None, :]

        wrenches: tuple[Array, Array] = self.remember("wrenches", compute)
        return wrenches

    @property
    def gravity_torques(self) -> Array:
        """(N, m) torque of gravity on the motors by the stated masses and payload, N m."""

        def compute() -> Array:
            _, moment = self.wrenches
            axes = self.loaded.joint_rotation[..., 2]
            return np.asarray(np.einsum("nji,nji->nj", axes, moment) @ self.arm.actuation)

        torques: Array = self.remember("gravity torques", compute)
        return torques

    @property
    def torques(self) -> Array:
        """(N, m) load torque on the motors, N m: recorded where recorded, else of gravity."""
        recorded = self.recordings.torque
        if recorded is None:
            return self.gravity_torques
        return np.where(np.isnan(recorded), self.gravity_torques, recorded)

    def moment(self, location: str) -> Array:
        """(N, 3) gravity's moment about a frame's origin in the frame's axes, N m."""

        def compute() -> Array:
            force, moment = self.wrenches
            if location == "base":
                return moment[:, 0] + np.cross(self.loaded.joint_origin[:, 0], force[:, 0])
            j = Location.of(location).index
            return np.asarray(np.einsum("nba,nb->na", self.loaded.joint_rotation[:, j], moment[:, j]))

        values: Array = self.remember(("moment", location), compute)
        return values

    def force(self, location: str) -> Array:
        """(N, 3) weight of everything beyond a frame, in the frame's axes, N."""

        def compute() -> Array:
            force, _ = self.wrenches
            if location == "base":
                return force[:, 0]
            j = Location.of(location).index
            return np.asarray(np.einsum("nba,nb->na", self.loaded.joint_rotation[:, j], force[:, j]))

        values: Array = self.remember(("force", location), compute)
        return values

    def beam_site(self, link: int) -> str:
        """Where the end of row ``link``'s beam stands: D-H frame j; for modified rows, before joint j turns."""
        return f"joint {link}" if self.arm.is_modified_dh else f"link {link}"

    def beam(self, link: int) -> Array:
        """(3,) the step along row ``link``, in the axes of `beam_site`, m."""
        step = self.arm.before[link - 1] if self.arm.is_modified_dh else self.arm.behind[link - 1]
        along: Array = step[:3, :3].T @ step[:3, 3]
        return along

    def bending(self, link: int) -> Array:
        """(N, 6) twist of the end of row ``link`` per unit 1/(E I), in the axes of `beam_site`.

        Euler-Bernoulli cantilever of length L along e under the end force F and moment M of everything beyond:
        turns L (M + L/2 e x F), moves L^2/2 M x e + L^3/3 F, parts along e left out.
        """

        def compute() -> Array:
            step = self.beam(link)
            length = float(np.linalg.norm(step))
            e = step / length
            rotation, origin = self.loaded.frame(self.beam_site(link))
            force, moment = self.wrenches
            lever = self.loaded.joint_origin[:, link - 1] - origin
            at_end = moment[:, link - 1] + np.cross(lever, force[:, link - 1])
            f = np.einsum("nba,nb->na", rotation, force[:, link - 1])
            m = np.einsum("nba,nb->na", rotation, at_end)
            f, m = f - np.outer(f @ e, e), m - np.outer(m @ e, e)
            turn = length * (m + length / 2 * np.cross(e, f))
            move = length**2 / 2 * np.cross(m, e) + length**3 / 3 * f
            return np.concatenate([move, turn], axis=1)

        twist: Array = self.remember(("bending", link), compute)
        return twist

    @property
    def row_numbers(self) -> Array:
        """(N,) the table's id as a number where all ids are, else the row's number from 1."""
        numbers: Array = self.remember("row numbers", lambda: numbers_of_rows(self.recordings))
        return numbers

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
        angle: Array = self.chain_angles[:, LINKAGE_JOINT - 1] + offset
        return angle

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


def numbers_of_rows(recordings: Recordings) -> Array:
    """(N,) the table's id as a number where all ids are, else the row's number from 1."""
    try:
        return recordings.id.astype(float)
    except ValueError:
        return np.arange(1.0, len(recordings) + 1)
