"""Measured orientations of the tool."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.rotations import turned_by
from armscope.core.types import Array
from armscope.measurement.channel import Channel
from armscope.measurement.constants import WEIGHTS
from armscope.physics.effect import AXES, Direction, Placed, Term
from armscope.physics.frames import ToolKey, tool_key, tool_turns
from armscope.physics.model import FittedModel
from armscope.physics.orientation_error import ORIENTATION_ERROR
from armscope.physics.scene import Posture
from armscope.recordings import Recordings

NOT_THE_TOOLS_RAD = np.radians(5)
"""Median turn between modelled and measured orientations beyond which they are not the tool's; joint zeros two degrees
off leave less."""


class OrientationChannel(Channel):
    """Rotation vectors from modelled to measured orientations in base axes, rad: the tool's turn is free."""

    name, unit, width = "orientation", "rad", 3
    floor = 1e-6
    """No instrument resolves less."""

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
