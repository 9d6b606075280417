"""What the instrument gets wrong: its length scale."""

from __future__ import annotations

from collections.abc import Iterator

from armscope.physics.effect import ONE, Direction, Effect, Placed, term
from armscope.recordings import Recordings
from armscope.robot import Arm


def _place_scale(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    scale = term("scale", "m/m", (Direction("instrument", "scale"), ONE))
    yield Placed(INSTRUMENT_SCALE, "instrument", (scale,), (1.0,), "distance")


INSTRUMENT_SCALE = Effect(
    "instrument_scale",
    "instrument",
    _place_scale,
    "The instrument measures all lengths too long or too short by the same share.",
    "Measure a calibrated scale bar, or correct the air's refractive index by temperature and pressure.",
    "Correct the instrument's scale.",
)

EFFECTS = [INSTRUMENT_SCALE]
