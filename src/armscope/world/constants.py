"""Sizes that rough arms are drawn from (`armscope.world.rough`), all assumptions; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants, constant

Pair = tuple[float, float]


@dataclass(frozen=True)
class RoughSizes(Constants):
    """How rough arms are: assumptions. A pair is drawn between evenly on a logarithmic scale."""

    mass_share: tuple[float, float] = constant(
        (0.1, 0.3),
        "by which a link's stated mass is off, either way",
        "judgement: identified masses differ from the makers' by that: cables, grease and covers are in no drawing",
    )
    payload_share: tuple[float, float] = constant(
        (0.05, 0.25),
        "by which payloads are stated wrong, either way",
        "judgement: tool data are typed in by hand, and hoses hang on the tool",
    )
    drive_rad: tuple[float, float] = constant(
        (3e-5, 1.5e-4),
        "turn of a drive under its largest load, beyond what the controller takes out",
        "judgement: gears wind up by a milliradian at rated torque, of which a controller's model leaves a tenth",
        unit="rad",
    )
    softness: tuple[float, float] = constant(
        (0.1, 0.5),
        "share of that turn that comes on top up to the knee: what gives way hardens",
        "convention: makers of strain-wave gears state three stiffnesses, the first 1.3 to 2 times below the last",
    )
    knee_share: tuple[float, float] = constant(
        (0.05, 0.3),
        "of its largest load at which a drive hardens",
        "convention: makers of strain-wave gears state their first section up to a seventh or a third of the rated "
        "torque; arms load a drive less or more than that",
    )
    bearing_rad: tuple[float, float] = constant(
        (1e-5, 5e-5),
        "tilt of a bearing, and turn of a link's end, under the arm's largest moment",
        "judgement: a third of a drive's",
        unit="rad",
    )
    pedestal_rad: tuple[float, float] = constant(
        (2e-5, 1e-4),
        "tilt of the pedestal about its softer axis, under the largest moment",
        "judgement: anchors and a welded column give as much as a bearing, or twice",
        unit="rad",
    )
    bearing_ratio: tuple[float, float] = constant(
        (1.0, 3.0),
        "how much softer a bearing is about one axis than about the other",
        "judgement: its seat is a casting, ribbed on one side and open on the other",
    )
    pedestal_ratio: tuple[float, float] = constant(
        (1.5, 8.0),
        "how much softer it is about one axis than across",
        "judgement: columns are as broad as long, machine beds and wall brackets are not",
    )
    rocker_share: tuple[float, float] = constant(
        (0.26, 0.4), "length of crank and rocker over the upper arm's", "convention: as on palletising arms"
    )
    bar_m: tuple[float, float] = constant(
        (5e-5, 4e-4), "error of a bar's length", "judgement: bored to a tenth of a millimetre, and worn", unit="m"
    )
    gear_rad: tuple[float, float] = constant(
        (2e-5, 8e-5),
        "RMS of all waves of a gear",
        "convention: makers of strain-wave and cycloidal gears state 1 to 2 minutes of arc from peak to peak",
        unit="rad",
    )
    gear_slope: tuple[float, float] = constant(
        (0.6, 1.4),
        "power of the number of waves by which their spectrum falls",
        "judgement: between a sharp tooth's and a smooth cam's",
    )
    gear_waves: int = constant(
        60,
        "waves per turn up to which there are any, two thirds of them",
        "judgement: stages of one gear, and their sums and differences",
        unit="1/turn",
    )
    line_rad: tuple[float, float] = constant(
        (1e-5, 5e-5),
        "amplitude of a strain-wave gear's own line",
        "judgement: a third of the stated error; the line is what is heard",
        unit="rad",
    )
    lines: tuple[float, float] = constant(
        (100.0, 200.0), "its waves per turn", "derived: two per turn of the motor at 50:1 to 100:1", unit="1/turn"
    )
    length_m: tuple[float, float] = constant(
        (3e-5, 3e-4),
        "one sigma of D-H lengths; of angles and zeros the same per metre",
        "judgement: from what a calibration leaves to what machining leaves",
        unit="m",
    )
    row_m: tuple[float, float] = constant(
        (0.01, 0.06),
        "offset that is stated on the next D-H row, as after reading the other convention",
        "judgement: offsets of elbows and wrists",
        unit="m",
    )
    wander_m: tuple[float, float] = constant(
        (5e-6, 3e-5),
        "RMS of the set-up's wander in a session; turns the same per 2 m",
        "judgement: trackers on tripods, and floors, in half a day",
        unit="m",
    )
    run_m: tuple[float, float] = constant(
        (1e-5, 5e-5),
        "one sigma by which the base stands elsewhere from run to run; turns the same per 2 m",
        "judgement: a tracker's new start",
        unit="m",
    )
    play_rad: tuple[float, float] = constant(
        (1e-5, 8e-5), "play of a gear", "convention: low-play gears are sold with less than a minute of arc", unit="rad"
    )
    growth_per_k: tuple[float, float] = constant(
        (8e-6, 24e-6), "growth of a link", "convention: steel and aluminium", unit="1/K"
    )
    lag_s: tuple[float, float] = constant(
        (1800.0, 7200.0), "by which links follow the hall", "judgement: castings of 10 to 300 kg", unit="s"
    )
    day_k: float = constant(
        4.0,
        "least swing of the hall where there is a day, at most twice",
        "judgement: a hall without air conditioning",
        unit="K",
    )
    freedom: int = constant(4, "degrees of freedom of a rough instrument's t", "judgement: between bad shots and none")
    radial: float = constant(
        0.4, "its noise along the line of sight over that across", "convention: interferometer beside two encoders"
    )
    distance_m: float = constant(4.0, "from the arm to it", "judgement: out of reach, as near as that allows", unit="m")


ROUGH = RoughSizes()
