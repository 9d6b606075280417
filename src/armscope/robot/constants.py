"""Numbers that decide what can be an arm, and how its joints' angles are found; see `armscope.core.constants`."""

from __future__ import annotations

import math
from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class BuiltArms(Constants):
    """What arms that are built may have; a description beyond it has a slip or another unit."""

    longest_mm: float = 20_000.0
    """of any length [mm]; judgement: the longest arms that are sold reach 4.7 m (FANUC M-2000iA), long-reach
    manipulators 10 to 20 m"""
    shortest_mm: float = 10.0
    """all lengths of a D-H table together; less is in metres [mm]; judgement: the smallest arms that are sold reach 200
    mm and more (makers' data sheets)"""
    degrees: int = 720
    """of a turn in a D-H row, either way [degrees]; judgement: two turns; a row needs no more than one"""
    most_joints: int = 99
    """of a chain [joints]; judgement: motors are called q1 ... q99; the longest snake robots that are built have 30 to
    40"""
    fewest_joints: int = 2
    """that turn, of what may be an arm in a URDF [joints]; judgement: one that turns alone is a turntable or a door"""
    most_joints_of_robot: int = 500
    """of a whole robot in a URDF [joints]; judgement: the humanoid with the most, hands included, has fewer than 100"""
    heaviest_kg: float = 20_000.0
    """of a link or load [kg]; judgement: the heaviest arm that is sold weighs 11,000 kg and carries 2,300 kg (FANUC
    M-2000iA/2300, data sheet)"""
    most_inertia_kg_m2: float = 1e6
    """of a link [kg m2]; judgement: four times the heaviest arm's whole mass (11,000 kg) at its reach (4.7 m), 2.4e5 kg
    m2"""
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.81)
    """in the base frame where none is stated [m/s2]; convention: an arm that stands upright on Earth"""
    strongest_gravity: float = 12.0
    """of any arm's [m/s2]; judgement: on Earth 9.76 to 9.84 (International Gravity Formula 1980 and altitude); less on
    the Moon, none in orbit"""
    finest_mm: float = 1e-4
    """stated 1-sigma of an instrument per axis, at least [mm]; judgement: an interferometer on its stable table tells
    0.1 um, an arm repeats a hundred times worse"""
    coarsest_mm: float = 100.0
    """the same, at most [mm]; judgement: what is coarser than 0.1 m measures no arm (indoor radio positioning is that
    coarse)"""
    largest_ratio: float = 1000.0
    """of an actuation; judgement: gears of arms reduce by 30 to 320 (harmonic and cycloidal drives, makers'
    catalogues)"""
    rounded: float = 1e-3
    """share by which the sum of two principal inertias may fall short of the third; judgement: files round to three
    digits or more"""
    rounded_away: float = 1e-12
    """of the largest, by which a principal inertia may be computed below zero; derived: some thousand times the
    rounding of one operation"""
    beyond_limits: float = 0.01
    """share of its range by which a joint may be held beyond its limits; judgement: recorded positions are not exact"""


@dataclass(frozen=True)
class UnitGuesses(Constants):
    """From what size on lengths and angles of a description are in another unit than stated, or in which of two."""

    metres_up_to: float = 10.0
    """largest length of pasted D-H rows below which they are metres; judgement: an arm's longest link is above 10 mm
    and below 10 m"""
    radians_up_to: float = 2 * math.pi + 1e-3
    """largest angle of pasted D-H rows below which they are radians [rad]; derived: a whole turn, and what rounding to
    three decimals adds"""
    as_written_rad: float = 2e-3
    """from a quarter turn's multiple, within which an angle is one that is written in radians [rad]; derived: pi/2 and
    pi written with two digits differ from themselves by so much"""
    centre_in_metres: float = 3.0
    """largest coordinate of all centres of mass below which they are metres; judgement: so it is of arms up to 6 m; in
    mm, all would lie within 3 mm of their frames' origins, as none of the library's arms has it"""


@dataclass(frozen=True)
class PastedText(Constants):
    """How much of a text is looked through, and told."""

    cell: int = 64
    """of a cell of pasted D-H rows [characters]; judgement: what is longer is no number and no heading"""
    cells: int = 32
    """of a line of them [cells]; judgement: a row has four values"""
    rows: int = 100
    """of them [lines]; judgement: a chain has 99 joints at most; a header"""
    complaint: int = 300
    """of a reader's own words about a URDF [characters]; judgement: some lines; more is not read"""
    ends: int = 5
    """arms of a URDF that are told by their last link; judgement: as many are read"""
    start: int = 200
    """of a file by which XML is told [bytes]; judgement: a byte order mark and blanks take fewer"""


@dataclass(frozen=True)
class AxisRules(Constants):
    """When axes of joints are taken for parallel, or for axes of their frame."""

    parallel: float = 1e-6
    """sine of the angle between two axes, or distance in m, below which they are parallel, or one; judgement: the D-H
    rows of nearly parallel axes run away; far above rounding"""
    along: float = 1e-6
    """by which a coordinate of a URDF joint's axis may fall short of 1 for an axis of its frame; judgement: files write
    six digits or more"""


@dataclass(frozen=True)
class PoseSearch(Constants):
    """How motor angles are found that bring the tool to a point, and when the search ends."""

    tolerance_m: float = 1e-9
    """gap at the tool at which the search ends [m]; derived: far above rounding, far below any instrument"""
    steps: int = 25
    """of Newton's method on the way from point to point; four times as many from anywhere [steps]; judgement: near its
    goal each step doubles the digits; more only circle"""
    patience: int = 6
    """without half the gap gone, after which a search is given up [steps]; judgement: one that gets there halves it in
    one or two"""
    step_rad: float = 0.5
    """of a motor in one step, at most [rad]; judgement: over thirty degrees a tangent says little of the arc"""
    jump_rad: float = 0.35
    """turn of a joint between neighbouring points of a path beyond which it has jumped [rad]; judgement: 20 degrees; a
    path's own steps are smaller, another posture is farther"""
    least_damping: float = 1e-12
    """of J J', that is always there [m2/rad2]; derived: a millionth of a metre per radian, squared; steps stay finite
    where the arm is stretched out"""
    least_damping_of_many: float = 1e-14
    """the same of many rows at once, beside what falls with the gap [m2/rad2]; judgement: so much only where the gap is
    closed"""
    far_damping: float = 1e-6
    """of J J' per square metre of the gap [1/rad2]; judgement: far from its goal a step need not be exact, but
    finite"""
    farthest_m2: float = 1.0
    """square of the gap from which it grows no more [m2]; judgement: an arm's size"""
    no_turn_rad: float = 1e-12
    """below which a step, or an angle beyond a limit, is rounding [rad]; derived: far below any encoder"""
    broken_limit_rad: float = 1e-9
    """beyond a joint's limit, from which a solution breaks it [rad]; derived: far above rounding, far below any
    encoder"""
    cloud: int = 4000
    """poses over the limits, and over whole turns, of which the nearest to a point are starts [poses]; judgement: ten
    or so along each of the three or four joints that move the tool far; time"""
    starts_per_cloud: int = 3
    """of each cloud for a point [poses]; judgement: postures that meet there; time"""
    rows_at_a_time: int = 10_000
    """whose frames are held [rows]; derived: some ten megabytes"""


@dataclass(frozen=True)
class WrittenLimits(Constants):
    """What a URDF's joint with limits must state, where nobody has stated it: never a bound in a simulation."""

    effort: float = 1e6
    """that no drive has [N m]; derived: a thousand times what the strongest axis that is sold holds"""
    speed: float = 1e3
    """that no joint reaches [rad/s]; derived: 160 turns in a second"""


ARMS, GUESSES, PASTED, AXIS, SEARCH, WRITTEN = (
    BuiltArms(),
    UnitGuesses(),
    PastedText(),
    AxisRules(),
    PoseSearch(),
    WrittenLimits(),
)
