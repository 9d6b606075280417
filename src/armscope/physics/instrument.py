"""What the instrument gets wrong: its length scale."""

from __future__ import annotations

from collections.abc import Iterator

from armscope.physics.clause import Told
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import ONE, Cure, Direction, Effect, Placed, term
from armscope.recordings import Recordings
from armscope.robot import Arm


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
    labels={"scale": "lengths too long by"},
    atlas="constant",
)

EFFECTS = [INSTRUMENT_SCALE]
