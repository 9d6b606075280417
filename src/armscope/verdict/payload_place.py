"""Payloads whose place nobody stated: what is then said beside everything that gives way, and done first."""

from __future__ import annotations

from armscope.physics.backgrounds import ELASTIC
from armscope.physics.payload import PAYLOAD_ERROR
from armscope.robot import Arm
from armscope.verdict.effects import FoundEffect
from armscope.verdict.schema import Notice, Verdict

KIND = "payload's place"  # Of the notice that `armscope.check.preconditions` gives
TOOL_FIRST = (
    "First state tool_mm in the robot's file, where the load hangs (armscope check tells where the points put the "
    "tool), and diagnose again: without it each payload counts as sitting in the last frame's origin, and what looks "
    "like a wrong load may be that distance alone. Only if the load is named again: "
)
WRONG_ALIKE = "But no tool_mm is stated: what that makes wrong is wrong alike in each of them."


def of_payloads(verdict: Verdict) -> tuple[Notice, ...]:
    """The notice that payloads have no place, where something is named that gives way under them."""
    named = any(effect.family == ELASTIC for effect in verdict.effects)
    return tuple(notice for notice in verdict.notices if named and notice.kind == KIND)


def instruction_of(effect: FoundEffect, arm: Arm, instruction: str) -> str:
    """An instruction; of a wrong payload that has no stated place, what is done before it.

    Args:
        effect: that is cured.
        arm: whose description states a tool, or none.
        instruction: of its cure.

    Returns:
        The instruction.
    """
    if effect.effect != PAYLOAD_ERROR.name or any(arm.description.tool_mm):
        return instruction
    return f"{TOOL_FIRST}{instruction[:1].lower()}{instruction[1:]}"


def carries_over(effect: FoundEffect, verdict: Verdict) -> str:
    """What is known about an effect on other runs and payloads; payloads without a place can't confirm each other."""
    if effect.family != ELASTIC or "payloads" not in effect.carries_over or not of_payloads(verdict):
        return effect.carries_over
    return f"{effect.carries_over} {WRONG_ALIKE}"
