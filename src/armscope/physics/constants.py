"""Numbers that decide in this room; see `armscope.core.constants`.

How large each kind of error is on real arms: one standard deviation of what is believed before the rows speak. The
data move any value beyond it where they know better; where they know nothing, a value stays this small and is said to
be undetermined.
"""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class PlausibleSizes(Constants):
    """How large errors of an arm are that somebody built, mastered and uses."""

    length_m: float = 3e-3
    """error of a link's length [m]; judgement: castings are machined to 0.1-1 mm; a stated row that is another model's
    is off by more"""
    twist_rad: float = 10e-3
    """error of a link's twist [rad]; judgement: ten times a millimetre per metre, which makers keep"""
    zero_rad: float = 20e-3
    """error of an encoder's zero [rad]; judgement: a joint mastered by eye is off by a degree, by gauge by a tenth of
    it"""
    bar_m: float = 3e-3
    """error of a parallelogram's bar [m]; judgement: as of a link's length"""
    bar_share: float = 0.01
    """the same as a share of the rocker, where the bars are not stated; derived: 3 mm of the 0.3 m rocker of a
    middle-sized arm"""
    ratio: float = 5e-3
    """error of a gear's ratio, and one joint's share in another's turn; judgement: ratios are counted in teeth; wrong
    parameters of a belt or wrist are some thousandths"""
    eccentricity_rad: float = 3e-3
    """one or two waves per turn of a gear or encoder [rad]; judgement: a disc off centre by 0.1 mm at 33 mm"""
    waves: int = 8
    """per turn of a gear up to which every arm has a little [waves]; judgement: seen with bench cases in view; flexible
    splines and discs show the first harmonics of two per turn; time"""
    fine_waves: int = 30
    """the same once the arm is known to have them [waves]; judgement: seen with bench cases in view; finer ones are
    lines of single stages, which are scanned; time"""
    finest_waves: int = 60
    """the same in the last fit, whose names are settled [waves]; judgement: time; what is finer still has a hundredth
    of the power where waves fall with their number; the proof's rough gears have sixty, too"""
    mesh_rad: float = 1e-3
    """more waves per turn [rad]; convention: makers of strain wave and cycloidal gears state one to three minutes of
    arc"""
    play_rad: float = 3e-3
    """backlash [rad]; convention: makers state one to three minutes of arc; worn gears have ten"""
    wobble_rad: float = 3e-3
    """tilt of a turning axis [rad]; judgement: 0.1 mm run-out at 33 mm"""
    run_out_m: float = 1e-3
    """by which a turning axis moves across [m]; judgement: a tilt of a milliradian about a point that is a metre from
    the row's origin"""
    drive_rad: float = 5e-3
    """a drive's turn under its largest load [rad]; judgement: strain wave gears wind up by a milliradian at their rated
    torque, soft belts by several"""
    softening_share: float = 0.3
    """of a drive's turn, by which it turns further when it is warm or has worked loose; judgement: belts and rubber
    soften by several percent per kelvin, steel by less than a thousandth"""
    soft_share: float = 0.1
    """of a drive's turn, by which it turns further since it is softer under small loads; derived: makers of strain wave
    gears state a first stiffness K1, up to a torque T1 of a tenth or a fifth of the rated T, that is a half to two
    thirds of the last, K3; (1/K1 - 1/K3) T1 is 0.05 to 0.2 of T/K3"""
    knee_share: float = 0.1
    """of a drive's largest load, at which that turn is mostly complete; convention: the first section of the makers
    ends at a tenth to a fifth of the rated torque"""
    bearing_rad: float = 2e-3
    """tilt of a bearing or of the base under its largest moment [rad]; judgement: half of what a drive gives"""
    foot_m: float = 1.0
    """by which a base's origin is above the foot about which it tilts [m]; judgement: a pedestal"""
    beam_rad: float = 2e-3
    """turn of a link's end, fully loaded [rad]; judgement: a bearing's"""
    loose_target_m: float = 5e-4
    """by which a target falls [m]; judgement: a nest's clearance"""
    delay_s: float = 0.05
    """between command and motion [s]; judgement: some cycles of a controller"""
    expansion_per_k: float = 30e-6
    """growth of a link [1/K]; convention: steel 11-12, aluminium 23-24 millionths per kelvin"""
    uneven_expansion_per_k: float = 10e-6
    """by which a link's growth differs from the other links' [1/K]; derived: half of what lies between steel and
    aluminium, 6 millionths per kelvin, and that one link is warmer than another"""
    warm_rad_per_k: float = 1e-4
    """turn of a link or a zero [rad/K]; judgement: one side is warmer"""
    set_within_k: float = 15.0
    """of 20 degrees is an arm whose zeros somebody sets [K]; judgement: a workshop has 5 to 35 degrees"""
    growth: float = 1.0e-4
    """by which links grow or shrink in a session, as a share of their length [m/m]; derived: steel or aluminium, 12 to
    24 millionths per K, some 4 to 8 K between morning and noon; chosen with rough worlds in view"""
    scale: float = 1e-3
    """error of the instrument's lengths [m/m]; judgement: a wrong unit of temperature or prism makes 0.1 %"""
    mass_share: float = 0.1
    """error of a link's stated mass as a share of it; judgement: identified masses differ from the makers' by 10-30 %:
    cables, grease and covers are not in the drawing; at 0.2 a factor common to all masses passes for a payload's"""
    common_mass_share: float = 0.03
    """error of all links' stated masses alike, as a share of them; judgement: cables, covers and grease are in the
    drawing of no link; at 0.05 a payload wrong by 36 % lost its name to lighter links"""
    weighed_share: float = 0.05
    """error of a payload's stated mass that deserves no name, as a share of it; judgement: with rough worlds in view; a
    gripper is weighed once, cables and grease are not; at 0.1 a payload wrong by 36 % lost its name"""
    payload_share: float = 0.5
    """error of a payload's mass as a share of the largest stated; judgement: a gripper that was forgotten"""
    payload_centre_m: float = 0.2
    """error of a payload's centre of mass [m]; judgement: two hands' widths; nobody states where it is"""
    learned_within: float = 3.0
    """times a plausible size, within which arms of the same type may move it; judgement: an arm unlike its fleet must
    still be seen; half a decade either way"""
    beyond: float = 3.0
    """times a plausible size, beyond which a value is no answer: the columns stand for something else; convention:
    three standard deviations"""
    wander_m: float = 3e-4
    """by which base and instrument wander in a session, and settle between its runs [m]; derived: 3 m of steel or
    stone, 12 millionths per K, some 8 K between morning and noon"""
    wander_rad: float = 1e-4
    """by which they lean meanwhile [rad]; derived: that over 3 m"""
    orientation_rad: float = 1e-3
    """by which what shows the tool's orientation errs, about each axis, as it is seen from other sides [rad];
    judgement: spheres 0.1 m apart, one of them seen 0.1 mm elsewhere; one real arm with a marker was in view"""


PLAUSIBLE = PlausibleSizes()
