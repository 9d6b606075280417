"""Measured tool points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.rotations import turned_by
from armscope.core.types import Array
from armscope.measurement.channel import Channel
from armscope.physics.effect import AXES, Direction, Part, Placed, Term
from armscope.physics.frames import bases_and_tools, runs_of
from armscope.physics.model import Base, FittedModel
from armscope.physics.scene import Posture
from armscope.recordings import Recordings


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
