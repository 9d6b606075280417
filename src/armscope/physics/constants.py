"""Numbers that decide in this room; see `armscope.core.constants`.

How large each kind of error is on real arms: one standard deviation of what is believed before the rows speak. The
data move any value beyond it where they know better; where they know nothing, a value stays this small and is said to
be undetermined.
"""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants, constant


@dataclass(frozen=True)
class PlausibleSizes(Constants):
    """How large errors of an arm are that somebody built, mastered and uses."""

    length_m: float = constant(
        3e-3,
        "error of a link's length",
        "judgement: castings are machined to 0.1-1 mm; a stated row that is another model's is off by more",
        unit="m",
    )
    twist_rad: float = constant(
        10e-3, "error of a link's twist", "judgement: ten times a millimetre per metre, which makers keep", unit="rad"
    )
    zero_rad: float = constant(
        20e-3,
        "error of an encoder's zero",
        "judgement: a joint mastered by eye is off by a degree, by gauge by a tenth of it",
        unit="rad",
    )
    bar_m: float = constant(3e-3, "error of a parallelogram's bar", "judgement: as of a link's length", unit="m")
    bar_share: float = constant(
        0.01,
        "the same as a share of the rocker, where the bars are not stated",
        "derived: 3 mm of the 0.3 m rocker of a middle-sized arm",
    )
    ratio: float = constant(
        5e-3,
        "error of a gear's ratio, and one joint's share in another's turn",
        "judgement: ratios are counted in teeth; wrong parameters of a belt or wrist are some thousandths",
    )
    eccentricity_rad: float = constant(
        3e-3,
        "one or two waves per turn of a gear or encoder",
        "judgement: a disc off centre by 0.1 mm at 33 mm",
        unit="rad",
    )
    waves: int = constant(
        8,
        "per turn of a gear up to which every arm has a little",
        "judgement: seen with bench cases in view; flexible splines and discs show the first harmonics of two per "
        "turn; time",
        unit="waves",
    )
    fine_waves: int = constant(
        30,
        "the same once the arm is known to have them",
        "judgement: seen with bench cases in view; finer ones are lines of single stages, which are scanned; time",
        unit="waves",
    )
    finest_waves: int = constant(
        60,
        "the same in the last fit, whose names are settled",
        "judgement: time; what is finer still has a hundredth of the power where waves fall with their number; the "
        "proof's rough gears have sixty, too",
        unit="waves",
    )
    mesh_rad: float = constant(
        1e-3,
        "more waves per turn",
        "convention: makers of strain wave and cycloidal gears state one to three minutes of arc",
        unit="rad",
    )
    play_rad: float = constant(
        3e-3, "backlash", "convention: makers state one to three minutes of arc; worn gears have ten", unit="rad"
    )
    wobble_rad: float = constant(3e-3, "tilt of a turning axis", "judgement: 0.1 mm run-out at 33 mm", unit="rad")
    drive_rad: float = constant(
        5e-3,
        "a drive's turn under its largest load",
        "judgement: strain wave gears wind up by a milliradian at their rated torque, soft belts by several",
        unit="rad",
    )
    soft_share: float = constant(
        0.1,
        "of a drive's turn, by which it turns further since it is softer under small loads",
        "derived: makers of strain wave gears state a first stiffness K1, up to a torque T1 of a tenth or a fifth of "
        "the rated T, that is a half to two thirds of the last, K3; (1/K1 - 1/K3) T1 is 0.05 to 0.2 of T/K3",
    )
    knee_share: float = constant(
        0.1,
        "of a drive's largest load, at which that turn is mostly complete",
        "convention: the first section of the makers ends at a tenth to a fifth of the rated torque",
    )
    bearing_rad: float = constant(
        2e-3,
        "tilt of a bearing or of the base under its largest moment",
        "judgement: half of what a drive gives",
        unit="rad",
    )
    beam_rad: float = constant(2e-3, "turn of a link's end, fully loaded", "judgement: a bearing's", unit="rad")
    loose_target_m: float = constant(5e-4, "by which a target falls", "judgement: a nest's clearance", unit="m")
    delay_s: float = constant(0.05, "between command and motion", "judgement: some cycles of a controller", unit="s")
    expansion_per_k: float = constant(
        30e-6, "growth of a link", "convention: steel 11-12, aluminium 23-24 millionths per kelvin", unit="1/K"
    )
    uneven_expansion_per_k: float = constant(
        10e-6,
        "by which a link's growth differs from the other links'",
        "derived: half of what lies between steel and aluminium, 6 millionths per kelvin, and that one link is warmer "
        "than another",
        unit="1/K",
    )
    warm_rad_per_k: float = constant(1e-4, "turn of a link or a zero", "judgement: one side is warmer", unit="rad/K")
    growth: float = constant(
        1.0e-4,
        "by which links grow or shrink in a session, as a share of their length",
        "derived: steel or aluminium, 12 to 24 millionths per K, some 4 to 8 K between morning and noon; chosen with "
        "rough worlds in view",
        unit="m/m",
    )
    scale: float = constant(
        1e-3,
        "error of the instrument's lengths",
        "judgement: a wrong unit of temperature or prism makes 0.1 %",
        unit="m/m",
    )
    mass_share: float = constant(
        0.1,
        "error of a link's stated mass as a share of it",
        "judgement: identified masses differ from the makers' by 10-30 %: cables, grease and covers are not in the "
        "drawing; at 0.2 a factor common to all masses passes for a payload's",
    )
    common_mass_share: float = constant(
        0.03,
        "error of all links' stated masses alike, as a share of them",
        "judgement: cables, covers and grease are in the drawing of no link; at 0.05 a payload wrong by 36 % lost its "
        "name to lighter links",
    )
    weighed_share: float = constant(
        0.05,
        "error of a payload's stated mass that deserves no name, as a share of it",
        "judgement: with rough worlds in view; a gripper is weighed once, cables and grease are not; at 0.1 a payload "
        "wrong by 36 % lost its name",
    )
    payload_share: float = constant(
        0.5, "error of a payload's mass as a share of the largest stated", "judgement: a gripper that was forgotten"
    )
    payload_centre_m: float = constant(
        0.2, "error of a payload's centre of mass", "judgement: two hands' widths; nobody states where it is", unit="m"
    )
    learned_within: float = constant(
        3.0,
        "times a plausible size, within which arms of the same type may move it",
        "judgement: an arm unlike its fleet must still be seen; half a decade either way",
    )
    beyond: float = constant(
        3.0,
        "times a plausible size, beyond which a value is no answer: the columns stand for something else",
        "convention: three standard deviations",
    )
    wander_m: float = constant(
        3e-4,
        "by which base and instrument wander in a session, and settle between its runs",
        "derived: 3 m of steel or stone, 12 millionths per K, some 8 K between morning and noon",
        unit="m",
    )
    wander_rad: float = constant(1e-4, "by which they lean meanwhile", "derived: that over 3 m", unit="rad")
    orientation_rad: float = constant(
        1e-3,
        "by which what shows the tool's orientation errs, about each axis, as it is seen from other sides",
        "judgement: spheres 0.1 m apart, one of them seen 0.1 mm elsewhere; one real arm with a marker was in view",
        unit="rad",
    )


PLAUSIBLE = PlausibleSizes()


@dataclass(frozen=True)
class FormRules(Constants):
    """How finely effects are described, and from when the rows can tell them at all."""

    tolerance: float = constant(
        1e-3,
        "geometric tolerance of every D-H value of any arm",
        "judgement: parts are machined to tenths of a millimetre and put together to one",
        unit="m or rad",
    )
    parallel_rad: float = constant(
        1e-2,
        "two consecutive axes closer than this to parallel need a turn about y, too",
        "convention: Hayati and Mirmirani (1985) for nearly parallel axes; the number: judgement",
        unit="rad",
    )
    varying_load: float = constant(
        0.05,
        "of a moment across a bearing that must change from row to row, to show that the bearing tilts under it",
        "judgement: below, what changes is less than noise beside all but the largest tilts",
    )
    nest_step_deg: float = constant(10.0, "between directions of nests", "derived: half a step is 2 % less along it")
    along_an_axis: float = constant(0.998, "from which a direction is called by its axis", "derived: 4 degrees")
    nest_slopes: tuple[float, ...] = constant(
        (0.1, 0.0, 0.05, 0.15, 0.2, 0.3), "from which a target slides", "judgement: friction of polished steel first"
    )
    rocker_step_deg: float = constant(
        3.0,
        "between directions of the rocker on the forearm that are tried where robot.yaml does not state them",
        "derived: at half a step's distance 3 % of the bars' effect are left, a slope that passes for a gear's ratio",
        unit="degrees",
    )
    rocker_fine_step_deg: float = constant(0.5, "about the best of them", "derived: as before, 0.4 %", unit="degrees")
    flat: float = constant(
        0.1,
        "sine of the angle between crank and upper arm below which a parallelogram counts as flat",
        "judgement: linkages of data sheets keep 0.2 and more; at 0.2 a simulated arm of an unstated linkage that "
        "opened less was told wrongly",
    )
    eccentric_waves: int = constant(
        2,
        "per turn that an eccentric gear or disc makes; more are a mesh's",
        "derived: once by its centre, twice by ovality",
        unit="waves",
    )
    least_other_side: float = constant(
        0.03,
        "share of the rows in which gravity must push a joint to the other side",
        "judgement: fewer are as good as none, and play is then a constant",
    )
    wander_waves: int = constant(
        6, "half waves of a set-up's slow wander at most", "judgement: what is faster is hardly a set-up's"
    )
    growth_waves: int = constant(3, "the same of a link's length", "judgement: castings follow a hall in hours")
    sessions_per_slip: int = constant(
        10,
        "without a joint whose zero jumps while the arm is measured, for one with: the prior pays for it",
        "judgement: arms are homed and crash between sessions, and bases are bumped oftener; on ordered poses what "
        "every arm has may look like it; one real arm and one world of the proof were in view",
        unit="sessions",
    )
    numbers_per_orientation_value: int = constant(
        2, "of recorded orientations, for each value of how they err", "judgement: half of what they say is left"
    )
    rows_per_wander_wave: int = constant(12, "for each of them", "judgement: six directions take half of them up")
    smooth_waves: float = constant(
        6.0,
        "of a free curve that are equally likely; beyond, their size falls with the square",
        "judgement: eccentricity, load and cables have fewer",
    )
    smooth_fine_waves: float = constant(24.0, "the same of a refined curve", "judgement: four times as fine")
    rows_per_wave: int = constant(
        7, "for each wave of a free curve", "judgement: a value and its phase, three times over"
    )
    fewest_waves: int = constant(8, "of a free curve however short the table", "judgement: fewer show no shape")
    most_waves: int = constant(20, "of a free curve however long the table", "judgement: time")
    rows_per_fine_wave: int = constant(20, "for each wave of a refined curve", "judgement: as many waves follow noise")
    most_fine_waves: int = constant(72, "of a refined curve", "judgement: one in five degrees; time")
    slack: float = constant(
        1.25,
        "times a joint's range that the longest wave of its curve spans, a turn at most",
        "judgement: the curve's ends are then free of each other",
    )
    isolated: float = constant(
        0.1,
        "share of a joint's range away from all others, from which a row tells nothing about what lies between",
        "judgement: a curve has about ten features",
    )
    knots: int = constant(8, "splines over a load or an angle", "judgement: a curve, not a table")
    context_knots: int = constant(
        5, "splines over time or temperature", "judgement: what warms up has no fine features"
    )
    trace_of_load: float = constant(
        5e-3,
        "share of the largest load's variation below which a joint's is a trace",
        "judgement: wrists are softer than shoulders, but not so much",
    )
    mass_directions_share: float = constant(
        1e-3, "of a torque's variation, below which directions of unknown mass moments are left out", "judgement: time"
    )
    shortest_beam_m: float = constant(
        0.05, "of a row that has a beam worth bending", "judgement: a hub is no beam", unit="m"
    )
    shortest_growing_m: float = constant(
        0.02, "of a row whose growth is looked for", "derived: 20 K make 0.01 mm of aluminium of it", unit="m"
    )
    least_span_k: float = constant(
        0.2, "of temperature in a table that can tell growth", "judgement: thermometers read tenths", unit="K"
    )
    least_span_s: float = constant(
        1.0, "of time in a table that can tell drift", "judgement: one pose takes as long", unit="s"
    )
    fewest_ordered_rows: int = constant(20, "whose order can tell drift", "judgement: fewer are any order", unit="rows")
    slope_share: float = constant(
        1e-3,
        "of a link's mass, or rad of gravity's direction, by which slopes of loads are taken",
        "derived: what bends with the load hardly does so here",
    )
    no_torque_nm: float = constant(
        1e-9, "below which a motor bears no load on either side of its gap", "derived: what rounding leaves", unit="N m"
    )


FORM = FormRules()
