"""Numbers of an effect that are not told, neither on its card nor as something to enter: the rows do not tell them."""

from __future__ import annotations

import math

from armscope.verdict.constants import WORDS
from armscope.verdict.effects import FoundEffect, Parameter

IMPLAUSIBLE = {"mm": 15.0, "rad": 0.1, "rad/rad": 0.05, "m/m": 2e-3, "1/K": 1e-4, "rad/K": 1e-3}
"""Beyond these a fitted error of shape, drives or instrument is none of an arm that works at all: links are
made to a few tenths of a mm, mastering is good to a few mrad, steel and aluminium grow by 12 and 24 millionths per K
(ISO 230-1 and makers' data sheets); the bounds lie several times beyond. Such a value stands in for another one."""
ABOUT_THE_ARM = ("geometric", "transmission", "thermal", "instrument")
MM_AT_THE_TOOL = {"mm": 1.0, "rad": 1e3}  # An angle acts at about a metre


def untold(parameter: Parameter, effect: FoundEffect) -> bool:
    """Whether a value is none that somebody could act on."""
    return implausible(parameter, effect) or absorbed(parameter, effect)


def implausible(parameter: Parameter, effect: FoundEffect) -> bool:
    """Whether a value can't be told: it lies beyond what arms have, or the rows leave it open beyond that."""
    bound = IMPLAUSIBLE.get(parameter.unit)
    if bound is None or effect.family not in ABOUT_THE_ARM or parameter.name in ("phase", "direction"):
        return False
    open_by = parameter.stderr if math.isfinite(parameter.stderr) else 0.0
    return max(abs(parameter.value), open_by) > bound


def absorbed(parameter: Parameter, effect: FoundEffect) -> bool:
    """Whether other parameters take a value back in these poses: d of neighbouring parallel axes, for instance.

    Its uncertainty alone would move the tool many times as far as the whole effect does, and may be all there is of it:
    the zero of a last joint whose axis passes by the tool moves it by as little, and is told.
    """
    lever_mm = MM_AT_THE_TOOL.get(parameter.unit)
    # directions and phases move nothing by themselves, and where a load sits moves no tool by as much
    apart = parameter.name in ("phase", "direction") or effect.location == "payload" or effect.nameless
    if lever_mm is None or apart or len(effect.parameters) < 2 or not math.isfinite(parameter.stderr):
        return False
    sure = abs(parameter.value) > WORDS.sure * parameter.stderr
    return not sure and parameter.stderr * lever_mm >= WORDS.left_open * effect.rms_at_tool_mm


def beyond_arms(effect: FoundEffect) -> bool:
    """Whether a value that is sure lies beyond what arms have: what was stated of the arm is to be looked at first."""
    return any(implausible(p, effect) and abs(p.value) > WORDS.sure * p.stderr for p in effect.parameters)
