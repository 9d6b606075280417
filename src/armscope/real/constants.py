"""Numbers that decide in this room; see `armscope.core.constants`.

`LargestErrors` is what real arms can have: whoever conceals errors in their recordings takes none beyond it. None of it
is known to the diagnosis, whose own idea of plausible sizes is in `armscope.physics.constants`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.constants import Constants


@dataclass(frozen=True)
class LargestErrors(Constants):
    """Sizes beyond which no arm that somebody uses has them."""

    expansion_per_k: float = 1e-4
    """growth of a link [1/K]; convention: steel 12, aluminium 23, plastics 50-100 millionths per kelvin"""
    wave_rad: float = 3e-3
    """amplitude of a gear's or encoder's wave [rad]; judgement: makers state one to two minutes of arc from peak to
    peak for gears of robots, worm gears have ten"""
    play_rad: float = 1e-2
    """play of a drive [rad]; judgement: a worn gear's half a degree; one could shake the arm by hand"""
    scale: float = 3e-3
    """error of an instrument's lengths [m/m]; judgement: refraction and temperature stated wrong by tens of kelvins
    make 0.03 %, camera targets cut to a tenth of a millimetre in a hand's breadth 0.1 %"""

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


@dataclass(frozen=True)
class ConcealingRules(Constants):
    """Where an effect is concealed in real recordings, what is made up beside them, and when it counts as found."""

    moves_rad: float = 0.05
    """span of a joint's angles below which it cannot show what follows its angle [rad]; judgement: three degrees of a
    wave are a slope"""
    rounds: int = 3
    """of scaling an effect to its size; judgement: nearly linear, so that the second hardly changes it"""
    tries: int = 4
    """places among which that with the fewest alternatives is taken [places]; judgement: time"""
    unmoved_m: float = 1e-9
    """RMS at the tool below which an effect moves nothing [m]; derived: far above rounding"""
    swing_k: float = 8.0
    """span of the made-up temperature [K]; judgement: of a hall between morning and noon"""
    coolest_c: float = 20.0
    """lowest of it [degrees C]; convention: lengths of robot.yaml hold at 20 degrees C"""
    swings: float = 1.3
    """waves of it over the recording; judgement: more than one, so that it is no drift in the order of rows"""
    stopped_rad: float = 1e-6
    """between two configurations, within which a joint stood still and keeps its side of approach [rad]; judgement:
    below what encoders tell"""
    changed: float = 0.5
    """share of a concealed size by which a name that the original has, too, must change; judgement: the half"""


@dataclass(frozen=True)
class ReferenceProtocol(Constants):
    """How runs are held out where others' figures stand beside."""

    splits: int = 5
    """of a run into training and test rows, where no other number is stated [splits]; judgement: time"""
    curve_splits: tuple[int, ...] = (0, 1, 2)
    """seeds of those in which curves learned elsewhere are compared; judgement: time"""
    curve_rows: int = 3000
    """to train on in them [rows]; judgement: time"""


@dataclass(frozen=True)
class ComplianceRules(Constants):
    """How compliances of runs are fitted, told and compared."""

    prior_rad_nm: float = 1e-4
    """standard deviation of every drive's and bearing's compliance [rad/(N m)]; judgement: 10 N m turn it by a
    milliradian; drives of arms of this size give a few times less"""
    waves: tuple[int, ...] = (1, 2, 3, 4)
    """of angle errors that are allowed for [per turn]; judgement: eccentric discs and flexible splines"""
    wave_rad: float = 1e-4
    """standard deviation of each, and of an axis' direction, once and twice per turn [rad]; judgement: a tenth of what
    geometry may be off"""
    blocks: int = 20
    """of consecutive rows, of which intervals are made [blocks]; judgement: enough to tell a variance, and each long
    beside what hangs together"""
    unseen: float = 1e-4
    """share of the strongest by which combinations of mass moments must load joints; judgement: recorded torques err by
    more"""
    steps: int = 8
    """of Gauss-Newton [steps]; judgement: more than it takes"""
    negligible: float = 1e-3
    """share of what noise leaves uncertain by which residuals move in the last step; judgement: nobody sees it"""
    determined: float = 0.5
    """share of the prior below which what two runs together leave uncertain must be, to compare them in it; judgement:
    the half; with more the prior would agree with itself"""
    sure: float = 0.95
    """of an interval; convention"""
    told: float = 0.15
    """weight, of the largest, from which a compliance is named in a combination; judgement: its square is 2 %"""
    agrees: float = 0.05
    """probability below which runs disagree; convention"""


@dataclass(frozen=True)
class CurveComparison(Constants):
    """When two runs tell the same curve of a joint."""

    step_rad: float = float(np.radians(0.5))
    """between angles at which curves are compared [rad]; judgement: finer than any curve's waves"""
    no_turn_rad: float = 1e-12
    """below which curves turn nothing [rad]; derived: rounding"""
    common_rad: float = float(np.radians(30.0))
    """known by both, below which curves are not compared [rad]; judgement: less says little without its slow part"""
    known: float = 0.5
    """share of a curve's standard deviation below which its standard error must be; judgement: the half"""
    slow_degree: int = 3
    """of the polynomial of the angle that is taken off first; judgement: up to about it geometry and the rest of a
    curve imitate each other"""


@dataclass(frozen=True)
class DrawnArms(Constants):
    """The simulated arms on which the comparison of compliances is tried; all of it is made up."""

    drives_rad_nm: tuple[float, float] = (2e-5, 1e-4)
    """between which drives' compliances are drawn [rad/(N m)]; judgement: of arms of this size"""
    bearings_rad_nm: tuple[float, float] = (0.0, 5e-5)
    """the same of bearings [rad/(N m)]; judgement: half of what drives give"""
    geometry: float = 5e-4
    """standard deviation of geometry [m or rad]; judgement: half a millimetre or milliradian"""
    wave_rad: float = 1e-4
    """the same of waves once and twice per turn [rad]; judgement: as the comparison's model has them"""
    wobble_rad: float = 5e-5
    """the same of axes that wobble [rad]; judgement: half of it"""
    mesh_rad: float = 4e-5
    """the same of a gear's mesh, which the model lacks [rad]; judgement: a seventh of a minute of arc"""
    mesh_waves: tuple[int, int] = (5, 20)
    """from which and below which its waves are drawn [per turn]; judgement: beyond the model's four"""
    dragged: float = 5e-5
    """the same of joints that drag others along [rad/rad]; judgement: a twentieth of a milliradian per radian"""
    dragging: float = 0.1
    """share of the pairs of joints that do; judgement: few"""
    gap_rad: float = 1e-4
    """largest lost motion [rad]; judgement: a third of a minute of arc"""
    bend: float = 4e-5
    """largest that links bend [1/(N m2)]; judgement: less than a bearing's tilt"""
    base_rad_nm: float = 5e-6
    """largest compliance of the base [rad/(N m)]; judgement: a tenth of a bearing's"""
    point_mm: float = 0.08
    """noise of points per axis [mm]; judgement: of a good camera or a tracker in a hall"""
    turn_mrad: float = 0.8
    """noise of orientations about each axis [mrad]; judgement: the points' noise, 0.1 m apart"""
    bad_shots: float = 0.01
    """share of rows that are bad shots; judgement: as tables have"""
    far_mm: float = 1.0
    """noise of their points [mm]; judgement: over ten times the others'"""


LARGEST = LargestErrors()
CONCEALING, PROTOCOL, COMPLIANCE = ConcealingRules(), ReferenceProtocol(), ComplianceRules()
CURVES, DRAWN = CurveComparison(), DrawnArms()
