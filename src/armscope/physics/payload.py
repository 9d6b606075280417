"""A payload other than stated: it shows only through what gives way under it, so it builds on a model's elasticity."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from armscope.physics.effect import Driver, Effect, Placed, Product, Term
from armscope.physics.scene import Part
from armscope.recordings import Recordings

LOADS = ("torque", "gravity torque", "moment", "bend")
"""Drivers that a payload changes; recorded torques hold the true payload already."""


def payload_errors(recordings: Recordings, elastic: Sequence[Part]) -> Iterator[Placed]:
    """The payload's mass, or its centre of mass, in error: first-order in the elastic effects' present values.

    Nothing can be in error where no payload is stated.
    """
    if recordings.payload is None:
        return
    measured = recordings.torque is not None
    elastic = [part for part in elastic if not (measured and _driver(part) == "torque")]
    mass = _term("mass", "kg", 1.0, elastic, lambda load: Driver("heavier", (load,)))
    if not mass.products:
        return
    yield Placed(PAYLOAD_ERROR, "payload", (mass,), (1.0,), "payload", variant="mass")
    centre = tuple(
        _term(f"com_{name}", "mm", 1e-3, elastic, lambda load, axis=axis: Driver("off centre", (load, axis)))
        for axis, name in enumerate("xyz")
    )
    yield Placed(PAYLOAD_ERROR, "payload", centre, (1.0,) * 3, "payload", variant="centre")


def _driver(part: Part) -> str:
    return part.placed.terms[0].products[0].driver.kind


def _term(name: str, unit: str, si: float, elastic: Sequence[Part], change: Any) -> Term:
    """What one unit of the payload's error does through all that gives way."""
    products = tuple(
        Product(product.direction, change(product.driver), product.factor * float(value))
        for part in elastic
        for value, term in zip(part.values, part.placed.terms, strict=True)
        for product in term.products
        if product.driver.kind in LOADS and value != 0
    )
    return Term(name, unit, si, products)


PAYLOAD_ERROR = Effect(
    "payload_error",
    "elastic",
    lambda arm, recordings: iter(()),  # it needs a model that gives way
    "The payload's mass or centre of mass is other than stated, so everything that gives way is loaded differently.",
    "Weigh the tool and its load, and find its centre of mass by hanging it from two points.",
    "Correct the payload's data in the controller.",
    needs=("payload_kg",),
)

EFFECTS = [PAYLOAD_ERROR]
