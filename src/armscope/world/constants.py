"""Sizes that rough arms are drawn from (`armscope.world.rough`), all assumptions; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants

Pair = tuple[float, float]


@dataclass(frozen=True)
class RoughSizes(Constants):
    """How rough arms are: assumptions. A pair is drawn between evenly on a logarithmic scale."""

    mass_share: tuple[float, float] = (0.1, 0.3)
    """by which a link's stated mass is off, either way; judgement: identified masses differ from the makers' by that:
    cables, grease and covers are in no drawing"""
    payload_share: tuple[float, float] = (0.05, 0.25)
    """by which payloads are stated wrong, either way; judgement: tool data are typed in by hand, and hoses hang on the
    tool"""
    drive_rad: tuple[float, float] = (3e-5, 1.5e-4)
    """turn of a drive under its largest load, beyond what the controller takes out [rad]; judgement: gears wind up by a
    milliradian at rated torque, of which a controller's model leaves a tenth"""
    softness: tuple[float, float] = (0.1, 0.5)
    """share of that turn that comes on top up to the knee: what gives way hardens; convention: makers of strain-wave
    gears state three stiffnesses, the first 1.3 to 2 times below the last"""
    knee_share: tuple[float, float] = (0.05, 0.3)
    """of its largest load at which a drive hardens; convention: makers of strain-wave gears state their first section
    up to a seventh or a third of the rated torque; arms load a drive less or more than that"""
    bearing_rad: tuple[float, float] = (1e-5, 5e-5)
    """tilt of a bearing, and turn of a link's end, under the arm's largest moment [rad]; judgement: a third of a
    drive's"""
    pedestal_rad: tuple[float, float] = (2e-5, 1e-4)
    """tilt of the pedestal about its softer axis, under the largest moment [rad]; judgement: anchors and a welded
    column give as much as a bearing, or twice"""
    bearing_ratio: tuple[float, float] = (1.0, 3.0)
    """how much softer a bearing is about one axis than about the other; judgement: its seat is a casting, ribbed on one
    side and open on the other"""
    pedestal_ratio: tuple[float, float] = (1.5, 8.0)
    """how much softer it is about one axis than across; judgement: columns are as broad as long, machine beds and wall
    brackets are not"""
    rocker_share: tuple[float, float] = (0.26, 0.4)
    """length of crank and rocker over the upper arm's; convention: as on palletising arms"""
    bar_m: tuple[float, float] = (5e-5, 4e-4)
    """error of a bar's length [m]; judgement: bored to a tenth of a millimetre, and worn"""
    gear_rad: tuple[float, float] = (2e-5, 8e-5)
    """RMS of all waves of a gear [rad]; convention: makers of strain-wave and cycloidal gears state 1 to 2 minutes of
    arc from peak to peak"""
    gear_slope: tuple[float, float] = (0.6, 1.4)
    """power of the number of waves by which their spectrum falls; judgement: between a sharp tooth's and a smooth
    cam's"""
    gear_waves: int = 60
    """waves per turn up to which there are any, two thirds of them [1/turn]; judgement: stages of one gear, and their
    sums and differences"""
    line_rad: tuple[float, float] = (1e-5, 5e-5)
    """amplitude of a strain-wave gear's own line [rad]; judgement: a third of the stated error; the line is what is
    heard"""
    lines: tuple[float, float] = (100.0, 200.0)
    """its waves per turn [1/turn]; derived: two per turn of the motor at 50:1 to 100:1"""
    length_m: tuple[float, float] = (3e-5, 3e-4)
    """one sigma of D-H lengths; of angles and zeros the same per metre [m]; judgement: from what a calibration leaves
    to what machining leaves"""
    row_m: tuple[float, float] = (0.01, 0.06)
    """offset that is stated on the next D-H row, as after reading the other convention [m]; judgement: offsets of
    elbows and wrists"""
    wander_m: tuple[float, float] = (5e-6, 3e-5)
    """RMS of the set-up's wander in a session; turns the same per 2 m [m]; judgement: trackers on tripods, and floors,
    in half a day"""
    run_m: tuple[float, float] = (1e-5, 5e-5)
    """one sigma by which the base stands elsewhere from run to run; turns the same per 2 m [m]; judgement: a tracker's
    new start"""
    play_rad: tuple[float, float] = (1e-5, 8e-5)
    """play of a gear [rad]; convention: low-play gears are sold with less than a minute of arc"""
    growth_per_k: tuple[float, float] = (8e-6, 24e-6)
    """growth of a link [1/K]; convention: steel and aluminium"""
    lag_s: tuple[float, float] = (1800.0, 7200.0)
    """by which links follow the hall [s]; judgement: castings of 10 to 300 kg"""
    day_k: float = 4.0
    """least swing of the hall where there is a day, at most twice [K]; judgement: a hall without air conditioning"""
    freedom: int = 4
    """degrees of freedom of a rough instrument's t; judgement: between bad shots and none"""
    radial: float = 0.4
    """its noise along the line of sight over that across; convention: interferometer beside two encoders"""
    distance_m: float = 4.0
    """from the arm to it [m]; judgement: out of reach, as near as that allows"""


ROUGH = RoughSizes()
