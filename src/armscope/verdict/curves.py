"""Curves as tables to subtract from commands: the shape about its mean, and the zero that no other step sets."""

from __future__ import annotations

import pandas as pd

from armscope.verdict.contributions import ground_of, parts_of
from armscope.verdict.diagnosis import Diagnosis

COLUMNS = ("effect", "location", "driver", "at", "at_unit", "value", "stderr", "unit", "zero_in_value")


def curves_table(verdict: Diagnosis) -> pd.DataFrame | None:
    """Every effect's curve over its driver, one row per point; None where there is none.

    `value` is what is subtracted from a command: `zero_in_value` of it is constant, the joint's own zero where it
    follows the joint's angle; no other step of the work order sets it, and the rest is the curve about its mean.
    """
    told = [(effect, effect.curve) for effect in verdict.effects if effect.curve is not None]
    if not told:
        return None
    parts = parts_of(verdict)
    ground = ground_of(verdict) if any(effect.nameless for effect, _ in told) else None
    pieces = []
    for effect, curve in told:
        zero = ground.own_zero(effect, parts[id(effect)]) if ground is not None else 0.0
        about = (effect.effect, effect.location, curve.driver)
        values = (curve.at, curve.driver_unit, curve.value + zero, curve.stderr, curve.value_unit, zero)
        pieces.append(pd.DataFrame(dict(zip(COLUMNS, (*about, *values), strict=True))))
    return pd.concat(pieces, ignore_index=True)
