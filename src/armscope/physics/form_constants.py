"""Numbers that decide how effects are written as columns; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class FormRules(Constants):
    """How finely effects are described, and from when the rows can tell them at all."""

    tolerance: float = 1e-3
    """geometric tolerance of every D-H value of any arm [m or rad]; judgement: parts are machined to tenths of a
    millimetre and put together to one"""
    parallel_rad: float = 1e-2
    """two consecutive axes closer than this to parallel need a turn about y, too [rad]; convention: Hayati and
    Mirmirani (1985) for nearly parallel axes; the number: judgement"""
    varying_load: float = 0.05
    """of a moment across a bearing that must change from row to row, to show that the bearing tilts under it;
    judgement: below, what changes is less than noise beside all but the largest tilts"""
    nest_step_deg: float = 10.0
    """between directions of nests; derived: half a step is 2 % less along it"""
    along_an_axis: float = 0.998
    """from which a direction is called by its axis; derived: 4 degrees"""
    nest_slopes: tuple[float, ...] = (0.1, 0.0, 0.05, 0.15, 0.2, 0.3)
    """from which a target slides; judgement: friction of polished steel first"""
    rocker_step_deg: float = 3.0
    """between directions of the rocker on the forearm that are tried where robot.yaml does not state them [degrees];
    derived: at half a step's distance 3 % of the bars' effect are left, a slope that passes for a gear's ratio"""
    rocker_fine_step_deg: float = 0.5
    """about the best of them [degrees]; derived: as before, 0.4 %"""
    flat: float = 0.1
    """sine of the angle between crank and upper arm below which a parallelogram counts as flat; judgement: linkages of
    data sheets keep 0.2 and more; at 0.2 a simulated arm of an unstated linkage that opened less was told wrongly"""
    eccentric_waves: int = 2
    """per turn that an eccentric gear or disc makes; more are a mesh's [waves]; derived: once by its centre, twice by
    ovality"""
    least_other_side: float = 0.03
    """share of the rows in which gravity must push a joint to the other side; judgement: fewer are as good as none, and
    play is then a constant"""
    wander_waves: int = 6
    """half waves of a set-up's slow wander at most; judgement: what is faster is hardly a set-up's"""
    growth_waves: int = 3
    """the same of a link's length; judgement: castings follow a hall in hours"""
    sessions_per_slip: int = 10
    """without a joint whose zero jumps while the arm is measured, for one with: the prior pays for it [sessions];
    judgement: arms are homed and crash between sessions, and bases are bumped oftener; on ordered poses what every arm
    has may look like it; one real arm and one world of the proof were in view"""
    sessions_per_loosening: int = 1000
    """without a drive whose compliance changes while the arm is measured, for one with: the prior pays for it
    [sessions]; judgement: drives work loose between overhauls, not within an hour; one real arm was in view, in which a
    session with other faults looked like it at ten"""
    arms_per_unexplained_turn: int = 10
    """on which no link or joint turns with another joint's angle, for one on which it does: the prior pays for it
    [arms]; judgement: nothing that a data sheet knows does so; a hose or heat from one side may. One simulated arm was
    in view"""
    numbers_per_orientation_value: int = 2
    """of recorded orientations, for each value of how they err; judgement: half of what they say is left"""
    rows_per_wander_wave: int = 12
    """for each of them; judgement: six directions take half of them up"""
    smooth_waves: float = 6.0
    """of a free curve that are equally likely; beyond, their size falls with the square; judgement: eccentricity, load
    and cables have fewer"""
    smooth_fine_waves: float = 24.0
    """the same of a refined curve; judgement: four times as fine"""
    rows_per_wave: int = 7
    """for each wave of a free curve; judgement: a value and its phase, three times over"""
    fewest_waves: int = 8
    """of a free curve however short the table; judgement: fewer show no shape"""
    most_waves: int = 20
    """of a free curve however long the table; judgement: time"""
    rows_per_fine_wave: int = 20
    """for each wave of a refined curve; judgement: as many waves follow noise"""
    most_fine_waves: int = 72
    """of a refined curve; judgement: one in five degrees; time"""
    slack: float = 1.25
    """times a joint's range that the longest wave of its curve spans, a turn at most; judgement: the curve's ends are
    then free of each other"""
    isolated: float = 0.1
    """share of a joint's range away from all others, from which a row tells nothing about what lies between; judgement:
    a curve has about ten features"""
    knots: int = 8
    """splines over a load or an angle; judgement: a curve, not a table"""
    context_knots: int = 5
    """splines over time or temperature; judgement: what warms up has no fine features"""
    trace_of_load: float = 5e-3
    """share of the largest load's variation below which a joint's is a trace; judgement: wrists are softer than
    shoulders, but not so much"""
    mass_directions_share: float = 1e-3
    """of a torque's variation, below which directions of unknown mass moments are left out; judgement: time"""
    shortest_beam_m: float = 0.05
    """of a row that has a beam worth bending [m]; judgement: a hub is no beam"""
    shortest_growing_m: float = 0.02
    """of a row whose growth is looked for [m]; derived: 20 K make 0.01 mm of aluminium of it"""
    least_span_k: float = 0.2
    """of temperature in a table that can tell growth [K]; judgement: thermometers read tenths"""
    least_span_s: float = 1.0
    """of time in a table that can tell drift [s]; judgement: one pose takes as long"""
    fewest_ordered_rows: int = 20
    """whose order can tell drift [rows]; judgement: fewer are any order"""
    slope_share: float = 1e-3
    """of a link's mass, or rad of gravity's direction, by which slopes of loads are taken; derived: what bends with the
    load hardly does so here"""
    no_torque_nm: float = 1e-9
    """below which a motor bears no load on either side of its gap [N m]; derived: what rounding leaves"""


FORM = FormRules()
