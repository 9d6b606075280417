"""Numbers that decide what can be an arm, and how its joints' angles are found; see `armscope.core.constants`."""

from __future__ import annotations

import math
from dataclasses import dataclass

from armscope.core.constants import Constants, constant


@dataclass(frozen=True)
class BuiltArms(Constants):
    """What arms that are built may have; a description beyond it has a slip or another unit."""

    longest_mm: float = constant(
        20_000.0,
        "of any length",
        "judgement: the longest arms that are sold reach 4.7 m (FANUC M-2000iA), long-reach manipulators 10 to 20 m",
        unit="mm",
    )
    shortest_mm: float = constant(
        10.0,
        "all lengths of a D-H table together; less is in metres",
        "judgement: the smallest arms that are sold reach 200 mm and more (makers' data sheets)",
        unit="mm",
    )
    degrees: int = constant(
        720, "of a turn in a D-H row, either way", "judgement: two turns; a row needs no more than one", unit="degrees"
    )
    most_joints: int = constant(
        99,
        "of a chain",
        "judgement: motors are called q1 ... q99; the longest snake robots that are built have 30 to 40",
        unit="joints",
    )
    fewest_joints: int = constant(
        2,
        "that turn, of what may be an arm in a URDF",
        "judgement: one that turns alone is a turntable or a door",
        unit="joints",
    )
    most_joints_of_robot: int = constant(
        500,
        "of a whole robot in a URDF",
        "judgement: the humanoid with the most, hands included, has fewer than 100",
        unit="joints",
    )
    heaviest_kg: float = constant(
        20_000.0,
        "of a link or load",
        "judgement: the heaviest arm that is sold weighs 11,000 kg and carries 2,300 kg (FANUC M-2000iA/2300, data "
        "sheet)",
        unit="kg",
    )
    most_inertia_kg_m2: float = constant(
        1e6,
        "of a link",
        "judgement: four times the heaviest arm's whole mass (11,000 kg) at its reach (4.7 m), 2.4e5 kg m2",
        unit="kg m2",
    )
    gravity: tuple[float, float, float] = constant(
        (0.0, 0.0, -9.81),
        "in the base frame where none is stated",
        "convention: an arm that stands upright on Earth",
        unit="m/s2",
    )
    strongest_gravity: float = constant(
        12.0,
        "of any arm's",
        "judgement: on Earth 9.76 to 9.84 (International Gravity Formula 1980 and altitude); less on the Moon, none "
        "in orbit",
        unit="m/s2",
    )
    finest_mm: float = constant(
        1e-4,
        "stated 1-sigma of an instrument per axis, at least",
        "judgement: an interferometer on its stable table tells 0.1 um, an arm repeats a hundred times worse",
        unit="mm",
    )
    coarsest_mm: float = constant(
        100.0,
        "the same, at most",
        "judgement: what is coarser than 0.1 m measures no arm (indoor radio positioning is that coarse)",
        unit="mm",
    )
    largest_ratio: float = constant(
        1000.0,
        "of an actuation",
        "judgement: gears of arms reduce by 30 to 320 (harmonic and cycloidal drives, makers' catalogues)",
    )
    rounded: float = constant(
        1e-3,
        "share by which the sum of two principal inertias may fall short of the third",
        "judgement: files round to three digits or more",
    )
    rounded_away: float = constant(
        1e-12,
        "of the largest, by which a principal inertia may be computed below zero",
        "derived: some thousand times the rounding of one operation",
    )
    beyond_limits: float = constant(
        0.01,
        "share of its range by which a joint may be held beyond its limits",
        "judgement: recorded positions are not exact",
    )


@dataclass(frozen=True)
class UnitGuesses(Constants):
    """From what size on lengths and angles of a description are in another unit than stated, or in which of two."""

    metres_up_to: float = constant(
        10.0,
        "largest length of pasted D-H rows below which they are metres",
        "judgement: an arm's longest link is above 10 mm and below 10 m",
    )
    radians_up_to: float = constant(
        2 * math.pi + 1e-3,
        "largest angle of pasted D-H rows below which they are radians",
        "derived: a whole turn, and what rounding to three decimals adds",
        unit="rad",
    )
    as_written_rad: float = constant(
        2e-3,
        "from a quarter turn's multiple, within which an angle is one that is written in radians",
        "derived: pi/2 and pi written with two digits differ from themselves by so much",
        unit="rad",
    )
    centre_in_metres: float = constant(
        3.0,
        "largest coordinate of all centres of mass below which they are metres",
        "judgement: so it is of arms up to 6 m; in mm, all would lie within 3 mm of their frames' origins, as none of "
        "the library's arms has it",
    )


@dataclass(frozen=True)
class PastedText(Constants):
    """How much of a text is looked through, and told."""

    cell: int = constant(
        64,
        "of a cell of pasted D-H rows",
        "judgement: what is longer is no number and no heading",
        unit="characters",
    )
    cells: int = constant(32, "of a line of them", "judgement: a row has four values", unit="cells")
    rows: int = constant(100, "of them", "judgement: a chain has 99 joints at most; a header", unit="lines")
    complaint: int = constant(
        300, "of a reader's own words about a URDF", "judgement: some lines; more is not read", unit="characters"
    )
    ends: int = constant(5, "arms of a URDF that are told by their last link", "judgement: as many are read")
    start: int = constant(
        200, "of a file by which XML is told", "judgement: a byte order mark and blanks take fewer", unit="bytes"
    )


@dataclass(frozen=True)
class AxisRules(Constants):
    """When axes of joints are taken for parallel, or for axes of their frame."""

    parallel: float = constant(
        1e-6,
        "sine of the angle between two axes, or distance in m, below which they are parallel, or one",
        "judgement: the D-H rows of nearly parallel axes run away; far above rounding",
    )
    along: float = constant(
        1e-6,
        "by which a coordinate of a URDF joint's axis may fall short of 1 for an axis of its frame",
        "judgement: files write six digits or more",
    )


@dataclass(frozen=True)
class PoseSearch(Constants):
    """How motor angles are found that bring the tool to a point, and when the search ends."""

    tolerance_m: float = constant(
        1e-9,
        "gap at the tool at which the search ends",
        "derived: far above rounding, far below any instrument",
        unit="m",
    )
    steps: int = constant(
        25,
        "of Newton's method on the way from point to point; four times as many from anywhere",
        "judgement: near its goal each step doubles the digits; more only circle",
        unit="steps",
    )
    patience: int = constant(
        6,
        "without half the gap gone, after which a search is given up",
        "judgement: one that gets there halves it in one or two",
        unit="steps",
    )
    step_rad: float = constant(
        0.5,
        "of a motor in one step, at most",
        "judgement: over thirty degrees a tangent says little of the arc",
        unit="rad",
    )
    jump_rad: float = constant(
        0.35,
        "turn of a joint between neighbouring points of a path beyond which it has jumped",
        "judgement: 20 degrees; a path's own steps are smaller, another posture is farther",
        unit="rad",
    )
    least_damping: float = constant(
        1e-12,
        "of J J', that is always there",
        "derived: a millionth of a metre per radian, squared; steps stay finite where the arm is stretched out",
        unit="m2/rad2",
    )
    least_damping_of_many: float = constant(
        1e-14,
        "the same of many rows at once, beside what falls with the gap",
        "judgement: so much only where the gap is closed",
        unit="m2/rad2",
    )
    far_damping: float = constant(
        1e-6,
        "of J J' per square metre of the gap",
        "judgement: far from its goal a step need not be exact, but finite",
        unit="1/rad2",
    )
    farthest_m2: float = constant(
        1.0, "square of the gap from which it grows no more", "judgement: an arm's size", unit="m2"
    )
    no_turn_rad: float = constant(
        1e-12,
        "below which a step, or an angle beyond a limit, is rounding",
        "derived: far below any encoder",
        unit="rad",
    )
    broken_limit_rad: float = constant(
        1e-9,
        "beyond a joint's limit, from which a solution breaks it",
        "derived: far above rounding, far below any encoder",
        unit="rad",
    )
    cloud: int = constant(
        4000,
        "poses over the limits, and over whole turns, of which the nearest to a point are starts",
        "judgement: ten or so along each of the three or four joints that move the tool far; time",
        unit="poses",
    )
    starts_per_cloud: int = constant(
        3, "of each cloud for a point", "judgement: postures that meet there; time", unit="poses"
    )
    rows_at_a_time: int = constant(10_000, "whose frames are held", "derived: some ten megabytes", unit="rows")


@dataclass(frozen=True)
class WrittenLimits(Constants):
    """What a URDF's joint with limits must state, where nobody has stated it: never a bound in a simulation."""

    effort: float = constant(
        1e6, "that no drive has", "derived: a thousand times what the strongest axis that is sold holds", unit="N m"
    )
    speed: float = constant(1e3, "that no joint reaches", "derived: 160 turns in a second", unit="rad/s")


ARMS, GUESSES, PASTED, AXIS, SEARCH, WRITTEN = (
    BuiltArms(),
    UnitGuesses(),
    PastedText(),
    AxisRules(),
    PoseSearch(),
    WrittenLimits(),
)
