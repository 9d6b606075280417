"""Numbers that decide in this room; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.constants import Constants


@dataclass(frozen=True)
class TrialRules(Constants):
    """When undoing a mistake that may have been made is believed to have undone one."""

    rows: int = 400
    """rows that are looked at, spread evenly [rows]; judgement: mistakes of a whole table show in a part of it"""
    rows_per_parameter: int = 2
    """measured numbers per number of the frames, below which anything fits; judgement: twice what is fitted"""
    steps: int = 12
    """of refinement per trial [steps]; judgement: the right one settles in fewer, a wrong one need not settle"""
    first_steps: int = 1
    """of them after which most trials end [steps]; measured: 400 tables, told as by all steps"""
    refined: int = 8
    """trials that go on in any case [trials]; judgement: some mistakes look alike"""
    signed_joints: int = 7
    """up to which signs of several are tried [joints]; judgement: time"""
    far: float = 0.25
    """share left after the first steps up to which all go on; judgement: five times what fits leaves"""
    fits: float = 0.05
    """share of the points' spread that base and tool leave at most where a table fits an arm; judgement: several times
    what arms of usual tolerances leave"""
    doubtful: float = 0.015
    """share of the points' spread that base and tool leave beyond which mistakes are tried and the misfit is told;
    measured: a degree at every joint leaves 0.011 to 0.031, on four arms of the library with eight draws each"""
    clearly_better: float = 0.3
    """share of the misfit, or of orientations' scatter, that another reading must at most leave; judgement: no chance
    of a few rows does so much"""
    as_good: float = 1.05
    """times the least misfit up to which other readings are told as well; judgement: some mistakes are the same to an
    arm's kinematics"""
    row_shift: int = 3
    """rows by which points may be out of step [rows]; judgement: usual slips"""
    point: float = 0.01
    """share of the arm's spread below which points are no tool points; judgement: an arm misses by less than 1 % of its
    own"""
    too_coarse: float = 10
    """times what the nominal arm leaves that a stated uncertainty can't be; judgement: noise is part of what is left"""
    lever_mm: float = 30.0
    """of a tool, from which it matters where a payload sits [mm]; judgement: a thick flange"""
    tool_read_otherwise: float = 0.1
    """of how far a stated tool is from the points, that another order or sign of its numbers leaves at most; judgement:
    an arm's own errors move a tool by a millimetre or two, another order by centimetres"""
    exchanged: float = 10
    """times the usual misfit beyond which two rows may have exchanged their points; judgement: far beyond what
    calibration errors do"""
    fits_another: float = 6
    """times the usual misfit within which a point is that of another row's angles; judgement: a row in a million is as
    far off by noise"""
    alone: float = 30
    """times the nominal arm's usual misfit beyond which a row fits nobody; measured: in 583 simulated tables physics
    that no calibration knows brings rows to 24 times, not more; at 10 rows of nine of these tables were taken for
    slips"""
    most_alone: float = 0.1
    """share of rows far from all others beyond which they are a pattern; judgement: as of bad shots"""
    rows_for_exchange: int = 20_000
    """rows among which exchanged ones are looked for [rows]; judgement: time"""
    limit_slack: float = 1e-3
    """beyond a joint's limit that still counts as at it [rad]; judgement: what rounding and control leave"""


@dataclass(frozen=True)
class OtherArms(Constants):
    """When an arm of the library is told in place of the stated one."""

    better: float = 0.5
    """share of the stated arm's misfit that another's must stay below; measured: uncalibrated, the nearest of one maker
    (UR10 and UR10e) lie 7 mm apart, new arms err by 1 to 3 mm"""
    worth_a_look: float = 1.5e-3
    """share of the reach below which a misfit needs no other arm; measured: half of what the nearest two in the library
    differ by"""


@dataclass(frozen=True)
class TableRules(Constants):
    """What a table holds, and what is too little."""

    rows: int = 15
    """fewest that a diagnosis starts on [rows]; judgement: below, frames and a handful of effects take up all there
    is"""
    listed: int = 12
    """targets of a run that are told by name; judgement: more than any tool has"""
    too_far: float = 0.03
    """share of the reach beyond which a residual is no calibration error; judgement: ten times a bad arm's"""
    one_point: float = 1e-3
    """within which points are one, measured again [m]; judgement: less than any motion of an arm"""
    flat: float = 1e-3
    """scatter across a plane as a share of the largest, below which points lie in it; judgement: what an arm's own
    errors bring out of a plane"""
    clipped_rows: int = 4
    """that share the very largest coordinate though joints move [rows]; judgement: no chance"""
    same_pose: float = 5e-4
    """between joint angles of one pose that is visited again [rad]; judgement: some times an arm's repeatability"""
    rows_for_repeats: int = 50_000
    """rows among which repeated poses are looked for [rows]; judgement: time"""
    candidates: int = 50
    """pairs per point up to which each is looked at; judgement: costs less than the import of a tree"""
    far: float = 0.5
    """by which joints must move for the points' extent to be judged [rad]; judgement: half a radian"""
    extent: tuple[float, float] = (0.01, 100.0)
    """between which points of an arm extend whose joints move that far [m]; judgement: from the smallest arms to the
    largest, with room"""
    radians_as_degrees: float = float(np.radians(2 * np.pi))
    """up to which all joints stay where radians were declared as degrees [rad]; derived: two pi, taken for degrees"""
    payload_varies: float = 1e-6
    """from which a payload varies [kg]; judgement: anything above rounding"""
    temperature_varies: float = 0.2
    """from which a temperature varies [K]; judgement: what a sensor tells apart"""
    time_varies: float = 1.0
    """from which time varies [s]; judgement: less than any session"""


@dataclass(frozen=True)
class Quantities(Constants):
    """Between which sizes what is recorded beside angles and points stands in its unit."""

    temperature: tuple[float, float] = (-50.0, 120.0)
    """lowest and highest recorded temperature [degrees C]; judgement: drives and oil are warmer than rooms"""
    warmest_room: float = 45.0
    """highest temperature of a room [degrees C]; convention: makers allow arms to work in rooms of 0 to 45 degrees
    (data sheets)"""
    between_rows: float = 3600.0
    """within which half of a table's rows come after the one before [s]; judgement: a session is a matter of hours"""
    day_numbers: tuple[float, float] = (25_000.0, 75_000.0)
    """how spreadsheets count the days of which a table may be [days]; convention: days since 1899-12-30; from 1968 to
    2105"""
    days_apart: tuple[float, float] = (1e-5, 9e-4)
    """between rows whose time_s is counted in days [days]; judgement: a pose takes a second or a minute; seconds are as
    near to each other at a kilohertz, 1e-3, only"""
    heaviest: float = 2500.0
    """largest payload of any arm [kg]; judgement: no arm carries more; nor more than its own mass"""
    uncertainty: tuple[float, float] = (1e-7, 1e-2)
    """stated uncertainty of instruments that see an arm [m]; judgement: less or more stands in another unit"""
    seen: float = 1e-4
    """what instruments that see an arm tell apart [m]; judgement: some 0.1 mm"""
    follows: float = 0.5
    """correlation from which recorded torques are those of gravity; judgement: friction and motion scatter about it"""
    many_times: float = 100.0
    """between torques and gravity's; judgement: units are off by more, masses not"""


@dataclass(frozen=True)
class WrongGravity(Constants):
    """When stated gravity points the wrong way."""

    clear_nats: float = 30.0
    """that joints giving way against gravity must explain [nats]; measured: on 90 tables of simulated arms, most of
    them with one fault, whose gravity is stated right none does; with gravity turned around 27 of them do, and are
    told"""
    clear_share: float = 0.1
    """of the squares that geometry and drives leave, which that must explain; judgement: a cause that anybody would
    see"""
    little: float = 0.5
    """of it that may at most be explained along gravity; judgement: poses in which either way explains as much tell no
    direction"""
    leaning: float = 0.5
    """of what stated gravity leaves that gravity on a slope may leave at most; judgement: most of it; nothing else that
    gives way follows the first joint as a slope's load does"""
    ways: int = 300
    """directions that are tried [directions]; derived: 12 degrees apart"""
    sides: int = 8
    """nearer ones that are tried around the best; judgement: one of them is nearer"""
    nearest_rad: float = 0.005
    """down to which they are [rad]; judgement: a third of a degree"""
    left_of_column: float = 1e-3
    """share of a column that geometry and drives must leave; judgement: rounding is far below"""


TRIALS = TrialRules()
OTHER_ARMS = OtherArms()
TABLE = TableRules()
QUANTITIES = Quantities()
WRONG_GRAVITY = WrongGravity()
