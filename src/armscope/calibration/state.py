"""Values of everything that a calibration may change, and the arm that they make."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.rotations import turned_by
from armscope.core.types import Array
from armscope.robot import Arm, Chain


@dataclass(frozen=True, eq=False)
class State:
    """Values of everything that may be free."""

    rotations: Array  # (R, 3, 3) measurement frame from arm base, per base frame
    translations: Array  # (R, 3) measurement frame from arm base, per base frame
    tools: Array  # (K, 3) offsets in the last frame, m
    constants: Array  # (P,) added to the arm's constants, m and rad
    compliances: Array  # (m,) rad/(N m), angle += compliance * load
    tool_rotations: Array  # (K, 3, 3) last frame from measured tool frame; counts only where orientations are used

    def moved(self, step: Array) -> State:
        """A step in the order of `SetUp.names`; base steps are twists in the base's own axes."""
        n_bases, n_tools, n_constants = len(self.rotations), len(self.tools), len(self.constants)
        lengths = [6 * n_bases, 3 * n_tools, n_constants, len(self.compliances)]
        base, tools, constants, compliances, turns = np.split(step, np.cumsum(lengths))
        base = base.reshape(n_bases, 6)
        return State(
            rotations=self.rotations @ turned_by(base[:, 3:]),
            translations=self.translations + np.einsum("rij,rj->ri", self.rotations, base[:, :3]),
            tools=self.tools + tools.reshape(n_tools, 3),
            constants=self.constants + constants,
            compliances=self.compliances + compliances,
            tool_rotations=self.tool_rotations @ turned_by(turns.reshape(n_tools, 3)),
        )


@dataclass(frozen=True, eq=False)
class Posed:
    """An arm with a state's constants, its frames, and what is left of N rows: (N, 3) m, or (N, 6) with turns."""

    arm: Arm
    frames: Chain
    left: Array
