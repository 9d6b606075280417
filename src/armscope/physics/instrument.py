"""What the instrument gets wrong: its length scale, and errors that change from place to place.

The places are the nominal tool points: an instrument's errors are a thousandth of the way between them.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from armscope.core.types import Array
from armscope.physics.clause import Told
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.cure import Cure
from armscope.physics.effect import AXES, ONE, Direction, Driver, Effect, Placed, term
from armscope.physics.place_drivers import DEGREE, legendre_product
from armscope.physics.scene import Part
from armscope.recordings import Recordings
from armscope.robot import Arm, forward_kinematics

PLACE = "place"
LEAST_SPAN_M = 0.01
"""A tool that only turns on the spot sees the instrument at one place."""


def _place_scale(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    scale = term("scale", "m/m", (Direction("instrument", "scale"), ONE), plausible=PLAUSIBLE.scale)
    yield Placed(INSTRUMENT_SCALE, "instrument", (scale,), (1.0,), "distance")


def _measures(told: Told) -> str:
    scale = told.numbers["scale"]
    return f"the instrument measures {scale} too {'long' if scale.value > 0 else 'short'}"


INSTRUMENT_SCALE = Effect(
    "instrument_scale",
    "instrument",
    _place_scale,
    "The instrument measures all lengths too long or too short by the same share.",
    "Measure a calibrated scale bar, or correct the air's refractive index by temperature and pressure.",
    Cure(
        "Correct the instrument's scale, not the arm: reading = measured / (1 + scale).",
        readings=lambda measured, part: measured / (1 + float(part.values[0])),
        change="instrument",
        instruction="Have the instrument's scale calibrated, and measure again.",
    ),
    clauses=(_measures,),
    labels={"scale": "lengths too long by"},
    atlas="constant",
    contained_in=(PLACE,),
)


def _place_distortion(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    degrees = [each for each in itertools.product(range(DEGREE + 1), repeat=3) if 1 <= sum(each) <= DEGREE]
    if len(recordings) < 3 * len(degrees):  # a reading of three numbers for each value
        return
    tool = forward_kinematics(arm, recordings.motor_angles)
    low, high = tool.min(axis=0), tool.max(axis=0)
    if (high - low).max() < LEAST_SPAN_M:
        return
    volume = (*((low + high) / 2).tolist(), float((high - low).max() / 2))
    terms = tuple(
        term(
            f"{axis}_{'x' * a}{'y' * b}{'z' * c}",
            "mm",
            (Direction("instrument", f"t{axis}"), Driver(PLACE, (a, b, c, *volume))),
            si=1e-3,
            plausible=PLAUSIBLE.volume_m,
        )
        for axis in "xyz"
        for a, b, c in degrees
    )
    yield Placed(
        INSTRUMENT_DISTORTION,
        "instrument",
        terms,
        (len(terms) ** -0.5,) * len(terms),
        "place in the measuring volume",
        variant=PLACE,
        parametrisation="curve",
        partly_unseen=True,
    )


def _without_distortion(measured: Array, part: Part) -> Array:
    corrected = measured.copy()
    for value, each in zip(part.values, part.placed.terms, strict=True):
        (product,) = each.products
        a, b, c, x, y, z, width = map(product.driver.number, range(7))
        at_place = legendre_product(measured, (int(a), int(b), int(c)), (x, y, z), width)
        corrected[:, AXES.index(product.direction.axis)] -= value * at_place
    return corrected


INSTRUMENT_DISTORTION = Effect(
    "instrument_distortion",
    "instrument",
    _place_distortion,
    "The instrument's error changes from place to place in its measuring volume: a lens, warm air, several stations.",
    "Measure the same poses from another station: the instrument's error stays with the instrument, the arm's with the "
    "arm. Or measure a calibrated bar at several places.",
    Cure(
        "Correct the instrument, not the arm: reading = measured - fitted error at that place.",
        readings=_without_distortion,
        change="instrument",
        instruction="Have the instrument calibrated over its volume, or stand it nearer, and measure again.",
    ),
    clauses=("the instrument's error changes from place to place in its volume",),
    atlas="place",
)

EFFECTS = [INSTRUMENT_SCALE, INSTRUMENT_DISTORTION]
