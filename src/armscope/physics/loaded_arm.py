"""Loads of gravity on an arm at the rows of a table: weights, moments, torques, and the shape of links that bend."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from armscope.core.location import Location
from armscope.core.rotations import cross, turned_by
from armscope.core.types import Array
from armscope.physics.beam import bent, spread_weight
from armscope.physics.terms import Driver
from armscope.recordings import Recordings
from armscope.robot import Arm, Chain, chain
from armscope.robot.gravity import gravity_wrenches, weight_at_tool, weight_of_link
from armscope.robot.parallelogram import Linkage

LINKAGE_JOINT = 3
"""The chain joint that a parallelogram drives."""


@dataclass(frozen=True, eq=False)
class Misstated:
    """By how much loads are other than stated."""

    payload_kg: float = 0.0  # added to the payload at the tool point, in all rows
    payload_share: float = 0.0  # of the stated payload, added to it
    payload_offset: Array | None = None  # (3,) m, the payload's centre off the tool point, in the last frame's axes
    masses: Array | None = None  # (n,) of each link's stated mass, added to it
    carried_kg: float = 0.0  # added to the payload at the tool point in the rows that carry one


AS_STATED = Misstated()


class LoadedArm(ABC):
    """An arm at N recorded rows, and what gravity does to it there; what effects follow is up to `Scene`.

    Args:
        arm: the arm.
        recordings: the rows; only angles and context are used, not the measured positions.
        misstated: by how much loads are other than stated.

    Attributes:
        nominal: frames without any effect.
        loaded: frames at which loads are taken.
        chain_angles: (N, n) angles of the chain's joints, rad.
    """

    def __init__(self, arm: Arm, recordings: Recordings, misstated: Misstated = AS_STATED) -> None:
        self.arm, self.recordings, self.misstated = arm, recordings, misstated
        self.nominal: Chain = chain(arm, recordings.motor_angles)
        self.loaded: Chain = self.nominal
        self.chain_angles: Array = recordings.motor_angles @ arm.actuation.T
        self._memory: dict[Any, Any] = {}

    @abstractmethod
    def driver(self, driver: Driver) -> Array:
        """Values (N,) of a driver."""

    def __len__(self) -> int:
        return len(self.recordings)

    def remember(self, key: Any, compute: Callable[[], Any]) -> Any:
        """The value of ``compute()``, computed once."""
        try:
            return self._memory[key]
        except KeyError:
            return self._memory.setdefault(key, compute())

    def loaded_as(self, misstated: Misstated) -> Self:
        """The same rows with loads other than stated, taken at the same frames."""
        other = copy(self)
        other.misstated, other._memory = misstated, {}
        return other

    def _loaded_by(self, misstated: Misstated, force: Array, moment: Array) -> Self:
        """As `loaded_as`, where that adds a force and a moment to what gravity does: loads are linear in masses."""
        other, stated = self.loaded_as(misstated), self.wrenches
        other._memory["wrenches"] = stated[0] + force, stated[1] + moment
        return other

    def with_heavier_payload(self, kilograms: float, share: float) -> Self:
        """The same rows with a payload that is heavier, by so much and by a share of the stated one."""
        wrong = self.misstated
        more = replace(wrong, payload_kg=wrong.payload_kg + kilograms, payload_share=wrong.payload_share + share)
        if wrong.payload_offset is not None:
            return self.loaded_as(more)
        return self._loaded_by(
            more, *weight_at_tool(self.arm, self.loaded, self.loaded_as(more).payload - self.payload)
        )

    def with_heavier_links(self, links: tuple[int, ...], share: float) -> Self:
        """The same rows with the masses of some links (from 1) larger by a share of each."""
        # loads ask links by links: only the last ones' are kept
        known: tuple[tuple[int, ...], float, Self] | None = self._memory.get("heavier links")
        if known is None or known[:2] != (links, share):
            stated = np.zeros(self.arm.n_joints) if self.misstated.masses is None else self.misstated.masses
            heavier = replace(self.misstated, masses=stated + share * np.isin(np.arange(len(stated)) + 1, links))
            weights = [weight_of_link(self.arm, self.loaded, link) for link in links]
            force, moment = (share * np.sum(each, axis=0) for each in zip(*weights, strict=True))
            known = (links, share, self._loaded_by(heavier, force, moment))
            self._memory["heavier links"] = known
        return known[2]

    def with_leaning_gravity(self, axis: int, angle: float) -> Self:
        """The same rows with gravity turned by an angle, rad, about one of two axes (0 or 1) across it."""
        across = np.linalg.svd(self.arm.gravity[None])[2][1 + axis]
        other = self.loaded_as(self.misstated)
        other.arm = replace(self.arm, gravity=turned_by(angle * across) @ self.arm.gravity)
        return other

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

    @property
    def payload(self) -> Array:
        """(N,) kg at the tool point: stated, plus the error under study."""
        stated, wrong = self.recordings.payload, self.misstated
        known = np.zeros(len(self)) if stated is None else np.nan_to_num(stated)
        return wrong.payload_kg + wrong.carried_kg * (known > 0) + (1 + wrong.payload_share) * known

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
            return force, moment + cross(off, self.payload[:, None] * self.arm.gravity)[:, None, :]

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
                return moment[:, 0] + cross(self.loaded.joint_origin[:, 0], force[:, 0])
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
        """Where the end of row ``link``'s beam stands: D-H frame j; where links come first, before joint j turns."""
        return f"joint {link}" if self.arm.links_come_first else f"link {link}"

    def beam(self, link: int) -> Array:
        """(3,) the step along row ``link``, in the axes of `beam_site`, m."""
        step = self.arm.step_along(link)
        along: Array = step[:3, :3].T @ step[:3, 3]
        return along

    def bending(self, link: int) -> Array:
        """(N, 6) twist of the end of row ``link`` per unit 1/(E I), in the axes of `beam_site` (`bent`)."""

        def compute() -> Array:
            step = self.beam(link)
            length = float(np.linalg.norm(step))
            e = step / length
            rotation, end = self.loaded.frame(self.beam_site(link))
            weight, centre, force, moment = self._on_beam(link)
            about_end = moment + cross(self.loaded.joint_origin[:, link - 1] - end, force)
            own, beyond, turning = (np.einsum("nba,nb->na", rotation, load) for load in (weight, force, about_end))
            return bent(e, length, beyond, turning, own, spread_weight(centre, e, length))

        twist: Array = self.remember(("bending", link), compute)
        return twist

    def _on_beam(self, link: int) -> tuple[Array, Array, Array, Array]:
        """Loads on row ``link``'s beam: its weight (N, 3), and the centre of that from the end in the axes there (3,).

        Then force and moment (N, 3) of everything beyond, at joint ``link``; loads are in base axes. Where links come
        first, the beam is the body before joint ``link``, else the one that this joint turns.
        """
        force, moment = (wrench[:, link - 1] for wrench in self.wrenches)
        body = link - 1 if self.arm.links_come_first else link
        if body == 0:
            return np.zeros_like(force), np.zeros(3), force, moment
        heavier = 1.0 if self.misstated.masses is None else 1 + self.misstated.masses[body - 1]
        weights, moments = weight_of_link(self.arm, self.loaded, body)
        own = np.broadcast_to(heavier * weights[body - 1], force.shape)
        step = self.arm.step_along(link)
        centre = step[:3, :3].T @ (self.arm.centres[body - 1] - step[:3, 3])
        if self.arm.links_come_first:
            return own, centre, force, moment
        return own, centre, force - own, moment - heavier * moments[:, link - 1]
