"""What rounding of the recorded angles does to the tool: noise with a known cause, and no effect."""

from __future__ import annotations

import numpy as np

from armscope.diagnosis.state import DiagnosisState
from armscope.fitting.joint_scatter import Scattered, motor_jacobians
from armscope.recordings.resolution import step_in_words
from armscope.verdict.schema import Notice


def rounding_mm(state: DiagnosisState) -> float:
    """How much the tool scatters by rounded angles alone, mm per axis; 0 where none are."""
    if not (rounded := _rounded(state)):
        return 0.0
    moved = motor_jacobians(state.fit.model, state.recordings)
    variance = sum(each.size**2 * float(np.mean(moved[each.motor - 1] ** 2)) for each in rounded)
    return float(np.sqrt(variance))


def told_of_rounding(state: DiagnosisState, tool_mm: float) -> list[Notice]:
    """Says in which steps angles stand, and what that costs.

    Args:
        state: the finished selection.
        tool_mm: from `rounding_mm`.

    Returns:
        One notice, or none where angles are not rounded.
    """
    if not (rounded := _rounded(state)):
        return []
    steps = [step_in_words(step) for step in sorted({round(float(each.size * np.sqrt(12)), 12) for each in rounded})]
    text = (
        f"The angles in this table were rounded, to steps of {' and '.join(steps)}: "
        f"that alone moves the tool by {tool_mm:.2g} mm per axis, which counts as noise, not as a fault of the arm. "
        "Record more digits, and smaller errors can be seen."
    )
    return [Notice("rounded angles", text)]


def _rounded(state: DiagnosisState) -> list[Scattered]:
    return [each for each in state.scatter if each.rounded]
