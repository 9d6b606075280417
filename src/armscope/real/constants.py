"""Numbers that decide in this room; see `armscope.core.constants`.

What real arms can have: whoever conceals errors in their recordings takes none beyond it. None of it is known to the
diagnosis, whose own idea of plausible sizes is in `armscope.physics.constants`.
"""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants, constant


@dataclass(frozen=True)
class LargestErrors(Constants):
    """Sizes beyond which no arm that somebody uses has them."""

    expansion_per_k: float = constant(
        1e-4,
        "growth of a link",
        "convention: steel 12, aluminium 23, plastics 50-100 millionths per kelvin",
        unit="1/K",
    )
    wave_rad: float = constant(
        3e-3,
        "amplitude of a gear's or encoder's wave",
        "judgement: makers state one to two minutes of arc from peak to peak for gears of robots, worm gears have ten",
        unit="rad",
    )
    play_rad: float = constant(
        1e-2, "play of a drive", "judgement: a worn gear's half a degree; one could shake the arm by hand", unit="rad"
    )
    scale: float = constant(
        3e-3,
        "error of an instrument's lengths",
        "judgement: refraction and temperature stated wrong by tens of kelvins make 0.03 %, camera targets cut to a "
        "tenth of a millimetre in a hand's breadth 0.1 %",
        unit="m/m",
    )

    @property
    def of(self) -> dict[str, tuple[str, float, str]]:
        """By effect: the parameter that is limited, its largest size, and the unit."""
        return {
            "thermal_expansion": ("coefficient", self.expansion_per_k, "1/K"),
            "gear_eccentricity": ("amplitude", self.wave_rad, "rad"),
            "gear_mesh": ("amplitude", self.wave_rad, "rad"),
            "backlash": ("gap", self.play_rad, "rad"),
            "instrument_scale": ("scale", self.scale, "m/m"),
        }


LARGEST = LargestErrors()
