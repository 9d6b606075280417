"""Whether the numbers of a stated tool stand in another order, or with other signs, than the points tell."""

from __future__ import annotations

import itertools

import numpy as np

from armscope.calibration.geometry import State
from armscope.check.constants import TRIALS
from armscope.check.suspicion import Suspicion
from armscope.robot import Arm


def tool_stated_otherwise(arm: Arm, state: State) -> list[Suspicion]:
    """Whether the one measured tool point is where `tool_mm` would be with its numbers exchanged or turned round.

    Points alone find the tool without it. Commands in the base frame, loads and drawings start from what is stated.

    Returns:
        A hint with the numbers as the points have them, or nothing.
    """
    stated = np.array(arm.description.tool_mm)
    if not stated.any() or len(state.tools) != 1:
        return []
    found = 1e3 * state.tools[0]
    readings = np.array(
        [
            stated[list(order)] * signs
            for order in itertools.permutations(range(3))
            for signs in itertools.product((1, -1), repeat=3)
        ]
    )
    off = np.linalg.norm(readings - found, axis=1)
    if off.min() > TRIALS.tool_read_otherwise * np.linalg.norm(stated - found):
        return []
    at, as_stated, otherwise = (", ".join(f"{each + 0.0:.4g}" for each in numbers) for numbers in
                                (found.round(1), stated, readings[off.argmin()]))  # fmt: skip
    statement = f"the points sit at [{at}] mm in the last frame, where `tool_mm` says [{as_stated}]"
    return [Suspicion("hint", statement, f"Are its numbers in another order, or of other signs: [{otherwise}]?")]
