"""Errors of loads, written anew around what gives way in a model: a load times a compliance is bilinear."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from armscope.physics.effect import Effect, Part, Placed
from armscope.physics.loads import STATED_MASSES, mass_errors
from armscope.physics.model import FittedModel
from armscope.physics.payload import PAYLOAD_ERROR, payload_errors
from armscope.recordings import Recordings


def on_loads(model: FittedModel, recordings: Recordings) -> tuple[FittedModel, list[Placed], list[Placed]]:
    """The model with its errors of loads written anew, and those errors on top of what gives way in it.

    Returns:
        The model, payload errors, and the masses' errors.
    """
    parts = [part for part in model.parts if part.placed.effect is not PAYLOAD_ERROR]
    background = [part for part in model.background if part.placed.effect is not STATED_MASSES]
    payload = list(payload_errors(recordings, [part for part in parts if part.placed.parametrisation == "plain"]))
    masses = mass_errors(model.arm, recordings, [*background, *parts])
    by_place = {(p.key, p.variant): p for p in (*payload, *masses)}

    def anew(some: Sequence[Part], effect: Effect) -> list[Part]:
        known = [(part, by_place.get((part.placed.key, part.placed.variant))) for part in some]
        return [Part(p, part.values) for part, p in known if p is not None and p.effect is effect]

    parts += anew(model.parts, PAYLOAD_ERROR)
    background += anew(model.background, STATED_MASSES)
    return replace(model, parts=tuple(parts), background=tuple(background)), payload, masses
