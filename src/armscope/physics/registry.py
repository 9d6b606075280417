"""The library: every effect that can be missing, in one list."""

from __future__ import annotations

from armscope.physics import drift, elastic, freeform, geometric, instrument, payload, thermal, transmission
from armscope.physics.effect import Effect, Placed
from armscope.recordings import Recordings
from armscope.robot import Arm

EFFECTS: tuple[Effect, ...] = (
    *geometric.EFFECTS,
    *transmission.EFFECTS,
    *elastic.EFFECTS,
    *thermal.EFFECTS,
    *drift.EFFECTS,
    *instrument.EFFECTS,
    *payload.EFFECTS,
    *freeform.EFFECTS,
)


def effect_named(name: str) -> Effect | None:
    """The definition of an effect by its name; None where nothing of that name is installed."""
    return next((effect for effect in EFFECTS if effect.name == name), None)


def library(arm: Arm, recordings: Recordings) -> list[Placed]:
    """Every effect at every location of an arm where the recordings can show it, without those found by scanning."""
    return [placed for effect in EFFECTS for placed in effect.place(arm, recordings)]
