"""A payload other than stated: it shows only through what gives way under it, so it builds on a model's elasticity."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from armscope.physics.clause import Told
from armscope.physics.cure import Cure
from armscope.physics.drivers import follows
from armscope.physics.effect import ONE, Direction, Driver, Effect, Placed, Product, Term
from armscope.physics.elastic import UNKNOWN_MASSES
from armscope.physics.scene import Part, Scene
from armscope.recordings import Recordings

PAYLOAD_MASS = Direction("payload", "mass")
"""The load itself, kg: it moves nothing, but instruments that feel loads see it."""


def payload_errors(recordings: Recordings, elastic: Sequence[Part]) -> Iterator[Placed]:
    """The payload's mass, or its centre of mass, in error: first-order in the elastic effects' present values.

    Nothing can be in error where no payload is stated.
    """
    if recordings.payload is None:
        return
    measured = recordings.torque is not None
    known = [part for part in elastic if part.placed.variant != UNKNOWN_MASSES]
    givings = [g for part in known for g in _givings(part) if not (measured and g.driver.kind == "torque")]
    absolute = [g for part in elastic if part.placed.variant == UNKNOWN_MASSES for g in _absolute_giving(part)]
    mass = _term("mass", "kg", 1.0, [*givings, *absolute], lambda load: Driver("heavier", (load,)))
    if mass.products:
        mass = Term(mass.name, mass.unit, mass.si, (*mass.products, Product(PAYLOAD_MASS, ONE)))
        yield Placed(PAYLOAD_ERROR, "payload", (mass,), (1.0,), "payload", variant="mass")
    centre = tuple(
        _term(
            f"com_{name}", "mm", 1e-3, [*givings, *absolute], lambda load, axis=axis: Driver("off centre", (load, axis))
        )
        for axis, name in enumerate("xyz")
    )
    if not centre[0].products:
        return
    yield Placed(PAYLOAD_ERROR, "payload", centre, (1.0,) * 3, "payload", variant="centre")


def _givings(part: Part) -> Iterator[Product]:
    """What gives way in a part, times how much; recorded torques hold the true payload already."""
    for value, term in zip(part.values, part.placed.terms, strict=True):
        for product in term.products:
            if follows("weight", product.driver) and value != 0:
                yield Product(product.direction, product.driver, product.factor * float(value))


def _absolute_giving(part: Part) -> Iterator[Product]:
    """The absolute compliance that payload differences gave a joint of unknown masses."""
    for value, term in zip(part.values, part.placed.terms, strict=True):
        driver = term.products[0].driver
        if driver.kind == "payload torque" and value != 0:
            yield Product(term.products[0].direction, Driver("gravity torque", driver.arguments), float(value))


def _term(name: str, unit: str, si: float, givings: Sequence[Product], change: Any) -> Term:
    """What one unit of the payload's error does through all that gives way."""
    return Term(name, unit, si, tuple(Product(g.direction, change(g.driver), g.factor) for g in givings))


def _restated(scene: Scene, part: Part) -> Scene:
    """The scene with the payload as it is."""
    values = {term.name: float(value) for term, value in zip(part.placed.terms, part.values, strict=True)}
    offset = np.array([values.get(f"com_{axis}", 0.0) for axis in "xyz"])
    return scene.with_payload(values.get("mass", 0.0), offset)


def _not_as_stated(told: Told) -> str:
    errors = " and ".join(f"{name.replace('_', ' ')} by {number:+}" for name, number in told.numbers.items())
    return "the payload is not as stated" + (f": {errors}" if errors else "")


PAYLOAD_ERROR = Effect(
    "payload_error",
    "elastic",
    lambda arm, recordings: iter(()),  # it needs a model that gives way
    "The payload's mass or centre of mass is other than stated, so everything that gives way is loaded differently.",
    "Weigh the tool and its load, and find its centre of mass by hanging it from two points.",
    Cure(
        "Correct the payload's data in the controller: mass = stated mass + mass, centre = stated centre + com. What "
        "gives way is then commanded away with the right load.",
        statement=_restated,
    ),
    clauses=(_not_as_stated,),
    atlas="gravity load",
    needs=("payload_kg",),
    requires="elastic",
)

EFFECTS = [PAYLOAD_ERROR]
