"""What the instrument gets wrong: its length scale, or that of heights alone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.physics.clause import Told
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import ONE, Cure, Direction, Effect, Part, Placed, term
from armscope.recordings import Recordings
from armscope.robot import Arm


def _place_scale(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    scale = term("scale", "m/m", (Direction("instrument", "scale"), ONE), plausible=PLAUSIBLE.scale)
    yield Placed(INSTRUMENT_SCALE, "instrument", (scale,), (1.0,), "distance")
    if np.any(arm.gravity):  # else nothing says which way is up
        height = term(HEIGHT_SCALE, "m/m", (Direction("instrument", "height"), ONE), plausible=PLAUSIBLE.scale)
        # the plain scale, which most instruments have wrong, pays for no second form
        yield Placed(_OF_HEIGHTS, "instrument", (height,), (1.0,), "height", multiplicity=2, variant="height")


HEIGHT_SCALE = "height_scale"


def _measures(told: Told) -> str:
    if HEIGHT_SCALE in told.numbers:
        scale = told.numbers[HEIGHT_SCALE]
        return f"the instrument reads heights {scale} too {'large' if scale.value > 0 else 'small'}"
    scale = told.numbers["scale"]
    return f"the instrument measures {scale} too {'long' if scale.value > 0 else 'short'}"


INSTRUMENT_SCALE = Effect(
    "instrument_scale",
    "instrument",
    _place_scale,
    "The instrument measures all lengths too long or too short by the same share.",
    "Measure a calibrated scale bar, or correct the air's refractive index by temperature and pressure. If the "
    "instrument is right, all links are longer by that: an arm 10 K warmer is, by 0.12 (steel) to 0.23 mm per metre.",
    Cure(
        "Correct the instrument's scale, unless the scale bar shows it right: reading = measured / (1 + scale).",
        readings=lambda measured, part: measured / (1 + float(part.values[0])),
        change="instrument",
        instruction="Measure a scale bar at the arm's temperature: if it is off, have the instrument's scale "
        "calibrated; else it is the arm that grew.",
    ),
    clauses=(_measures,),
    labels={"scale": "lengths too long by", HEIGHT_SCALE: "heights too large by"},
    atlas="constant",
)


def _heights_corrected(measured: Array, part: Part) -> Array:
    """Readings (N, 3) of an instrument whose third axis is the vertical."""
    return np.asarray(measured / np.array([1.0, 1.0, 1 + float(part.values[0])]))


_OF_HEIGHTS = replace(
    INSTRUMENT_SCALE,
    physics="The instrument measures heights too large or too small by the same share, other lengths right: the scale "
    "of one axis of a gantry or camera, or air that is warmer above than below.",
    confirm="Measure a calibrated scale bar upright, then lying: only upright it is off.",
    cure=Cure(
        "Correct the instrument's scale along the vertical, unless the upright scale bar shows it right: height = "
        "measured height / (1 + height_scale).",
        readings=_heights_corrected,
        change="instrument",
        instruction="Measure a scale bar upright: if it is off, have that axis of the instrument calibrated; else "
        "change nothing by this.",
    ),
)

EFFECTS = [INSTRUMENT_SCALE]
