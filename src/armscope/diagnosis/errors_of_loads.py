"""Errors of loads, written anew around what gives way in a model: a load times a compliance is bilinear."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from armscope.physics.effect import Effect, Part, Placed
from armscope.physics.loads import STATED_MASSES, mass_errors
from armscope.physics.model import FittedModel
from armscope.physics.payload import PAYLOAD_ERROR, payload_errors
from armscope.physics.payload_change import PAYLOAD_CHANGE, payload_changes
from armscope.recordings import Recordings

OF_PAYLOADS = (PAYLOAD_ERROR, PAYLOAD_CHANGE)


def on_loads(model: FittedModel, recordings: Recordings) -> tuple[FittedModel, list[Placed], list[Placed]]:
    """The model with its errors of loads written anew, and those errors on top of what gives way in it.

    Returns:
        The model, payload errors, and the masses' errors.
    """
    parts = [part for part in model.parts if part.placed.effect not in OF_PAYLOADS]
    background = [part for part in model.background if part.placed.effect is not STATED_MASSES]
    elastic = [part for part in parts if part.placed.parametrisation == "plain"]
    payload = [*payload_errors(recordings, elastic), *payload_changes(recordings, elastic)]
    masses = mass_errors(model.arm, recordings, [*background, *parts])
    by_place = {(p.key, p.variant): p for p in (*payload, *masses)}

    def anew(some: Sequence[Part], effects: Sequence[Effect]) -> list[Part]:
        known = [(part, by_place.get((part.placed.key, part.placed.variant))) for part in some]
        return [Part(p, part.values) for part, p in known if p is not None and p.effect in effects]

    parts += anew(model.parts, OF_PAYLOADS)
    background += anew(model.background, [STATED_MASSES])
    return replace(model, parts=tuple(parts), background=tuple(background)), payload, masses
