"""An arm in place at its rows: where the tool stands, and what further small effects would move."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.physics.effect import AXES, Direction, Term, motor
from armscope.robot import Chain, twist_jacobian
from armscope.robot.kinematics import joint_axes, joint_jacobian, turn_jacobian

if TYPE_CHECKING:
    from armscope.physics.scene import Scene

FRAMES = ("base", "joint", "link", "tool")
"""Kinds of places that a twist moves; other directions are seen by instruments that do not look at the tool."""


@dataclass(eq=False)
class Posture:
    """An arm's frames at N rows with some effects in place, and the columns of further small effects there.

    Attributes:
        scene: rows and drivers.
        frames: where the frames stand, base axes.
        stretch: relative length error of the instrument.
        moved, turned: what was computed of `displacement` and `turn`.
    """

    scene: Scene
    frames: Chain
    stretch: float = 0.0
    moved: dict[Direction, Array] = field(default_factory=dict, repr=False)
    turned: dict[Direction, Array] = field(default_factory=dict, repr=False)

    @property
    def tool(self) -> Array:
        """(N, 3) tool points as the instrument sees them, in base axes, m."""
        return self.frames.tool * (1 + self.stretch)

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
        if kind == "instrument":
            return {Direction(location, "scale"): self.frames.tool}
        if kind == "motor":
            return _by_motor(joint_jacobian(self.frames) @ self.scene.arm.actuation)
        return _by_axis(location, twist_jacobian(self.frames, location)) if kind in FRAMES else {}

    def _turns(self, location: str) -> dict[Direction, Array]:
        kind = Location.of(location).kind
        if kind == "motor":
            return _by_motor(joint_axes(self.frames) @ self.scene.arm.actuation)
        return _by_axis(location, turn_jacobian(self.frames, location)) if kind in FRAMES else {}


def _by_motor(jacobian: Array) -> dict[Direction, Array]:
    """Columns (N, 3) of a Jacobian (N, 3, m) by the motors' directions."""
    return {motor(j + 1): jacobian[:, :, j] for j in range(jacobian.shape[2])}


def _by_axis(location: str, jacobian: Array) -> dict[Direction, Array]:
    """Columns (N, 3) of a Jacobian (N, 3, 6) by the directions of a frame."""
    return {Direction(location, name): jacobian[:, :, axis] for axis, name in enumerate(AXES)}
