"""A payload other than stated: it shows only through what gives way under it, so it builds on a model's elasticity."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from armscope.core.types import Array
from armscope.core.words import rounded
from armscope.physics.clause import Told
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import ONE, Cure, Direction, Driver, Effect, Part, Placed, Product, Term
from armscope.physics.elastic import UNKNOWN_MASSES
from armscope.physics.loaded_arm import Misstated
from armscope.physics.loads import givings
from armscope.physics.placing import nowhere, varies
from armscope.recordings import Recordings

LEAST_PAYLOAD_KG = 1e-6
"""A payload that varies by less is one payload: a wrong factor and a wrong mass are the same."""
CARRYING = Driver("carrying")
"""1 where a payload is stated, 0 where none is carried."""
PAYLOAD_MASS = Direction("payload", "mass")
"""The load itself, kg: it moves nothing, but instruments that feel loads see it."""


def payload_errors(recordings: Recordings, elastic: Sequence[Part]) -> Iterator[Placed]:
    """The payload's mass, or its centre of mass, in error: first-order in the elastic effects' present values.

    Nothing can be in error where no payload is stated.
    """
    if recordings.payload is None:
        return
    loaded = what_bears(recordings, elastic)
    if not loaded:
        return
    heaviest = float(np.nan_to_num(recordings.payload).max(initial=0.0))
    mass = _term("mass", "kg", 1.0, loaded, _by_mass, Product(PAYLOAD_MASS, ONE))
    mass = replace(mass, plausible=PLAUSIBLE.payload_share * heaviest if heaviest else math.inf)
    yield Placed(PAYLOAD_ERROR, "payload", (mass,), (1.0,), "payload", variant="mass")
    if varies(recordings.payload, LEAST_PAYLOAD_KG):
        itself = Product(PAYLOAD_MASS, Driver("payload"))
        factor = _term("share", "of what is stated", 1.0, loaded, _by_share, itself)
        factor = replace(factor, plausible=PLAUSIBLE.payload_share)
        yield Placed(PAYLOAD_ERROR, "payload", (factor,), (1.0,), "payload", variant="factor")
    if _carries_several(recordings.payload):
        carried = _term("mass_carried", "kg", 1.0, loaded, _by_mass_carried, Product(PAYLOAD_MASS, CARRYING))
        carried = replace(carried, plausible=PLAUSIBLE.payload_share * heaviest)
        yield Placed(PAYLOAD_ERROR, "payload", (carried,), (1.0,), "payload", variant="carried")
    centre = tuple(
        replace(
            _term(f"com_{name}", "mm", 1e-3, loaded, partial(_off_centre, axis)),
            plausible=PLAUSIBLE.payload_centre_m,
        )
        for axis, name in enumerate("xyz")
    )
    yield Placed(PAYLOAD_ERROR, "payload", centre, (1.0,) * 3, "payload", variant="centre")


def _carries_several(payload: Array) -> bool:
    """Whether some rows carry nothing and others different loads: else a mass or a share says the same."""
    stated = payload[np.isfinite(payload)]
    carried = stated[stated > LEAST_PAYLOAD_KG]
    return len(carried) < len(stated) and bool(np.ptp(carried) > LEAST_PAYLOAD_KG if len(carried) else False)


def what_bears(recordings: Recordings, elastic: Sequence[Part]) -> list[Product]:
    """What gives way under a load at the flange in a model's parts, and by how much."""
    known = [part for part in elastic if part.placed.variant != UNKNOWN_MASSES]
    absolute = [g for part in elastic if part.placed.variant == UNKNOWN_MASSES for g in _absolute_giving(part)]
    return [*givings(known, recordings.torque is not None), *absolute]


def _absolute_giving(part: Part) -> Iterator[Product]:
    """The absolute compliance that payload differences gave a joint of unknown masses."""
    for value, term in zip(part.values, part.placed.terms, strict=True):
        driver = term.products[0].driver
        if driver.kind == "payload torque" and value != 0:
            yield Product(term.products[0].direction, Driver("gravity torque", driver.arguments), float(value))


def _by_mass(load: Driver) -> Driver:
    return Driver("heavier", (load,))


def _by_mass_carried(load: Driver) -> Driver:
    return Driver("both", (_by_mass(load), CARRYING))


def _by_share(load: Driver) -> Driver:
    return Driver("heavier by share", (load,))


def _off_centre(axis: int, load: Driver) -> Driver:
    return Driver("off centre", (load, axis))


def _term(
    name: str, unit: str, si: float, loaded: Sequence[Product], change: Callable[[Driver], Driver], *itself: Product
) -> Term:
    """What one unit of the payload's error does through all that gives way, and by itself."""
    through = tuple(Product(g.direction, change(g.driver), g.factor) for g in loaded)
    return Term(name, unit, si, (*through, *itself))


def _restated(part: Part) -> Misstated:
    """What the payload is more than stated."""
    values = {term.name: float(value) for term, value in zip(part.placed.terms, part.values, strict=True)}
    offset = np.array([values.get(f"com_{axis}", 0.0) for axis in "xyz"])
    return Misstated(
        values.get("mass", 0.0), values.get("share", 0.0), offset, carried_kg=values.get("mass_carried", 0.0)
    )


def _not_as_stated(told: Told) -> str:
    if "share" in told.numbers:
        share = told.numbers["share"].value
        return f"the payload is {rounded(100 * abs(share))} % {'heavier' if share > 0 else 'lighter'} than stated"
    if "mass_carried" in told.numbers:
        mass = told.numbers["mass_carried"]
        return f"whatever is carried is {mass} {'heavier' if mass.value > 0 else 'lighter'} than stated"
    errors = " and ".join(f"{name.replace('_', ' ')} by {number:+}" for name, number in told.numbers.items())
    return "the payload is not as stated" + (f": {errors}" if errors else "")


PAYLOAD_ERROR = Effect(
    "payload_error",
    "elastic",
    nowhere,  # it needs a model that gives way
    "The payload's mass or centre of mass is other than stated, so everything that gives way is loaded differently.",
    "Weigh the tool and its load, and find its centre of mass by hanging it from two points.",
    Cure(
        "Correct the payload's data in the controller: mass = stated mass + mass (a share: x (1 + share); "
        "mass_carried: where anything is carried, as of a gripper that nobody counted); "
        "centre = stated centre + com, in the last frame's axes; what is not named stays as stated. The deflection is "
        "then compensated with the right load.",
        statement=_restated,
        change="payload data",
        instruction="Weigh the load and correct mass and centre of mass in the controller.",
    ),
    clauses=(_not_as_stated,),
    labels={"mass_carried": "mass, where anything is carried"},
    atlas="gravity load",
    needs=("payload_kg",),
    requires="elastic",
)

EFFECTS = [PAYLOAD_ERROR]
