"""Numbers that decide in this room; see `armscope.core.constants`.

`LargestErrors` is what real arms can have: whoever conceals errors in their recordings takes none beyond it. None of it
is known to the diagnosis, whose own idea of plausible sizes is in `armscope.physics.constants`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

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


@dataclass(frozen=True)
class ConcealingRules(Constants):
    """Where an effect is concealed in real recordings, what is made up beside them, and when it counts as found."""

    moves_rad: float = constant(
        0.05,
        "span of a joint's angles below which it cannot show what follows its angle",
        "judgement: three degrees of a wave are a slope",
        unit="rad",
    )
    rounds: int = constant(
        3, "of scaling an effect to its size", "judgement: nearly linear, so that the second hardly changes it"
    )
    tries: int = constant(
        4, "places among which that with the fewest alternatives is taken", "judgement: time", unit="places"
    )
    unmoved_m: float = constant(
        1e-9, "RMS at the tool below which an effect moves nothing", "derived: far above rounding", unit="m"
    )
    swing_k: float = constant(
        8.0, "span of the made-up temperature", "judgement: of a hall between morning and noon", unit="K"
    )
    coolest_c: float = constant(
        20.0, "lowest of it", "convention: lengths of robot.yaml hold at 20 degrees C", unit="degrees C"
    )
    swings: float = constant(
        1.3, "waves of it over the recording", "judgement: more than one, so that it is no drift in the order of rows"
    )
    stopped_rad: float = constant(
        1e-6,
        "between two configurations, within which a joint stood still and keeps its side of approach",
        "judgement: below what encoders tell",
        unit="rad",
    )
    changed: float = constant(
        0.5,
        "share of a concealed size by which a name that the original has, too, must change",
        "judgement: the half",
    )


@dataclass(frozen=True)
class ReferenceProtocol(Constants):
    """How runs are held out where others' figures stand beside."""

    splits: int = constant(
        5, "of a run into training and test rows, where no other number is stated", "judgement: time", unit="splits"
    )
    curve_splits: tuple[int, ...] = constant(
        (0, 1, 2), "seeds of those in which curves learned elsewhere are compared", "judgement: time"
    )
    curve_rows: int = constant(3000, "to train on in them", "judgement: time", unit="rows")


@dataclass(frozen=True)
class ComplianceRules(Constants):
    """How compliances of runs are fitted, told and compared."""

    prior_rad_nm: float = constant(
        1e-4,
        "standard deviation of every drive's and bearing's compliance",
        "judgement: 10 N m turn it by a milliradian; drives of arms of this size give a few times less",
        unit="rad/(N m)",
    )
    waves: tuple[int, ...] = constant(
        (1, 2, 3, 4),
        "of angle errors that are allowed for",
        "judgement: eccentric discs and flexible splines",
        unit="per turn",
    )
    wave_rad: float = constant(
        1e-4,
        "standard deviation of each, and of an axis' direction, once and twice per turn",
        "judgement: a tenth of what geometry may be off",
        unit="rad",
    )
    blocks: int = constant(
        20,
        "of consecutive rows, of which intervals are made",
        "judgement: enough to tell a variance, and each long beside what hangs together",
        unit="blocks",
    )
    unseen: float = constant(
        1e-4,
        "share of the strongest by which combinations of mass moments must load joints",
        "judgement: recorded torques err by more",
    )
    steps: int = constant(8, "of Gauss-Newton", "judgement: more than it takes", unit="steps")
    negligible: float = constant(
        1e-3,
        "share of what noise leaves uncertain by which residuals move in the last step",
        "judgement: nobody sees it",
    )
    determined: float = constant(
        0.5,
        "share of the prior below which what two runs together leave uncertain must be, to compare them in it",
        "judgement: the half; with more the prior would agree with itself",
    )
    sure: float = constant(0.95, "of an interval", "convention")
    told: float = constant(
        0.15,
        "weight, of the largest, from which a compliance is named in a combination",
        "judgement: its square is 2 %",
    )
    agrees: float = constant(0.05, "probability below which runs disagree", "convention")


@dataclass(frozen=True)
class CurveComparison(Constants):
    """When two runs tell the same curve of a joint."""

    step_rad: float = constant(
        float(np.radians(0.5)),
        "between angles at which curves are compared",
        "judgement: finer than any curve's waves",
        unit="rad",
    )
    no_turn_rad: float = constant(1e-12, "below which curves turn nothing", "derived: rounding", unit="rad")
    common_rad: float = constant(
        float(np.radians(30.0)),
        "known by both, below which curves are not compared",
        "judgement: less says little without its slow part",
        unit="rad",
    )
    known: float = constant(
        0.5,
        "share of a curve's standard deviation below which its standard error must be",
        "judgement: the half",
    )
    slow_degree: int = constant(
        3,
        "of the polynomial of the angle that is taken off first",
        "judgement: up to about it geometry and the rest of a curve imitate each other",
    )


@dataclass(frozen=True)
class DrawnArms(Constants):
    """The simulated arms on which the comparison of compliances is tried; all of it is made up."""

    drives_rad_nm: tuple[float, float] = constant(
        (2e-5, 1e-4), "between which drives' compliances are drawn", "judgement: of arms of this size", unit="rad/(N m)"
    )
    bearings_rad_nm: tuple[float, float] = constant(
        (0.0, 5e-5), "the same of bearings", "judgement: half of what drives give", unit="rad/(N m)"
    )
    geometry: float = constant(
        5e-4, "standard deviation of geometry", "judgement: half a millimetre or milliradian", unit="m or rad"
    )
    wave_rad: float = constant(
        1e-4, "the same of waves once and twice per turn", "judgement: as the comparison's model has them", unit="rad"
    )
    wobble_rad: float = constant(5e-5, "the same of axes that wobble", "judgement: half of it", unit="rad")
    mesh_rad: float = constant(
        4e-5, "the same of a gear's mesh, which the model lacks", "judgement: a seventh of a minute of arc", unit="rad"
    )
    mesh_waves: tuple[int, int] = constant(
        (5, 20), "from which and below which its waves are drawn", "judgement: beyond the model's four", unit="per turn"
    )
    dragged: float = constant(
        5e-5,
        "the same of joints that drag others along",
        "judgement: a twentieth of a milliradian per radian",
        unit="rad/rad",
    )
    dragging: float = constant(0.1, "share of the pairs of joints that do", "judgement: few")
    gap_rad: float = constant(1e-4, "largest lost motion", "judgement: a third of a minute of arc", unit="rad")
    bend: float = constant(4e-5, "largest that links bend", "judgement: less than a bearing's tilt", unit="1/(N m2)")
    base_rad_nm: float = constant(
        5e-6, "largest compliance of the base", "judgement: a tenth of a bearing's", unit="rad/(N m)"
    )
    point_mm: float = constant(
        0.08, "noise of points per axis", "judgement: of a good camera or a tracker in a hall", unit="mm"
    )
    turn_mrad: float = constant(
        0.8, "noise of orientations about each axis", "judgement: the points' noise, 0.1 m apart", unit="mrad"
    )
    bad_shots: float = constant(0.01, "share of rows that are bad shots", "judgement: as tables have")
    far_mm: float = constant(1.0, "noise of their points", "judgement: over ten times the others'", unit="mm")


LARGEST = LargestErrors()
CONCEALING, PROTOCOL, COMPLIANCE = ConcealingRules(), ReferenceProtocol(), ComplianceRules()
CURVES, DRAWN = CurveComparison(), DrawnArms()
